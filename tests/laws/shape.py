"""The shape of the code: files of at most 500 lines, functions of at most 70 that are not tables
(median 12, 95 % within 45), nesting of at most 3. A ratchet: shape_baseline.json beside this file
holds the old excess, which may shrink but never grow.

usage: shape.py [--root DIR] [--update | --list | --control]

  --update   lower the baseline to the figures of the tree; writes a new one only when there is none
  --list     print every function with its length and nesting
"""

import argparse
import json
import pathlib
import re
import statistics
import sys

from cpp_source import Tree, code_only, expect

FOLDERS = ["core", "net", "replay", "tools"]
BASELINE = pathlib.Path(__file__).with_name("shape_baseline.json")
AIM = 400  # lines of a file
LIMITS = {"file": 500, "function": 70, "nesting": 3, "median": 12, "p95": 45}

_PREPROCESSOR = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.MULTILINE)
_TEMPLATE = re.compile(r"\btemplate\s*<(?:[^<>]|<(?:[^<>]|<[^<>]*>)*>)*>")
_NOT_A_CALL = re.compile(r"\[\[.*?\]\]|\b(?:alignas|requires|noexcept|explicit|decltype)\s*\((?:[^()]|\([^()]*\))*\)")
_NAME = re.compile(r"((?:[\w:]+::)?operator\b\s*(?:\(\s*\)|[^(]+)|[~\w]+(?:::[~\w]+)*)\s*\(")
_TYPE = re.compile(r"(?:(?:typedef|static|inline|constexpr|const)\s+)*(?:class|struct|union|enum)\b")
_CONTROL = re.compile(r"(?:(?:case\b.*?|default\s*):(?!:)\s*)*(?:else\s+)?(?:if|for|while|switch|do|else|try|catch)\b", re.DOTALL)
_LAMBDA = re.compile(r"\[[^\[\]]*\]\s*(?:<[^{}]*>\s*)?(?:\([^{}]*\))?\s*(?:(?:mutable|constexpr|noexcept)\s*)*(?:->[^{};]*)?$")
_AFTER_PARAMETERS = re.compile(r"\s*(?:(?:const|volatile|noexcept|override|final|try|&&?)\s*)*(?:(?:->|requires|,|:(?!:)).*)?$", re.DOTALL)
_MEMBER_INITIALISER = re.compile(r"\)\s*(?:noexcept\s*)?:(?!:).*[\w>]\s*$|\)\s*(?:noexcept\s*)?:(?!:)\s*[\w:<>]+$", re.DOTALL)
_TABLE_ROW = re.compile(r"\s*(?:case\b|default\s*:|\{|\}|[A-Z][A-Z0-9_]*\()")


def classify(head, in_function):
    """The kind of scope that an opening brace begins, by the text since the last statement."""
    head = _TEMPLATE.sub(" ", head)
    head = _NOT_A_CALL.sub(" ", head).strip()
    if _LAMBDA.search(head):
        return "lambda" if in_function else "function"
    if head.count("(") != head.count(")"):
        return "value"
    if _TYPE.match(head):
        return "type"
    if in_function:
        return "control" if _CONTROL.match(head) else "block" if not head or head.endswith(":") else "value"
    if re.match(r"(?:inline\s+)?namespace\b|extern\b[^(]*$", head):
        return "namespace"
    if _MEMBER_INITIALISER.search(head) or "(" not in head:
        return "value"
    return "function" if _AFTER_PARAMETERS.match(head, head.rindex(")") + 1) else "value"


def name_of(head):
    head = _NOT_A_CALL.sub(" ", _TEMPLATE.sub(" ", head))
    match = _NAME.search(head)
    return " ".join(match[1].split()) if match else "lambda"


class Function:
    def __init__(self, name, first_line):
        self.name, self.first_line = name, first_line
        self.lines = self.nesting = 0
        self.body = []  # rows between the braces that are not blank
        self.is_table = False


def functions_of(text):
    """The functions of a file. Braces in values do not end the statement they stand in."""
    code = _PREPROCESSOR.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), code_only(text))
    rows = code.split("\n")
    found, scopes, current = [], [], None  # scopes: (kind, head start, parentheses)
    start, parentheses, line = 0, 0, 1
    for position, mark in enumerate(code):
        if mark == "\n":
            line += 1
        elif mark == "(":
            parentheses += 1
        elif mark == ")":
            parentheses -= 1
        elif mark == ";" and parentheses == 0:
            start = position + 1
        elif mark == ":" and parentheses == 0 and re.search(r"\b(?:public|private|protected)\s*$", code[start:position]):
            start = position + 1
        elif mark == "{":
            head = code[start:position]
            kind = classify(head, current is not None)
            scopes.append((kind, start, parentheses))
            if kind == "function":
                blank = len(head) - len(head.lstrip())
                current = Function(name_of(head), line - head[blank:].count("\n"))
                current.depth, current.brace_line = len(scopes), line
            elif current:
                inner = sum(scope[0] in ("control", "lambda") for scope in scopes[current.depth:])
                current.nesting = max(current.nesting, inner)
            start, parentheses = position + 1, 0
        elif mark == "}" and scopes:
            kind, head_start, parentheses = scopes.pop()
            start = head_start if kind in ("value", "lambda") else position + 1
            if current and len(scopes) < current.depth:
                body = [row for row in rows[current.first_line:line - 1] if row.strip()]
                current.body = [row for row in rows[current.brace_line:line - 1] if row.strip()]
                current.is_table = 2 * sum(bool(_TABLE_ROW.match(row)) for row in body) > len(body)
                current.lines = line - current.first_line + 1
                found.append(current)
                current = None
    return found


