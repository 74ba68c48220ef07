"""Law 2 in the source: every sort has one result. Where two elements compare equal, the algorithms
below leave them in an order that each standard library chooses. So every call stands in order_keys.txt
beside this file, with the key that tells all elements apart, or the reason why equal ones are the same."""

import pathlib
import re

from cpp_source import Tree, code_only, expect, expect_only, matching_lines, run_law

FOLDERS = ["core", "net", "replay"]
KEYS = pathlib.Path(__file__).with_name("order_keys.txt")
CALL = re.compile(r"\bstd::(?:ranges::)?(?:sort|nth_element|partial_sort(?:_copy)?|partition"
                  r"|(?:make|push|pop|sort)_heap)\b\s*\(")


def read_keys(text):
    """{path: number of calls} from lines `path count key…`."""
    keys = {}
    for line in text.splitlines():
        if line.strip() and not line.startswith("#"):
            path, count, _ = line.split(maxsplit=2)
            expect(path not in keys, f"order_keys.txt: {path} stands there twice")
            keys[path] = int(count)
    return keys


def check(tree, keys=None):
    if keys is None:
        keys = read_keys(KEYS.read_text(encoding="utf-8"))
    findings, left = [], dict(keys)
    for file, text in tree.items():
        calls = matching_lines(CALL, code_only(text))
        known = left.pop(file.as_posix(), 0)
        if len(calls) != known:
            lines = ", ".join(str(line) for line, _ in calls)
            findings.append(f"{file.as_posix()}: {len(calls)} calls that order (lines {lines}), {known} keys in "
                            "order_keys.txt: state the key of each, and that it is total")
    return findings + [f"order_keys.txt: {path} is no more" for path in sorted(left)]


def control():
    def found(text, **keys):
        return check(Tree({"core/a.cpp": text}), {"core/a.cpp": keys["count"]} if keys else {})

    for call in ("std::sort(a, b);", "std::ranges::sort(list, {}, &Body::mass);", "std::nth_element(a, b, c);",
                 "std::partial_sort (a, b, c);", "std::partition(a, b, f);", "std::push_heap(a, b);"):
        expect_only(found(call + "\n"), "core/a.cpp: 1 calls that order (lines 1), 0 keys")
        expect_only(found(call + "\n", count=1))
        expect_only(found(call * 2 + "\n", count=1), "2 calls")
    expect_only(found("// std::sort(a)\nstd::stable_sort(a, b); x.sort(); std::partition_point(a, b, c);\n"))
    expect_only(found("int x;\n", count=1), "core/a.cpp: 0 calls")
    expect_only(check(Tree({}), {"core/b.cpp": 1}), "core/b.cpp is no more")
    expect(read_keys("# text\n\na/b.h 2 index: unique\n") == {"a/b.h": 2}, "reading the list")


if __name__ == "__main__":
    run_law(check, control, FOLDERS)
