"""Files of one room (core/geometry, net/session …) may be compiled as one (LOCKSTONE_UNITY_BUILD), so no
two of them define the same name for themselves: no constant, no type, no function with the same
parameters. Two names for one type are no clash."""

import collections
import re

from cpp_source import Tree, code_only, expect_only, run_law

FOLDERS = ["core", "net", "replay"]
OPEN = re.compile(r"^namespace \{$", re.MULTILINE)
CLOSE = re.compile(r"^\}", re.MULTILINE)
CONSTANT = re.compile(r"^(?:static |inline )*constexpr [\w:<>, ]+? (k_\w+)(?= =|\{|\[)", re.MULTILINE)
TYPE = re.compile(r"^(?:struct|class|enum class) (\w+)", re.MULTILINE)
ALIAS = re.compile(r"^using (\w+) = ([^;]+);", re.MULTILINE)
FUNCTION = re.compile(r"^(?:\[\[[^\n]*?\]\] )?[\w:<>*&][\w:<>*&, ]*?[ *&](\w+)\(([^;{}]*?)\)[^;{}()]*\{",
                      re.MULTILINE)


def own_names(code):
    """[(line, name, type)] of the definitions in a file's unnamed namespaces; type: that an alias names."""
    for opening in OPEN.finditer(code):
        start = opening.end()
        closing = CLOSE.search(code, start)
        while closing and not code.startswith("}  ", closing.start()):  # the end of a definition
            closing = CLOSE.search(code, closing.end())
        body = code[start:closing.start() if closing else len(code)]
        line = code.count("\n", 0, start) + 1
        for pattern in (CONSTANT, TYPE):
            for match in pattern.finditer(body):
                yield line + body.count("\n", 0, match.start()), match[1], None
        for match in ALIAS.finditer(body):
            yield line + body.count("\n", 0, match.start()), match[1], " ".join(match[2].split())
        for match in FUNCTION.finditer(body):
            types = re.sub(r"\s*\w+\s*(?=,|$)", "", " ".join(match[2].split()))
            yield line + body.count("\n", 0, match.start()), f"{match[1]}({types})", None


def check(tree):
    places = collections.defaultdict(list)
    for file, text in tree.items():
        if file.suffix == ".cpp":
            for line, name, alias in own_names(code_only(text)):
                places[file.parts[:2], name].append((file.as_posix(), line, alias))
    return [f"{path}:{line}: {name} is defined in {other} too"
            for (_, name), found in sorted(places.items(), key=lambda item: item[1][0][:2])
            for (other, _, before), (path, line, alias) in zip(found, found[1:])
            if path != other and (alias is None or alias != before)]


def control():
    def found(*bodies):
        return check(Tree({f"core/a/{i}.cpp": "namespace {\n" + body + "\n}  // namespace\n"
                           for i, body in enumerate(bodies)}))

    expect_only(found("constexpr int k_a = 1;", "constexpr std::int64_t k_a = 2;"), "k_a")
    expect_only(found("int f(int a) {\n  return a;\n}", "int f(int b) {\n  return b;\n}"), "f(int)")
    expect_only(found("struct A {\n};", "struct A {\n};"), "A is defined")
    expect_only(found("struct A {\n};", "using A = int;"), "A is defined")
    expect_only(found("using A = long;", "using A = int;"), "A is defined")
    expect_only(check(Tree({"core/a/b/1.cpp": "namespace {\nstruct A {\n};\n}  // namespace\n",
                            "core/a/c/1.cpp": "namespace {\nstruct A {\n};\n}  // namespace\n"})), "A is defined")
    expect_only(found("void g() {}\nconstexpr int k_a = 1;", "constexpr int k_a = 1;"), "k_a")
    # Must pass: overloads, another room, one alias twice, names of no file alone.
    expect_only(found("using A = int;", "using A = int;"))
    expect_only(found("int f(int a) {\n  return a;\n}", "int f(long b) {\n  return 1;\n}"))
    expect_only(check(Tree({"core/a/1.cpp": "namespace {\nconstexpr int k_a = 1;\n}  // namespace\n",
                            "core/b/1.cpp": "namespace {\nconstexpr int k_a = 1;\n}  // namespace\n"})))
    expect_only(found("", "")) or expect_only(check(Tree({"core/a/1.cpp": "constexpr int k_a = 1;\n"})))


if __name__ == "__main__":
    run_law(check, control, FOLDERS)
