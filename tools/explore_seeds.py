"""Runs the tests that draw from LOCKSTONE_TEST_SEED with new seeds, for some seconds.

usage: explore_seeds.py --tests JSON --report XML --seconds N [--jobs N] [--first-seed N] [--longest N]

JSON is the output of `ctest --show-only=json-v1`, XML the JUnit report of a run: the tests whose output
there names the seed depend on it. Each gets the same share of the time. They are begun in an order drawn from
the first seed, so where the time is too short for all of them, each exploration tries others. A test
that fails is a finding: it is printed with the command that repeats it, and not tried again. So is one
that twice runs with one seed for longer than --longest (60 s) and ten times its time in the report;
once may be the machine, which stood still or was busy. The last line is "explore: N runs of N tests, N
findings", with the number of tests that ran; the status is 3 when there is a finding.
"""

import argparse
import json
import os
import random
import shlex
import subprocess
import sys
import threading
import time
import xml.etree.ElementTree as xml

MARK = "LOCKSTONE_TEST_SEED="
SHOWN_LINES = 40


def seeded_names(report):
    """{name: seconds} of the tests that passed and said that they draw from the seed."""
    return {case.get("name"): float(case.get("time", 0)) for case in xml.parse(report).iter("testcase")
            if case.get("status") == "run" and MARK in (case.findtext("system-out") or "")}


class Test:
    def __init__(self, entry, seconds, longest):
        self.name = entry["name"]
        self.command = entry["command"]
        properties = {p["name"]: p["value"] for p in entry.get("properties", [])}
        self.folder = properties.get("WORKING_DIRECTORY") or os.getcwd()
        self.environment = dict(e.split("=", 1) for e in properties.get("ENVIRONMENT", []))
        self.seconds = seconds
        self.longest = longest + 10 * seconds
        self.spent = 0.0

    def has_own_seed(self):
        return "LOCKSTONE_TEST_SEED" in self.environment

    def run(self, seed):
        """None, or how it failed and the end of its output."""
        environment = os.environ | self.environment | {"LOCKSTONE_TEST_SEED": str(seed)}
        began = time.monotonic()
        for _ in range(2):
            try:
                done = subprocess.run(self.command, cwd=self.folder, env=environment, text=True, errors="replace",
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=self.longest)
                how, output = f"status {done.returncode}", done.stdout if done.returncode else None
                break
            except subprocess.TimeoutExpired as late:
                how = f"longer than {self.longest:.0f} s, twice"
                output = (late.stdout or b"").decode(errors="replace")
        self.spent += time.monotonic() - began
        return None if output is None else (how, output.splitlines()[-SHOWN_LINES:])

    def repeat(self, seed):
        words = [os.path.relpath(word) if os.path.isabs(word) and os.path.exists(word) else word
                 for word in self.command if not word.startswith("--gtest_also_run_disabled_tests")]
        if words[0] == os.path.basename(words[0]):
            words[0] = "./" + words[0]
        settings = self.environment | {"LOCKSTONE_TEST_SEED": str(seed)}
        return " ".join([f"{name}={shlex.quote(value)}" for name, value in settings.items()] +
                        [shlex.quote(word) for word in words])


class Exploration:
    def __init__(self, tests, seconds, first_seed):
        self.queue = [(0.0, index, test)
                      for index, test in enumerate(random.Random(first_seed).sample(tests, len(tests)))]
        self.end = time.monotonic() + seconds
        self.seed = first_seed
        self.lock = threading.Lock()
        self.runs = self.tried = self.findings = 0

    def next(self):
        """Of the tests that may end in time the one that has run for the shortest time, and a seed of its own;
        None if there is none, after one run at least."""
        with self.lock:
            left = self.end - time.monotonic()
            in_time = [entry for entry in self.queue if entry[2].seconds < left or self.runs == 0]
            if not in_time:
                return None
            spent, index, test = min(in_time)
            self.queue.remove((spent, index, test))
            self.seed += 1
            self.runs += 1
            self.tried += spent == 0
            return index, test, self.seed

    def report(self, index, test, seed, failure):
        with self.lock:
            if failure is None:
                self.queue.append((test.spent, index, test))
                return
            self.findings += 1
            how, lines = failure
            print(f"-- found: {test.name} with seed {seed}: {how}", *lines, f"repeat: {test.repeat(seed)}",
                  sep="\n", flush=True)

    def work(self):
        while (job := self.next()) is not None:
            index, test, seed = job
            self.report(index, test, seed, test.run(seed))


def main():
    parser = argparse.ArgumentParser()
    for name in ["--tests", "--report"]:
        parser.add_argument(name, required=True)
    parser.add_argument("--seconds", type=float, required=True)
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--first-seed", type=int, default=time.time_ns())
    parser.add_argument("--longest", type=float, default=60)
    given = parser.parse_args()

    names = seeded_names(given.report)
    with open(given.tests, encoding="utf-8") as file:
        entries = [entry for entry in json.load(file)["tests"] if entry["name"] in names]
    tests = [Test(entry, names[entry["name"]], given.longest) for entry in entries]
    tests = [test for test in tests if not test.has_own_seed()]
    if not tests:
        sys.exit("explore: no test of the report draws from the seed")
    exploration = Exploration(tests, given.seconds, given.first_seed)
    workers = [threading.Thread(target=exploration.work) for _ in range(given.jobs)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    print(f"explore: {exploration.runs} runs of {exploration.tried} tests, {exploration.findings} findings")
    sys.exit(3 if exploration.findings else 0)


if __name__ == "__main__":
    main()
