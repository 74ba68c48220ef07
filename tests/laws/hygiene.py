"""Law 2 in the source: the libraries use nothing whose value may differ between two peers, builds or
runs. Exceptions stand with their reason in hygiene_allowed.txt beside this file."""

import pathlib
import re

from cpp_source import Tree, code_only, expect, expect_only, matching_lines, run_law

FOLDERS = ["core", "net", "replay"]
ALLOWED = pathlib.Path(__file__).with_name("hygiene_allowed.txt")

BANNED = {
    # Another sequence in each standard library; the distributions are not specified at all.
    "random": r"#\s*include\s*<random>|\bstd::(?:rand|srand|mt19937\w*|random_device|minstd_rand0?"
              r"|default_random_engine|shuffle|\w+_distribution)\b"
              r"|(?<![\w.:>])(?:s?rand(?:om)?(?:_r)?|[dejlmn]rand48|arc4random\w*)\s*\(",
    # The wall clock is no input of a tick.
    "clock": r"#\s*include\s*<(?:chrono|ctime|time\.h|sys/time\.h)>|\bstd::chrono\b"
             r"|(?<![\w.>])(?:time|clock|clock_gettime|gettimeofday|localtime\w*|gmtime\w*|enet_time_get)\s*\(",
    # Implementation-defined values and the iteration order that follows from them.
    "hash": r"\bstd::hash\b|\bstd::unordered_\w+|#\s*include\s*<unordered_(?:map|set)>",
    # The order of addresses depends on the allocator and on address randomisation.
    "pointer_order": r"\b(?:less|greater|less_equal|greater_equal|owner_less)\s*<[^<>;]*\*\s*>"
                     r"|\bstd::(?:set|multiset|map|multimap|priority_queue)\s*<[^<>;,]*\*\s*[,>]"
                     r"|\bu?intptr_t\b",
    # A result must not depend on which thread computed it.
    "thread_local": r"\bthread_local\b|\bthis_thread::get_id\b|\bpthread_self\b",
    # Two builds of the same source would differ.
    "build_date": r"\b__(?:DATE|TIME|TIMESTAMP)__\b",
    # 32 bits here, 64 there; long long is 64 everywhere.
    "long": r"(?<!long )\blong\b(?!\s+(?:long|double)\b)(?!\s+(?:un)?signed\s+long\b)|\bwchar_t\b",
    # A vector may hold room for more than was asked for, by as much as each library likes.
    "capacity": r"(?:\.|->)capacity\s*\(\s*\)",
    # Another machine has another environment and other conventions.
    "environment": r"\b(?:getenv|setlocale)\s*\(|\bstd::locale\b",
}
PATTERNS = {name: re.compile(pattern) for name, pattern in BANNED.items()}


def read_allowed(text):
    """{(path, rule): reason} from lines `path rule reason…`."""
    allowed = {}
    for line in text.splitlines():
        if line.strip() and not line.startswith("#"):
            path, rule, reason = line.split(maxsplit=2)
            expect(rule in PATTERNS, f"hygiene_allowed.txt: unknown rule {rule}")
            allowed[path, rule] = reason
    return allowed


def check(tree, allowed=None):
    if allowed is None:
        allowed = read_allowed(ALLOWED.read_text(encoding="utf-8"))
    findings, used = [], set()
    for file, text in tree.items():
        path, code = file.as_posix(), code_only(text)
        for rule, pattern in PATTERNS.items():
            matches = matching_lines(pattern, code)
            if (path, rule) in allowed:
                used.update([(path, rule)] if matches else [])
                continue
            findings += [f"{path}:{line}: {rule}: {match}" for line, match in matches]
    findings += [f"hygiene_allowed.txt: {path} no longer needs {rule}: remove the line"
                 for path, rule in sorted(set(allowed) - used)]
    return findings


def control():
    def found(line, allowed=()):
        return check(Tree({"net/a.cpp": line + "\n"}), dict(allowed))

    for rule, lines in {
            "random": ["#include <random>", "int x = rand();", "std::mt19937 engine;", "std::shuffle(a, b, c);"],
            "clock": ["auto t = time(nullptr);", "auto t = std::chrono::steady_clock::now();"],
            "hash": ["std::unordered_map<int, int> m;", "std::hash<int> h;"],
            "pointer_order": ["std::set<Body*> s;", "std::map<const Body*, int> m;", "std::less<Body*> l;",
                              "auto n = reinterpret_cast<std::uintptr_t>(p);"],
            "thread_local": ["thread_local int x;"],
            "build_date": ["auto s = __DATE__;"],
            "long": ["long x;", "unsigned long x;", "long int x;"],
            "capacity": ["if (list.size() < list.capacity()) return;"],
            "environment": ["auto s = std::getenv(name);"]}.items():
        for line in lines:
            expect_only(found(line), f"net/a.cpp:1: {rule}: ")
            expect_only(found(line, {("net/a.cpp", rule): "because"}))
    expect_only(found("int x;", {("net/a.cpp", "clock"): "because"}), "no longer needs clock")
    for line in ("// time() and rand()", "long long x; unsigned long long y;", "world.time(); p->clock();",
                 "std::map<int, Body*> m;", "int along; int runtime(int);", "body.rand();",
                 "std::uint64_t operand(int);"):
        expect_only(found(line))
    expect(read_allowed("# text\n\na/b.h clock it waits\n") == {("a/b.h", "clock"): "it waits"}, "reading the list")


if __name__ == "__main__":
    run_law(check, control, FOLDERS)
