"""Helpers of the law tests: finding C++ files and reading them without comments and strings."""

import argparse
import pathlib
import re
import sys

SUFFIXES = {".h", ".hpp", ".cpp", ".inl"}

# One alternative for each thing in which the others' marks mean nothing. A digit separator (1'000)
# belongs to its number, or it would open a character literal.
_TOKEN = re.compile(
    r"""(?P<comment>//(?:\\\n|[^\n])*|/\*.*?\*/)
      | (?P<raw>\b(?:u8|[uUL])?R"(?P<mark>[^()\\\s]*)\(.*?\)(?P=mark)")
      | (?P<string>"(?:\\.|[^"\\\n])*")
      | (?P<number>\b\d(?:'?[\w.])*)
      | (?P<character>'(?:\\.|[^'\\\n])+')""",
    re.DOTALL | re.VERBOSE)
_INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]+)[>"]', re.MULTILINE)


def cpp_files(root, folders):
    """The C++ files below the folders, as sorted paths relative to root."""
    root = pathlib.Path(root)
    return sorted(path.relative_to(root)
                  for folder in folders for path in (root / folder).rglob("*")
                  if path.suffix in SUFFIXES and path.is_file())


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def without_comments(text):
    """The text with comments blanked; every line and column keeps its place."""
    return _TOKEN.sub(lambda m: _blank(m[0]) if m["comment"] else m[0], text)


def code_only(text):
    """The text with comments and the insides of strings and characters blanked. The names of
    included headers stay."""
    def keep(match):
        if match["number"]:
            return match[0]
        if match["comment"]:
            return _blank(match[0])
        inside = match[0][1:-1]
        return match[0][0] + _blank(inside) + match[0][-1]

    names = {m.start(2): m[2] for m in _INCLUDE.finditer(without_comments(text))}
    code = _TOKEN.sub(keep, text)
    for start, name in names.items():
        if code[start:start + len(name)].isspace():
            code = code[:start] + name + code[start + len(name):]
    return code


def includes(text):
    """[(line number, name, is quoted)] of a file."""
    code = without_comments(text)
    return [(code.count("\n", 0, m.start()) + 1, m[2], m[1] == '"') for m in _INCLUDE.finditer(code)]


def matching_lines(pattern, code):
    """[(line number, matched text)] of a compiled pattern."""
    return [(code.count("\n", 0, m.start()) + 1, m[0]) for m in pattern.finditer(code)]


class Tree:
    """The files that a law looks at: {relative path: text}. A control makes one of a few lines."""

    def __init__(self, files):
        self.files = {pathlib.PurePosixPath(path): text for path, text in files.items()}

    @classmethod
    def read(cls, root, folders):
        paths = cpp_files(root, folders)
        return cls({path.as_posix(): (pathlib.Path(root) / path).read_text(encoding="utf-8") for path in paths})

    def items(self):
        return self.files.items()


def expect(condition, message):
    if not condition:
        sys.exit(f"control failed: {message}")


def expect_only(findings, *fragments):
    """A control: exactly one finding for each fragment, in order, and no other."""
    fits = len(findings) == len(fragments) and all(map(str.__contains__, findings, fragments))
    expect(fits, f"expected {list(fragments)}, found {findings}")


def run_law(check, control, folders):
    """The main program of a law on sources: `--root DIR` checks the tree, `--control` checks that
    the law catches violations."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", default=".")
    parser.add_argument("--control", action="store_true")
    arguments = parser.parse_args()
    if arguments.control:
        control()
        print("the control is caught")
        return
    tree = Tree.read(arguments.root, folders)
    if not tree.files:
        sys.exit(f"no source below {arguments.root}")
    findings = check(tree)
    for finding in findings:
        print(finding)
    print(f"{len(tree.files)} files, {len(findings)} findings")
    sys.exit(1 if findings else 0)
