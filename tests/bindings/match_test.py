"""Matches of the example game between languages: every peer prints each tick's hash, and all are equal.

usage: match_test.py NAME=COMMAND NAME=COMMAND…

The first peer serves the second, the second the first, and so on around; each match has a player of either, one of
them with rollback. A command takes `serve PLAYERS TICKS LOG` and `join PORT [PREDICTION]`. The logs that the
servers write are equal in their ticks' hashes to the printed ones, which `verify` of the command, where it has
one, checks again.
"""

import pathlib
import shlex
import subprocess
import sys
import tempfile

TICKS = 300


def start(command, *arguments):
    return subprocess.Popen([*command, *map(str, arguments)], stdout=subprocess.PIPE, text=True)


def finish(name, process):
    printed = process.communicate(timeout=60)[0].splitlines()
    assert process.returncode == 0, f"{name} ended with {process.returncode}"
    return printed


def play(host, guest, folder):
    """A match that the first serves to a player of each: its ticks."""
    log = folder / "match.lks"
    server = start(host[1], "serve", 2, TICKS, log)
    try:
        word, port = server.stdout.readline().split()
        assert word == "port", word
        players = [start(host[1], "join", port, 6), start(guest[1], "join", port)]
        results = [finish(name, player) for name, player in zip((host[0], guest[0]), players)]
        results.append(finish(host[0], server))
    finally:
        server.kill()
    for printed in results:
        assert len(printed) == TICKS, f"{len(printed)} ticks"
        assert printed == results[0], f"{host[0]} and {guest[0]} differ"
    assert len(set(line.split()[1] for line in results[0])) == TICKS, "the state does not change"
    return log


def main():
    peers = [(name, shlex.split(command)) for name, _, command in (text.partition("=") for text in sys.argv[1:])]
    with tempfile.TemporaryDirectory() as folder:
        for index, host in enumerate(peers):
            guest = peers[(index + 1) % len(peers)]
            log = play(host, guest, pathlib.Path(folder))
            print(f"{host[0]} serves {guest[0]}: {TICKS} ticks, all hashes equal, {log.stat().st_size} bytes of log")


main()
