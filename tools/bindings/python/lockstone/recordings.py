"""Logs of matches: written, read, verified and compared."""

from __future__ import annotations

import os
from ctypes import byref, c_size_t, c_uint32, c_uint64, c_void_p, create_string_buffer
from typing import Any, Iterator, List, NamedTuple, Optional, Union

from . import _declarations as c
from ._library import LockstoneError, lib
from .games import GameLibrary, Simulation, defaults, sized
from .logs import Verdict

Path = Union[str, "os.PathLike[str]"]


class Recorder:
    """Writes the log of a match, in memory where no path is given. Settings are the fields of lks_recorder_def."""

    def __init__(self, simulation: Simulation, path: Optional[Path] = None, **settings: int) -> None:
        def_ = defaults(c.lks_recorder_def, lib.lks_recorder_def_init)
        for name, value in settings.items():
            setattr(def_, name, value)
        self.handle = c_void_p()
        if path is None:
            lib.lks_recorder_create_in_memory(byref(def_), simulation.handle, byref(self.handle))
        else:
            lib.lks_recorder_create(byref(def_), simulation.handle, os.fsencode(path), byref(self.handle))

    def __del__(self) -> None:
        lib.lks_recorder_destroy(self.handle)

    def step(self, inputs: bytes) -> None:
        """Records the tick that the simulation was just stepped by."""
        lib.lks_recorder_step(self.handle, inputs, len(inputs), None)

    def finish(self, reason: str) -> None:
        lib.lks_recorder_finish(self.handle, reason.encode())

    def bytes(self) -> bytes:
        """The log so far of a recorder in memory."""
        count = c_size_t()
        try:
            lib.lks_recorder_bytes(self.handle, None, 0, byref(count))
        except LockstoneError as error:
            if error.status != c.LKS_BUFFER_TOO_SMALL:
                raise
        room = create_string_buffer(count.value)
        lib.lks_recorder_bytes(self.handle, room, count.value, byref(count))
        return room.raw


class LoggedTick(NamedTuple):
    number: int
    inputs: bytes
    origins: List[int]
    hash: int


class Log:
    """A recorded match. Iterating gives its ticks, from the present place on."""

    def __init__(self, source: Union[Path, bytes]) -> None:
        self.handle = c_void_p()
        if isinstance(source, bytes):
            lib.lks_log_open_bytes(source, len(source), byref(self.handle))
        else:
            lib.lks_log_open(os.fsencode(source), byref(self.handle))

    def __del__(self) -> None:
        lib.lks_log_close(self.handle)

    @property
    def info(self) -> Any:
        info = sized(c.lks_log_info)
        lib.lks_log_get_info(self.handle, byref(info))
        return info

    def __iter__(self) -> Iterator[LoggedTick]:
        simulation = self.info.simulation
        room = create_string_buffer(simulation.player_count * simulation.input_bytes)
        origins = (c_uint32 * simulation.player_count)()
        tick, value = c_uint64(), c_uint64()
        while True:
            try:
                lib.lks_log_next(self.handle, byref(tick), room, len(room), origins, byref(value))
            except LockstoneError as error:
                if error.status == c.LKS_NOT_FOUND:
                    return
                raise
            yield LoggedTick(tick.value, room.raw, list(origins), value.value)

    def seek(self, game: GameLibrary, tick: int) -> Simulation:
        """The match at a tick; the next iteration goes on from there."""
        made = c_void_p()
        lib.lks_log_seek(self.handle, game.handle, tick, byref(made))
        return Simulation(game, made)

    def verify(self, game: GameLibrary) -> Verdict:
        """Computes every tick again and compares the hashes."""
        report = sized(c.lks_log_report)
        lib.lks_log_verify(self.handle, game.handle, byref(report))
        return Verdict(report.outcome, report.ticks_verified, report.final_hash, report.line.decode())

    def bisect(self, other: "Log", game: GameLibrary) -> Any:
        """The first tick, body and field in which two logs differ; None where they do not."""
        report = sized(c.lks_bisect_report)
        lib.lks_log_bisect(self.handle, other.handle, game.handle, byref(report))
        return report if report.found else None
