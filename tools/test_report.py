"""Counts one test run's report of CTest (JUnit XML) and prints each failure, with the end of its output.

usage: test_report.py REPORT TITLE FAILURES

Prints "passed failed skipped"; appends to the file FAILURES. A test that could not be started has
failed: a test counts as skipped only if it reports that itself. A GoogleTest program with many tests
counts as many, and as one more that failed if it ended otherwise than they did.
"""

import collections
import re
import sys
import xml.etree.ElementTree as xml

SHOWN_LINES = 40


def verdict(case):
    if case.get("status") == "run":
        return "passed"
    skipped = case.find("skipped")
    by_itself = skipped is not None and skipped.get("message", "").startswith("SKIP_")
    return "skipped" if by_itself else "failed"


ENDED = re.compile(r"^\[ {2}(     OK|FAILED |SKIPPED) \] .* \(\d+ ms\)$", re.MULTILINE)
OUTCOMES = {"     OK": "passed", "FAILED ": "failed", "SKIPPED": "skipped"}


def outcomes(case):
    """How many tests ended how."""
    result = verdict(case)
    ended = ENDED.findall(case.findtext("system-out") or "")
    count = collections.Counter(OUTCOMES[outcome] for outcome in ended)
    if not count or (result == "failed" and count["failed"] == 0):
        count[result] += 1
    return count


def shown(output):
    """Of a GoogleTest program that came to its end the failed tests alone; of any other, and of anything else, the
    end too."""
    failed = re.findall(r"^\[ RUN {6}\] (\S+).*\n((?:(?!\[ RUN).*\n)*?\[  FAILED  \] \1.*)$", output, re.MULTILINE)
    lines = [line for name, rest in failed for line in (name, *rest.splitlines())][:SHOWN_LINES]
    ended = re.search(r"^\[={10}\] .* ran\.", output, re.MULTILINE)
    return lines if lines and ended else lines + output.splitlines()[-SHOWN_LINES:]


def main(report, title, failures):
    count = collections.Counter(passed=0, failed=0, skipped=0)
    with open(failures, "a", encoding="utf-8") as said:
        for case in xml.parse(report).iter("testcase"):
            count += outcomes(case)
            if verdict(case) == "failed":
                output = shown(case.findtext("system-out") or "")
                print(f"-- failed in {title}: {case.get('name')}", *output, sep="\n", file=said)
    print(count["passed"], count["failed"], count["skipped"])


if __name__ == "__main__":
    main(*sys.argv[1:])
