"""Counts one test run's report of CTest (JUnit XML) and prints each failure, with the end of its output.

usage: test_report.py REPORT TITLE FAILURES

Prints "passed failed skipped"; appends to the file FAILURES. A test that could not be started has
failed: a test counts as skipped only if it reports that itself.
"""

import sys
import xml.etree.ElementTree as xml

SHOWN_LINES = 40


def verdict(case):
    if case.get("status") == "run":
        return "passed"
    skipped = case.find("skipped")
    by_itself = skipped is not None and skipped.get("message", "").startswith("SKIP_")
    return "skipped" if by_itself else "failed"


def main(report, title, failures):
    count = {"passed": 0, "failed": 0, "skipped": 0}
    with open(failures, "a", encoding="utf-8") as said:
        for case in xml.parse(report).iter("testcase"):
            result = verdict(case)
            count[result] += 1
            if result == "failed":
                output = (case.findtext("system-out") or "").splitlines()[-SHOWN_LINES:]
                print(f"-- failed in {title}: {case.get('name')}", *output, sep="\n", file=said)
    print(*count.values())


if __name__ == "__main__":
    main(*sys.argv[1:])
