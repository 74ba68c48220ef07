#!/usr/bin/env python3
"""Measures the network session with real processes over UDP and WebSockets on this machine.

usage: tools/session_figures.py LOCKSTONE [--part PART]… [--seconds N] [--minutes N]

  lossy   four players at 60 Hz behind `lockstone lossy`: 5 % loss in bursts of four,
          50 ± 15 ms and 100 ± 30 ms one way
  stop    the same at 50 ± 15 ms; one player is stopped (SIGSTOP) for 3 s
  crowd   2, 4 and 16 players, and 16 with 32 spectators, over 216 bodies: the server's
          processor time, bytes a second and player
  late    a match of 500 bodies that has run for --minutes (10): the time until a third
          player is active; then kill -9 of a player and, 5 s later, of the server, and
          whether its log verifies, up to which tick
  web     two players over UDP and two over WebSockets in one match, 25 ± 5 ms one way, at 0, 1 and
          5 % loss and several input delays

Without --part all of them. The output is Markdown. `docs/explanation/network-session.md` has the figures
of one run.
"""

import argparse
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time


class Match:
    """A server of `lockstone serve`, insecure, and its players, in a folder of its own."""

    def __init__(self, lockstone, folder, *arguments):
        self.lockstone, self.folder = lockstone, folder
        self.server = self.start("serve", "--insecure", "--ticks", 0,
                                 "--max-connections-per-address", 64, *arguments)
        self.port = self.listening(self.server)
        self.players = []

    def start(self, *arguments):
        return subprocess.Popen([self.lockstone, *map(str, arguments)], cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)

    @staticmethod
    def listening(process):
        return int(re.search(r":(\d+)", process.stdout.readline())[1])

    def join(self, port=None, *arguments):
        player = self.start("join", "--insecure", "--port", port or self.port, "--json", *arguments)
        self.players.append(player)
        return player

    def wait_for(self, text):
        for line in self.server.stdout:
            if text in line:
                return
        sys.exit(f"the server never said: {text}")

    def finish(self):
        """Returns the output of the players and the server, and the server's processor seconds."""
        self.server.terminate()
        answers = [json.loads(player.stdout.read()) for player in self.players]
        text = self.server.stdout.read()
        _, _, usage = os.wait4(self.server.pid, 0)
        self.server.returncode = 0
        return answers, text, usage.ru_utime + usage.ru_stime


def busy_machine():
    return f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}"


def lossy(lockstone, folder, seconds, delay, stop_seconds=0, input_delay=8):
    match = Match(lockstone, folder, "--players", 4, "--bodies", 20, "--input-delay", input_delay)
    relay = match.start("lossy", "--to", match.port, "--loss", 5, "--burst", 4, "--delay", delay,
                        "--jitter", 0.3 * delay)
    port = match.listening(relay)
    for slot in range(4):
        match.join(port, "--slot", slot, "--bot-seed", slot)
    match.wait_for("begins")
    time.sleep(seconds / 2)
    if stop_seconds:
        match.players[3].send_signal(signal.SIGSTOP)
        time.sleep(stop_seconds)
        match.players[3].send_signal(signal.SIGCONT)
    time.sleep(seconds / 2)
    answers, text, _ = match.finish()
    relay.terminate()
    relay.wait()
    report(delay, stop_seconds, input_delay, answers, text)


def report(delay, stop_seconds, input_delay, answers, text):
    ticks = max(answer["ticks"] for answer in answers)
    gap = re.search(r"longest between two ticks (\d+)", text)[1]
    final = re.search(r"final hash ([0-9a-f]{16})", text)[1]
    equal = sum(answer["final_hash"] == final for answer in answers)
    stop = f", player 3 stopped for {stop_seconds} s" if stop_seconds else ""
    print(f"\n{delay} ± {0.3 * delay:.0f} ms one way, input delay {input_delay}{stop}: {ticks} ticks, "
          f"longest between two of the server {gap} ms, {equal} of 4 final hashes equal "
          f"({busy_machine()})\n")
    print("| player | inputs replaced | stalled a minute | longest |\n|---|---|---|---|")
    for slot, answer in enumerate(answers):
        minutes = ticks / 3600
        print(f"| {slot} | {answer['substituted_inputs']} ({100 * answer['substituted_inputs'] / ticks:.1f} %) "
              f"| {answer['stalled_ms'] / minutes:.0f} ms | {answer['longest_between_ticks_ms']} ms |")
    sys.stdout.flush()


