"""The size of classes: at most 25 functions and 15 members each, so that one sentence explains a class.
A ratchet: classes_baseline.json beside this file holds the old excess, which may shrink but never grow.

Functions are those that a class declares or defines, public and private; overloads of one name in one access section
are counted each, declarations by a macro once. Members are the data of an object: no static ones and no constants.
Members of plain records (at most 4 functions: definitions, options, state records, blocks of lanes) are not bounded.

usage: classes.py [--root DIR] [--update | --list | --control]

  --update   lower the baseline to the figures of the tree
  --list     print every class with its functions and members, the largest first
"""

import argparse
import json
import pathlib
import re
import sys

from cpp_source import Tree, code_only, expect

FOLDERS = ["core", "net", "replay", "tools"]
BASELINE = pathlib.Path(__file__).with_name("classes_baseline.json")
LIMITS = {"functions": 25, "members": 15}
FUNCTIONS_OF_A_RECORD = 4

_PREPROCESSOR = re.compile(r"^[ \t]*#(?:\\\n|[^\n])*", re.MULTILINE)
_HEAD = re.compile(r"\b(?:class|struct)\s+(?:\[\[[^\]]*\]\]\s*|alignas\s*\([^)]*\)\s*|LKS_\w+\s+)*([\w:]+)(?:\s*<[^;{}]*>)?"
                   r"(?:\s+final)?\s*(?::(?!:)[^;{}()]*)?\{")
_ENUM_BEFORE = re.compile(r"\benum\s*$")
_ANGLES = re.compile(r"<[^<>;{}]*>")
_ACCESS = re.compile(r"\b(?:public|private|protected)\s*:(?!:)")
_ATTRIBUTES = re.compile(r"\[\[.*?\]\]|\balignas\s*\([^)]*\)", re.DOTALL)
_NO_MEMBER = re.compile(r"(?:using|typedef|friend|static_assert|enum|class|struct|union|template\s+friend)\b")
_MACRO = re.compile(r"[A-Z][A-Z0-9_]+\s*\(")


def end_of_block(code, opening):
    depth = 0
    for position in range(opening, len(code)):
        depth += {"{": 1, "}": -1}.get(code[position], 0)
        if depth == 0:
            return position
    return len(code)


def statements_of(body):
    """The statements of a class body. Blocks are cut out and end a statement, unless they hold a value."""
    statements, start, position = [], 0, 0
    text = ""
    while position < len(body):
        mark = body[position]
        if mark == "{":
            text += body[start:position]
            end = end_of_block(body, position)
            start = position = end + 1
            rest = body[position:].lstrip()
            text += " {} "
            if not rest.startswith((";", ",")):
                statements.append(text)
                text = ""
            continue
        if mark == ";":
            statements.append(text + body[start:position])
            text, start = "", position + 1
        position += 1
    return statements


def without_angles(text):
    while True:
        shorter = _ANGLES.sub(" ", text)
        if shorter == text:
            return text
        text = shorter


def count(body):
    """(functions, members) of a class body without the classes inside it."""
    functions = members = 0
    for statement in statements_of(body):
        text = _ATTRIBUTES.sub(" ", _ACCESS.sub(" ", statement)).strip()
        text = re.sub(r"^(?:template\s*<.*?>\s*(?=[\w\[~])|requires\s*\([^()]*\)\s*)+", "", text, flags=re.DOTALL).strip()
        if not text or _NO_MEMBER.match(text):
            continue
        if re.search(r"=\s*(?:default|delete)\s*$", text):
            continue
        plain = without_angles(re.sub(r"operator\s*\(\s*\)|operator\s*[<>=!+*/%&|^-]+", "operator_of", text))
        is_value = re.match(r"[^(]*=", plain)
        if "(" in plain and not is_value:
            functions += 1
        elif not re.match(r"(?:inline\s+)?(?:static|constexpr)\b", plain) and re.match(r"[\w:~]", plain):
            values_out = re.sub(r"=[^,]*|\{[^{}]*\}|\[[^\]]*\]", "", plain)
            members += values_out.count(",") + 1
    return functions, members


