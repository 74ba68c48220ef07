"""Assertions: where a comment states a range or an invariant, an LKS_ASSERT states it too. The solver and
collision have at least one for each function of eight lines or more, on average; tables
and lists of fields do not count.
A ratchet: assertions_baseline.json beside this file holds the average of each folder, which may rise
but never fall. Two decimals count.

usage: assertions.py [--root DIR] [--update | --list | --control]

  --update   raise the baseline to the figures of the tree
  --list     print every such function with its number of assertions
"""

import argparse
import json
import pathlib
import re
import sys

from cpp_source import Tree, expect
from shape import functions_of

MODULES = ["core/dynamics", "core/collision", "core/geometry/contact"]
AIM = 1.0
LEAST_LINES = 8
BASELINE = pathlib.Path(__file__).with_name("assertions_baseline.json")

_ASSERTION = re.compile(r"\bLKS_(?:ASSERT|CHECK)\(")


def long_functions(tree):
    """[(path, function, its assertions)]."""
    for file, text in tree.items():
        for function in functions_of(text):
            is_list = function.is_table or function.name == "visit_fields"
            if len(function.body) >= LEAST_LINES and not is_list:
                yield file, function, sum(len(_ASSERTION.findall(row)) for row in function.body)


def measure(tree):
    """{folder: [functions, assertions]}: of each folder with its own files, and of each module in all."""
    counts = {}
    for file, _, assertions in long_functions(tree):
        path = file.as_posix()
        module = next(module for module in MODULES if path.startswith(module + "/"))
        for folder in {module, file.parent.as_posix()}:
            count = counts.setdefault(folder, [0, 0])
            count[0] += 1
            count[1] += assertions
    return counts


def average(count):
    return count[1] * 100 // count[0] / 100


def check(counts, baseline):
    findings = []
    for folder, count in sorted(counts.items()):
        least = max(baseline.get(folder, 0), AIM if folder in MODULES else 0)
        if average(count) < least:
            findings.append(f"{folder}: {average(count):.2f} assertions a function, at least {least:.2f}")
    return findings


def summary(counts):
    return [f"{folder:36} {functions:4} functions {assertions:4} assertions {assertions / functions:5.2f}"
            for folder, (functions, assertions) in sorted(counts.items())]


def control():
    body = "  go();\n" * 7
    bare, checked = f"void f() {{\n{body}  go();\n}}\n", f"void g() {{\n{body}  LKS_ASSERT(a);\n}}\n"
    short = "void h() {\n  LKS_ASSERT(a);\n}\n"
    counts = measure(Tree({"core/dynamics/step/a.cpp": bare + checked + short}))
    expect(counts == {"core/dynamics": [2, 1], "core/dynamics/step": [2, 1]}, f"counts: {counts}")
    expect(len(check(counts, {})) == 1, "a module below the aim")
    full = measure(Tree({"core/dynamics/step/a.cpp": checked}))
    expect(not check(full, {"core/dynamics/step": 1.0}), "a module at the aim")
    expect(check(full, {"core/dynamics/step": 1.01}), "a folder that fell")
    print("the control is caught")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", default=".")
    for flag in ("--update", "--list", "--control"):
        parser.add_argument(flag, action="store_true")
    arguments = parser.parse_args()
    if arguments.control:
        return control()
    tree = Tree.read(arguments.root, MODULES)
    if arguments.list:
        for path, function, assertions in long_functions(tree):
            print(f"{assertions:3} {len(function.body):3} {path}:{function.first_line} {function.name}")
        return None
    counts = measure(tree)
    baseline = json.loads(BASELINE.read_text(encoding="utf-8")) if BASELINE.exists() else {}
    if arguments.update:
        baseline = {folder: max(average(count), baseline.get(folder, 0)) for folder, count in counts.items()}
        BASELINE.write_text(json.dumps(baseline, indent=2, sort_keys=True) + "\n")
    findings = check(counts, baseline)
    print("\n".join([*summary(counts), *findings, f"{len(tree.files)} files, {len(findings)} findings"]))
    return 1 if findings or not tree.files else 0


if __name__ == "__main__":
    sys.exit(main())
