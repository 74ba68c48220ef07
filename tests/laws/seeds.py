"""Tests run the same every time: nothing but tests/support/random.h chooses a seed, and it reads no
clock. New seeds are tried by `tools/test.sh --explore`."""

import re

from cpp_source import Tree, expect_only, matching_lines, run_law, without_comments

FOLDERS = ["tests"]
SOURCE = "tests/support/random.h"
FRESH = re.compile(r"\brandom_device\b|\bsystem_clock\b|(?<![\w.>])time\s*\(")
CHOICE = re.compile(r'getenv\("LOCKSTONE_TEST_SEED"\)')


def check(tree):
    findings = []
    for file, text in tree.items():
        path, code = file.as_posix(), without_comments(text)
        findings += [f"{path}:{line}: differs in every run: {match}"
                     for line, match in matching_lines(FRESH, code)]
        if path != SOURCE:
            findings += [f"{path}:{line}: only {SOURCE} chooses seeds"
                         for line, _ in matching_lines(CHOICE, code)]
    return findings


def control():
    def found(path, line):
        return check(Tree({path: line + "\n"}))

    expect_only(found("tests/a_test.cpp", "std::mt19937 engine{std::random_device{}()};"), "differs in every run")
    expect_only(found("tests/support/random.h", "std::chrono::system_clock::now().time_since_epoch();"), "differs in every run")
    expect_only(found("tests/a_test.cpp", 'std::getenv("LOCKSTONE_TEST_SEED");'), "only tests/support/random.h")
    # Must pass.
    expect_only(found("tests/support/random.h", 'std::getenv("LOCKSTONE_TEST_SEED");'))
    expect_only(found("tests/a_test.cpp", "Random random(run_seed());  // not of random_device"))
    expect_only(found("tests/a_test.cpp", "const auto end = Clock::now() + budget;"))


if __name__ == "__main__":
    run_law(check, control, FOLDERS)