def measure(tree):
    """{what: figure} of everything that is bounded."""
    figures, lengths = {}, {}

    def put(key, value):
        figures[key] = max(value, figures.get(key, 0))

    for file, text in tree.items():
        path = file.as_posix()
        put(f"file {path}", text.count("\n"))
        for function in functions_of(text):
            put(f"nesting {path} {function.name}", function.nesting)
            if not function.is_table:
                put(f"function {path} {function.name}", function.lines)
                lengths.setdefault(file.parts[0], []).append(function.lines)
    for area, values in lengths.items():
        put(f"median {area}", int(statistics.median(values)))
        put(f"p95 {area}", sorted(values)[(len(values) * 95 - 1) // 100])
    return figures


def limit_of(key):
    return LIMITS[key.split()[0]]


def excess(figures):
    return {key: value for key, value in figures.items() if value > limit_of(key)}


def check(figures, baseline):
    return [f"{key}: {value}, at most {max(limit_of(key), baseline.get(key, 0))}"
            for key, value in sorted(figures.items())
            if value > max(limit_of(key), baseline.get(key, 0))]


def lowered(baseline, figures):
    """The baseline that this tree still needs; nothing in it is new or higher."""
    return {key: min(baseline[key], value) for key, value in excess(figures).items() if key in baseline}


def summary(figures):
    """A line for each figure that is bounded: where the largest stand."""
    def most(kind):
        return max(((value, key) for key, value in figures.items() if key.startswith(kind + " ")), default=(0, ""))
    lines = [f"lengths of functions in {key.split()[1]}: median {value}, 95 % within {figures['p95 ' + key.split()[1]]}"
             for key, value in sorted(figures.items()) if key.startswith("median ")]
    for kind in ("file", "function", "nesting"):
        value, key = most(kind)
        lines.append(f"the longest {key}: {value}" if kind != "nesting" else f"the deepest {key}: {value}")
    aimed = sum(value > AIM for key, value in figures.items() if key.startswith("file "))
    return [*lines, f"{aimed} files above {AIM} lines"]


def write(baseline):
    BASELINE.write_text(json.dumps(baseline, indent=2, sort_keys=True) + "\n")


CONTROL = """
#include <a.h>
#define MACRO(x) {
namespace a::b { namespace {
const int table[] = {1, 2, (3)};
struct Point : Base { int x{}, y = 0; std::function<void(int)> f{};
  Point(int a) : x{a}, y(a) {}
  explicit Point(Other b) noexcept : Base(b), x{2} {
    go();
  }
 public:
  [[nodiscard]] bool operator==(const Point& o) const { return x == o.x; }
  enum class Kind : int { one, two };
};
template <class T, class U = std::array<T, 2>>
  requires(std::is_integral_v<T>)
auto Room::deep(T a, Body b = {}) -> Result<int> {
  for (int i = 0; i < 3; ++i) {
    if (a) { go({1, 2}); } else if (b) { while (true) { do { x(); } while (y); } }
  }
  visit(a, [&](int z) { return Point{z, 1}; });
  switch (a) { case Kind::one: { break; } default: {} }
  return Result<int>{a};
}
auto twice = [](int x) { return 2 * x; };
}}
extern "C" int c_entry(void) {
  // {
  return '{';
}
const char* name(int i) {
  switch (i) {
    case 1: return "{";
    case 2: return "two";
    case 3: return "three";
  }
}
"""


def control():
    seen = [(f.name, f.lines, f.nesting, f.is_table) for f in functions_of(CONTROL)]
    wanted = [("Point", 1, 0, False), ("Point", 3, 0, False), ("operator==", 1, 0, False), ("Room::deep", 10, 4, False),
              ("lambda", 1, 0, False), ("c_entry", 4, 0, False), ("name", 7, 1, True)]
    expect(seen == wanted, f"functions: {seen}")

    body = "\n".join("  go();" for _ in range(80))
    tree = Tree({"core/a.cpp": f"void f() {{\n{body}\n}}\n" + "\n" * 500})
    figures = measure(tree)
    expect(figures == {"file core/a.cpp": 582, "function core/a.cpp f": 82, "nesting core/a.cpp f": 0,
                       "median core": 82, "p95 core": 82}, f"figures: {figures}")
    expect(len(check(figures, {})) == 4, "an excess without a baseline")
    expect(not check(figures, excess(figures)), "an old excess may stay")
    expect(check(figures, {**excess(figures), "function core/a.cpp f": 81}), "an old excess must not grow")
    expect(lowered({"file core/a.cpp": 900, "file core/gone.cpp": 900}, figures) == {"file core/a.cpp": 582},
           "an update only lowers")
    print("the control is caught")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", default=".")
    for flag in ("--update", "--list", "--control"):
        parser.add_argument(flag, action="store_true")
    arguments = parser.parse_args()
    if arguments.control:
        return control()
    tree = Tree.read(arguments.root, FOLDERS)
    if arguments.list:
        for path, text in tree.items():
            for function in functions_of(text):
                print(f"{function.lines:4} {function.nesting} {path}:{function.first_line} {function.name}")
        return None
    figures = measure(tree)
    if arguments.update:
        write(lowered(json.loads(BASELINE.read_text(encoding="utf-8")), figures) if BASELINE.exists() else excess(figures))
    findings = check(figures, json.loads(BASELINE.read_text(encoding="utf-8")))
    print("\n".join([*summary(figures), *findings, f"{len(tree.files)} files, {len(findings)} findings"]))
    return 1 if findings or not tree.files else 0


if __name__ == "__main__":
    sys.exit(main())
