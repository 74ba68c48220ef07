"""Tests of tools/explore_seeds.py on tests that fail with some seeds, always, or never.

usage: explore_test.py EXPLORE_SEEDS
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

EXPLORE = sys.argv.pop()

# Fails where the remainder of the seed by 5 is 3.
SEEDED = """#!/bin/sh
echo "[ seed     ] LOCKSTONE_TEST_SEED=$LOCKSTONE_TEST_SEED"
[ $((LOCKSTONE_TEST_SEED % 5)) -ne 3 ] || { echo "broken by $1"; exit 1; }
"""
PASSING = """#!/bin/sh
echo "[ seed     ] LOCKSTONE_TEST_SEED=$LOCKSTONE_TEST_SEED"
"""
FAILING = "#!/bin/sh\nexit 1\n"
# Late whenever it runs, or for the first time only, with the word given.
LATE = """#!/bin/sh
echo "[ seed     ] LOCKSTONE_TEST_SEED=$LOCKSTONE_TEST_SEED"
[ "$WHEN" = once ] && [ -e late ] || { touch late; exec sleep 20; }
"""
CASE = '<testcase name="{}" status="run" time="0.01"><system-out>{}</system-out></testcase>'


class Explore(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def explore(self, names, script, environment=(), seconds=1, longest=60, first_seed=1000):
        program = self.folder / "program"
        program.write_text(script, encoding="utf-8")
        program.chmod(0o755)
        # A test that does not name the seed must not be run: this one would fail.
        names = names.split()
        tests = [{"name": name, "command": [str(program), "--filter=A.b"],
                  "properties": [{"name": "ENVIRONMENT", "value": list(environment)}]} for name in names]
        tests.append({"name": "Same.EveryTime", "command": ["false"]})
        cases = [CASE.format(name, "LOCKSTONE_TEST_SEED=7") for name in names]
        report = "".join(["<testsuite>", *cases, CASE.format("Same.EveryTime", "ok"), "</testsuite>"])
        (self.folder / "tests.json").write_text(json.dumps({"tests": tests}), encoding="utf-8")
        (self.folder / "report.xml").write_text(report, encoding="utf-8")
        return subprocess.run(
            [sys.executable, "-B", EXPLORE, "--tests", "tests.json", "--report", "report.xml",
             "--seconds", str(seconds), "--jobs", "2", "--first-seed", str(first_seed), "--longest", str(longest)],
            cwd=self.folder, capture_output=True, text=True, check=False)

    def test_finds_the_seed_that_fails_and_prints_how_to_repeat_it(self):
        done = self.explore("A.b", SEEDED, seconds=60)
        self.assertEqual(done.returncode, 3, done.stdout + done.stderr)
        self.assertIn("-- found: A.b with seed 1003: status 1\n", done.stdout)
        self.assertIn("broken by --filter=A.b\n", done.stdout)
        self.assertRegex(done.stdout.splitlines()[-1], r"^explore: \d+ runs of 1 tests, 1 findings$")
        repeat = re.search(r"^repeat: (.*)$", done.stdout, re.MULTILINE)[1]
        self.assertEqual(repeat, "LOCKSTONE_TEST_SEED=1003 ./program --filter=A.b")
        again = subprocess.run(repeat, shell=True, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual((again.returncode, "broken by" in again.stdout), (1, True))

    def test_finds_nothing_where_all_seeds_pass(self):
        done = self.explore("A.b", PASSING)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, r"^explore: [1-9]\d* runs of 1 tests, 0 findings\n$")

    def test_runs_one_test_however_short_the_time(self):
        self.assertRegex(self.explore("A.b", PASSING, seconds=0).stdout, "^explore: 1 runs of 1 tests")

    def test_tries_other_tests_with_another_first_seed(self):
        names = " ".join(f"A.b{i}" for i in range(20))
        found = {re.match(r"-- found: (\S+)", self.explore(names, FAILING, seconds=0, first_seed=seed).stdout)[1]
                 for seed in range(9)}
        self.assertGreater(len(found), 3, found)

    def test_reports_what_is_late_twice_with_one_seed(self):
        done = self.explore("A.b", LATE, environment=["WHEN=always"], seconds=0, longest=0.4)
        self.assertIn("-- found: A.b with seed 1001: longer than ", done.stdout, done.stderr)
        self.assertEqual(done.returncode, 3)

    def test_takes_what_is_late_once_for_a_pause_of_the_machine(self):
        done = self.explore("A.b", LATE, environment=["WHEN=once"], seconds=0, longest=0.4)
        self.assertEqual(done.stdout, "explore: 1 runs of 1 tests, 0 findings\n", done.stderr)
        self.assertEqual(done.returncode, 0)

    def test_leaves_tests_with_a_listed_seed_alone(self):
        done = self.explore("A.b", SEEDED, environment=["LOCKSTONE_TEST_SEED=3"])
        self.assertIn("no test of the report draws from the seed", done.stderr)
        self.assertNotEqual(done.returncode, 0)


if __name__ == "__main__":
    unittest.main()