def classes_of(text):
    """[(name, functions, members)] of a file; a class inside another one stands for itself."""
    code = _PREPROCESSOR.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), code_only(text))
    found = []
    for head in _HEAD.finditer(code):
        if _ENUM_BEFORE.search(code[:head.start()]):
            continue
        opening = head.end() - 1
        body = code[opening + 1:end_of_block(code, opening)]
        found.append((head[1], *count(body)))
    return found


def measure(tree):
    figures = {}
    for file, text in tree.items():
        for name, functions, members in classes_of(text):
            bounded = [("functions", functions)]
            if functions > FUNCTIONS_OF_A_RECORD:
                bounded.append(("members", members))
            for kind, value in bounded:
                key = f"{kind} {file.as_posix()} {name}"
                figures[key] = max(value, figures.get(key, 0))
    return figures


def limit_of(key):
    return LIMITS[key.split()[0]]


def excess(figures):
    return {key: value for key, value in figures.items() if value > limit_of(key)}


def check(figures, baseline):
    return [f"{key}: {value}, at most {max(limit_of(key), baseline.get(key, 0))}"
            for key, value in sorted(figures.items())
            if value > max(limit_of(key), baseline.get(key, 0))]


def summary(figures):
    lines = []
    for kind, limit in LIMITS.items():
        values = sorted((value for key, value in figures.items() if key.startswith(kind)), reverse=True)
        over = sum(value > limit for value in values)
        p95 = values[len(values) // 20] if values else 0
        lines.append(f"{kind}: {len(values)} classes, 95 % within {p95}, most {values[0] if values else 0}, "
                     f"{over} above {limit}")
    return lines


CONTROL = """
enum class Kind : int { one, two };
class Room {
 public:
  Room() = default;
  explicit Room(int a, int b = 2) : a_(a), b_{b} { go(); }
  template <class F, class = std::enable_if_t<true>>
  void visit(F&& f) const { f(a_); }
  [[nodiscard]] bool operator()(const Room& other) const;
  friend bool operator==(const Room&, const Room&) = default;
  using Id = int;
  static constexpr int k_most = 3;
  LKS_MANY(DECLARE)
  struct Part { int x = 0, y = f(1); std::map<int, std::pair<int, int>> z; };
 private:
  std::function<void(int)> call_;
  std::array<int, 3> list_{1, 2, 3};
  int a_ = 0, b_ = f(2);  // comment; int c;
  void hidden();
};
"""


def control():
    seen = classes_of(CONTROL)
    expect(seen == [("Room", 5, 4), ("Part", 0, 3)], f"classes: {seen}")
    many = "".join(f"void f{i}(); int x{i};" for i in range(30))
    figures = measure(Tree({"core/a.h": f"struct Big {{ {many} }};"}))
    expect(figures == {"functions core/a.h Big": 30, "members core/a.h Big": 30}, f"figures: {figures}")
    expect(len(check(figures, {})) == 2, "an excess without a baseline")
    expect(not check(figures, excess(figures)), "an old excess may stay")
    expect(len(check(figures, {"functions core/a.h Big": 29, "members core/a.h Big": 30})) == 1, "an old excess must not grow")
    record = measure(Tree({"core/a.h": "struct Record { " + "".join(f"int x{i};" for i in range(30)) + "};"}))
    expect(record == {"functions core/a.h Record": 0}, f"members of a record are not bounded: {record}")
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
        rows = [(functions, members, f"{path} {name}") for path, text in tree.items()
                for name, functions, members in classes_of(text)]
        for functions, members, name in sorted(rows, reverse=True):
            print(f"{functions:4} {members:4} {name}")
        return None
    figures = measure(tree)
    baseline = json.loads(BASELINE.read_text(encoding="utf-8")) if BASELINE.exists() else excess(figures)
    if arguments.update:
        baseline = {key: min(baseline[key], value) for key, value in excess(figures).items() if key in baseline}
        BASELINE.write_text(json.dumps(baseline, indent=2, sort_keys=True) + "\n", encoding="utf-8")
    findings = check(figures, baseline)
    print("\n".join([*summary(figures), *findings, f"{len(tree.files)} files, {len(findings)} findings"]))
    return 1 if findings or not tree.files else 0


if __name__ == "__main__":
    sys.exit(main())
