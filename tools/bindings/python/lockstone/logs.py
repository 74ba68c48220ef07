"""Recorded matches, computed again."""

from __future__ import annotations

import os
from ctypes import byref, sizeof
from typing import NamedTuple, Union

from ._library import LogReport, lib

SAME, DIVERGED, CORRUPT, INCOMPATIBLE = range(4)


class Verdict(NamedTuple):
    outcome: int
    ticks_verified: int
    final_hash: int
    line: str


def verify_log(path: Union[str, "os.PathLike[str]"]) -> Verdict:
    """Re-simulates a log of the arena or of a built-in scene and compares every hash."""
    report = LogReport(size=sizeof(LogReport))
    lib.lks_verify_log(os.fsencode(path), byref(report))
    return Verdict(report.outcome, report.ticks_verified, report.final_hash, report.line.decode())
