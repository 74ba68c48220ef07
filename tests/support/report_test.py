"""Tests of tools/test_report.py on reports of programs that pass, fail, are skipped or crash.

usage: report_test.py TEST_REPORT
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest
from xml.sax.saxutils import escape

REPORT = sys.argv.pop()

PASSED = "[ RUN      ] A.b\n[       OK ] A.b (1 ms)\n"
PASSED_WITH_PARAMETER = "[ RUN      ] A/B.c/x\n[       OK ] A/B.c/x, where GetParam() = x (12 ms)\n"
FAILED = "[ RUN      ] A.broken\nfile.cpp:3: Failure\n[  FAILED  ] A.broken (0 ms)\n"
SKIPPED = "[ RUN      ] A.later\n[  SKIPPED ] A.later (0 ms)\n"
CRASHED = "[ RUN      ] A.crash\nSegmentation fault\n"
END = "[==========] 3 tests from 1 test suite ran. (13 ms total)\n[  PASSED  ] 2 tests.\n"
SUMMARY = "[  FAILED  ] 1 test, listed below:\n[  FAILED  ] A.broken\n"


class Report(unittest.TestCase):
    def report(self, status, output, inside=""):
        """The three counts, and the failures that were written."""
        with tempfile.TemporaryDirectory() as folder:
            report, failures = pathlib.Path(folder) / "report.xml", pathlib.Path(folder) / "failures"
            report.write_text(f'<testsuite><testcase name="part" status="{status}">{inside}<system-out>{escape(output)}'
                              "</system-out></testcase></testsuite>", encoding="utf-8")
            done = subprocess.run([sys.executable, "-B", REPORT, str(report), "title", str(failures)],
                                  capture_output=True, text=True, check=True)
            return [int(x) for x in done.stdout.split()], failures.read_text(encoding="utf-8")

    def test_counts_each_test_of_a_program(self):
        counts, failures = self.report("run", PASSED + SKIPPED + PASSED_WITH_PARAMETER + END)
        self.assertEqual((counts, failures), ([2, 0, 1], ""))

    def test_shows_the_failed_tests_alone(self):
        counts, failures = self.report("fail", PASSED + FAILED + PASSED_WITH_PARAMETER + END + SUMMARY)
        self.assertEqual(counts, [2, 1, 0])
        self.assertIn("-- failed in title: part\nA.broken\nfile.cpp:3: Failure\n", failures)
        self.assertNotIn("A.b (1 ms)", failures)

    def test_a_crash_is_one_more_failure_and_is_shown(self):
        counts, failures = self.report("fail", PASSED + CRASHED)
        self.assertEqual(counts, [1, 1, 0])
        self.assertIn("A.crash\nSegmentation fault\n", failures)
        _, failures = self.report("fail", FAILED + CRASHED)
        self.assertIn("file.cpp:3: Failure\n", failures)
        self.assertIn("A.crash\nSegmentation fault\n", failures)

    def test_other_programs_count_once(self):
        self.assertEqual(self.report("run", "fine\n")[0], [1, 0, 0])
        counts, failures = self.report("fail", "out of order\n")
        self.assertEqual(counts, [0, 1, 0])
        self.assertIn("out of order\n", failures)

    def test_counts_as_skipped_only_where_the_test_says_so(self):
        self.assertEqual(self.report("notrun", "", '<skipped message="SKIP_RETURN_CODE=77"/>')[0], [0, 0, 1])
        self.assertEqual(self.report("notrun", "", '<skipped message="Unable to find executable"/>')[0], [0, 1, 0])


if __name__ == "__main__":
    unittest.main()