def web_row(lockstone, folder, seconds, loss, input_delay):
    match = Match(lockstone, folder, "--players", 4, "--bodies", 20, "--input-delay", input_delay, "--ws", 0)
    web_port = match.listening(match.server)
    faults = ("--loss", loss, "--delay", 25, "--jitter", 5)
    relays = [match.start("lossy", "--to", match.port, *faults), match.start("lossy", "--tcp", "--to", web_port, *faults)]
    ports = [match.listening(relay) for relay in relays]
    for slot in (0, 1):
        match.join(ports[0], "--slot", slot, "--bot-seed", slot)
    for slot in (2, 3):
        match.players.append(match.start("join", "--insecure", "--ws", f"ws://127.0.0.1:{ports[1]}/", "--json",
                                         "--slot", slot, "--bot-seed", slot))
    match.wait_for("begins")
    time.sleep(seconds)
    answers, text, _ = match.finish()
    for relay in relays:
        relay.terminate()
        relay.wait()
    final = re.search(r"final hash ([0-9a-f]{16})", text)[1]
    equal = sum(answer["final_hash"] == final for answer in answers)
    cells = []
    for pair in (answers[:2], answers[2:]):
        ticks = sum(answer["ticks"] for answer in pair)
        cells.append(f"{100 * sum(answer['substituted_inputs'] for answer in pair) / ticks:.2f} %")
        cells.append(f"{sum(answer['stalled_ms'] for answer in pair) / (ticks / 3600):.0f} ms")
        cells.append(f"{max(answer['longest_between_ticks_ms'] for answer in pair)} ms")
    print(f"| {loss} % | {input_delay} ticks | {' | '.join(cells)} | {equal} of 4 |")
    sys.stdout.flush()


def web(lockstone, folder, seconds):
    print("\n| loss | input delay | UDP: inputs replaced | stalled a minute | longest | WebSocket: inputs replaced "
          "| stalled a minute | longest | final hashes equal |\n|---|---|---|---|---|---|---|---|---|")
    for loss in (0, 1, 5):
        for input_delay in (4, 8, 12, 18):
            web_row(lockstone, folder, seconds, loss, input_delay)
    print(f"\n({busy_machine()})")


def crowd(lockstone, folder, seconds):
    print("\n| players | spectators | server's processor | down, a player | up, a player | down, a spectator "
          "| final hashes equal |\n|---|---|---|---|---|---|---|")
    for players, spectators in ((2, 0), (4, 0), (16, 0), (16, 32)):
        match = Match(lockstone, folder, "--players", players, "--spectators", 32, "--bodies", 216)
        for slot in range(players):
            match.join(None, "--slot", slot, "--bot-seed", slot)
        for _ in range(spectators):
            match.join(None, "--spectate")
        match.wait_for("begins")
        time.sleep(seconds)
        answers, text, processor = match.finish()
        duration = float(re.search(r"([0-9.]+) s, longest", text)[1])
        final = re.search(r"final hash ([0-9a-f]{16})", text)[1]
        equal = sum(answer["final_hash"] == final for answer in answers)
        rate = lambda field, some: sum(a[field] for a in some) / len(some) / duration / 1024 if some else 0
        print(f"| {players} | {spectators} | {100 * processor / duration:.0f} % of a core | "
              f"{rate('bytes_received', answers[:players]):.2f} KiB/s | "
              f"{rate('bytes_sent', answers[:players]):.2f} KiB/s | "
              f"{rate('bytes_received', answers[players:]):.2f} KiB/s | {equal} of {len(answers)} |")
        sys.stdout.flush()
    print(f"\n(payload, {busy_machine()})")


def late(lockstone, folder, minutes):
    match = Match(lockstone, folder, "--players", 3, "--start-players", 2, "--bodies", 500,
                  "--record", "late.lks")
    first = [match.join(None, "--slot", slot, "--bot-seed", slot) for slot in (0, 1)]
    match.wait_for("begins")
    began = time.monotonic()
    time.sleep(60 * minutes)
    called = time.monotonic()
    match.join(None, "--slot", 2)
    match.wait_for('player 2 "bot" plays from tick')
    announced = time.monotonic() - called
    time.sleep(5)
    match.players[2].terminate()
    newcomer = json.loads(match.players[2].stdout.read())
    print(f"\n500 bodies, {minutes} min: active after {newcomer['seconds_to_active']:.2f} s (announced after "
          f"{announced:.2f} s), {newcomer['states_loaded']} state loaded, {busy_machine()}")
    first[0].kill()
    time.sleep(5)
    match.server.kill()
    killed = time.monotonic() - began
    done = subprocess.run([lockstone, "verify", "--json", folder / "late.lks"], capture_output=True, text=True)
    verified = json.loads(done.stdout)[0]
    first[1].terminate()
    other = json.loads(first[1].stdout.read())
    print(f"the player beside it: {other['ticks']} ticks, {other['substituted_inputs']} inputs replaced, longest "
          f"between two ticks {other['longest_between_ticks_ms']} ms")
    print(f"kill -9 of a player, then of the server after {killed:.2f} s ({60 * killed:.0f} ticks): verify exits "
          f"{done.returncode}, {verified['ticks_verified']} ticks verified")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("lockstone", type=pathlib.Path)
    parser.add_argument("--part", action="append", choices=("lossy", "stop", "crowd", "late", "web"))
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--minutes", type=float, default=10)
    options = parser.parse_args()
    lockstone = options.lockstone.resolve()
    parts = options.part or ("lossy", "stop", "crowd", "late", "web")
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        if "lossy" in parts:
            for delay in (50, 100):
                lossy(lockstone, folder, options.seconds, delay, input_delay=8 if delay == 50 else 14)
        if "stop" in parts:
            lossy(lockstone, folder, options.seconds, 50, stop_seconds=3)
        if "crowd" in parts:
            crowd(lockstone, folder, min(options.seconds, 30))
        if "web" in parts:
            web(lockstone, folder, min(options.seconds, 30))
        if "late" in parts:
            late(lockstone, folder, options.minutes)


if __name__ == "__main__":
    main()
