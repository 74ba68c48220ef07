"""Plain English in comments, pages, help texts and messages. The law counts, for each folder,

  what     noun clauses with "what" ("What rests is skipped", "pays for what it uses"), and names of
           tests with "What" ("KeepsWhatItHolds")
  answers  "Answers" where a comment in code means "Returns"
  words    private words that the field has a better term for

Questions may say "what". plain_english_words.txt beside this file lists the idioms that may stand and
the private words. A ratchet: plain_english_allowed.json holds the counts of folders that are not clean
yet; they may fall but never rise, and a folder that is not listed must have none.

usage: plain_english.py [--root DIR] [--update | --list [PATH] | --control]

  --update       lower the ratchet to the counts of the tree
  --list [PATH]  print every finding, or those whose path begins with PATH
"""

import argparse
import collections
import io
import json
import pathlib
import re
import sys
import tokenize

from cpp_source import SUFFIXES, _TOKEN, Tree, expect, expect_only

TOPS = ["README.md", "core", "docs", "net", "replay", "tests", "tools"]
# The folders and pages that are counted by themselves; a path belongs to the longest that it begins with.
FOLDERS = TOPS + ["core/base", "core/collision", "core/dynamics", "core/geometry", "core/include", "core/kernels", "core/math",
                  "core/world", "core/world/world_def.h", "docs/benchmarks", "docs/notes",
                  "docs/explanation/solver.md", "tests/bindings", "tools/arena", "tools/bench", "tools/bindings", "tools/fuzz",
                  "tools/lockstone", "tools/scenes"]
KINDS = ["what", "answers", "words"]
# These quote bad English, or are data.
LEFT_OUT = re.compile(r"docs/contributing/style\.md|docs/glossary\.md|tests/laws/plain_english.*|tests/fuzz/corpus/.*")
WORDS = pathlib.Path(__file__).with_name("plain_english_words.txt")
ALLOWED = pathlib.Path(__file__).with_name("plain_english_allowed.json")

_WHAT = re.compile(r"(?<![\w.$>`\"'#{-])what(?![\w(=`\"'}-])", re.IGNORECASE)
_QUESTION = re.compile(r"[^.?!;\0]*\?")
_TEST_NAME = re.compile(r"^TEST(?:_[FP])?\(\s*\w+,\s*\w*What(?!ever)\w*", re.MULTILINE)
_ANSWERS = re.compile(r"\bAnswers\b|[;,:]\s+answers\s+(?:whether|if|how|which|the|true|false|null|zero|ok|io_error)\b"
                      r"|\b(?:and|it|each\s+call|each)\s+answers\s+(?:whether|how|true|false|null|ok|that|its|the\s+new)\b")
_CODE = "\0"  # stands for code between two pieces of prose, so that no phrase reaches over it
_MARKERS = re.compile(r"///?<?|/\*\*?<?|\*/|^[ \t]*\*", re.MULTILINE)
_SPAN = re.compile(r"`[^`\n]*`")
_LINK = re.compile(r"\]\([^)\s]*\)")
_FENCE = re.compile(r"^[ \t]*```.*?^[ \t]*```", re.MULTILINE | re.DOTALL)


def blanked(text, mark=" "):
    return re.sub(r"\S", mark, text)


def keep(text, pieces):
    """The text with everything but the pieces [(start, prose)] replaced; each line keeps its place."""
    parts, end = [], 0
    for start, prose in pieces:
        parts += [blanked(text[end:start], _CODE), prose]
        end = start + len(prose)
    return "".join([*parts, blanked(text[end:], _CODE)])


def without_spans(text):
    return _SPAN.sub(lambda m: blanked(m[0], "x"), text)


def prose_of_cpp(text):
    pieces = []
    for match in _TOKEN.finditer(text):
        if match["comment"]:
            comment = _MARKERS.sub(lambda m: blanked(m[0]), match[0])
            pieces.append((match.start(), without_spans(comment)))
        elif match["string"] or match["raw"]:
            single = re.fullmatch(r'"\w*"', match[0])  # a key or a name
            pieces.append((match.start(), blanked(match[0], _CODE) if single else match[0].replace('"', " ")))
    return keep(text, pieces)


def prose_of_python(text):
    starts = [0]
    for line in text.splitlines(keepends=True):
        starts.append(starts[-1] + len(line))
    pieces = []
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        single = re.fullmatch(r"\w*(['\"])\w*\1", token.string)
        if token.type == tokenize.COMMENT or token.type == tokenize.STRING and not single:
            prose = re.sub(r"^\w*[\"']+|[\"']+$|^#", lambda m: " " * len(m[0]), token.string)
            pieces.append((starts[token.start[0] - 1] + token.start[1], prose))
    return keep(text, pieces)


def prose_of_page(text):
    """Of code between fences the comments stay."""
    def fenced(match):
        return re.sub(r"^(.*?)((?://|#(?!include)).*)?$", lambda m: blanked(m[1], _CODE) + (m[2] or ""), match[0],
                      flags=re.MULTILINE)

    text = _FENCE.sub(fenced, text)
    return _LINK.sub(lambda m: blanked(m[0]), without_spans(text))


def prose_of(path, text):
    if path.suffix in SUFFIXES or path.suffix == ".c":
        return prose_of_cpp(text)
    if path.suffix == ".py":
        return prose_of_python(text)
    return prose_of_page(text)


def is_read(path):
    return path.suffix in SUFFIXES | {".c", ".py", ".sh", ".cmake", ".md"} or path.name == "CMakeLists.txt"


def read_tree(root):
    root = pathlib.Path(root)
    paths = [path for top in TOPS for path in ([root / top] if (root / top).is_file() else sorted((root / top).rglob("*")))]
    return Tree({path.relative_to(root).as_posix(): path.read_text(encoding="utf-8")
                 for path in paths if path.is_file() and is_read(path)
                 and not LEFT_OUT.fullmatch(path.relative_to(root).as_posix())})


def read_words(text):
    """(idioms, {phrase: (its first letters, pattern, replacement)}) of a word list."""
    idioms, banned = [], {}
    for line in text.splitlines():
        if line.startswith("allow "):
            idioms.append(line.removeprefix("allow ").strip())
        elif line.strip() and not line.startswith("#"):
            phrase, arrow, better = line.partition(" -> ")
            expect(arrow, f"plain_english_words.txt: no replacement: {line}")
            pattern = r"\s+".join(re.escape(word).replace(r"\*", r"\w*") for word in phrase.split())
            first = phrase.split()[0].partition("*")[0].lower()
            banned[phrase] = first, re.compile(rf"\b{pattern}\b", re.IGNORECASE), better
    return idioms, banned


def is_idiom(prose, start, idioms):
    around = " ".join(prose[max(0, start - 20):start + 40].split()).lower()
    return any(idiom in around for idiom in idioms)


def findings_in(prose, words, is_page=False):
    """[(position, kind, advice)] of a text."""
    idioms, banned = words
    found = [(m.start(), "what", "name the subject") for m in _WHAT.finditer(prose)
             if not _QUESTION.match(prose, m.end()) and not is_idiom(prose, m.start(), idioms)]
    found += [(m.start(), "answers", "Returns") for m in _ANSWERS.finditer(prose) if not is_page]
    lower = prose.lower()
    for first, pattern, better in banned.values():
        if first in lower:  # a search for plain text is a hundred times as fast
            found += [(m.start(), "words", f"{' '.join(m[0].split())} -> {better}") for m in pattern.finditer(prose)]
    return sorted(found)


def folder_of(path):
    return max((folder for folder in FOLDERS if path == folder or path.startswith(folder + "/")), key=len)


def find(tree, words):
    """[(folder, kind, text)] of the tree."""
    found = []
    for file, text in tree.items():
        path, prose, lines = file.as_posix(), prose_of(file, text), text.split("\n")
        for position, kind, advice in findings_in(prose, words, file.suffix == ".md"):
            line = prose.count("\n", 0, position) + 1
            found.append((folder_of(path), kind, f"{path}:{line}: {kind}: {advice}: {lines[line - 1].strip()}"))
        for match in _TEST_NAME.finditer(text if file.suffix == ".cpp" else ""):
            line = text.count("\n", 0, match.start()) + 1
            found.append((folder_of(path), "what", f"{path}:{line}: what: name the subject: {match[0]}"))
    return found


def count(found):
    """{folder: {kind: count}}, without zeros."""
    counts = collections.defaultdict(collections.Counter)
    for folder, kind, _ in found:
        counts[folder][kind] += 1
    return {folder: dict(kinds) for folder, kinds in counts.items()}


def check(found, allowed):
    """The findings of each folder and kind that has more than it may."""
    counts, findings = count(found), []
    for folder, kinds in sorted(counts.items()):
        for kind in KINDS:
            limit = allowed.get(folder, {}).get(kind, 0)
            if kinds.get(kind, 0) > limit:
                findings += [text for f, k, text in found if (f, k) == (folder, kind)]
                findings.append(f"{folder}: {kind}: {kinds[kind]}, at most {limit}")
    return findings


def lowered(allowed, counts):
    """The ratchet that this tree still needs; nothing in it is new or higher."""
    entries = {folder: {kind: min(limit, counts.get(folder, {}).get(kind, 0)) for kind, limit in kinds.items()}
               for folder, kinds in allowed.items()}
    entries = {folder: {kind: n for kind, n in kinds.items() if n} for folder, kinds in entries.items()}
    return {folder: kinds for folder, kinds in entries.items() if kinds}


def figures(tree, found):
    counts, files = count(found), collections.Counter(folder_of(file.as_posix()) for file in tree.files)
    rows = [f"{'folder':24}{'files':>7}" + "".join(f"{kind:>9}" for kind in KINDS)]
    for folder in sorted(files):
        values = "".join(f"{counts.get(folder, {}).get(kind, 0):9}" for kind in KINDS)
        rows.append(f"{folder:24}{files[folder]:7}{values}")
    return rows


CONTROL_WORDS = "# text\nallow what to do\nheap loads -> stack rebalance\nhand* down -> propagate\n"


def control():
    words = read_words(CONTROL_WORDS)

    def found(name, text):
        return [text for _, _, text in find(Tree({name: text}), words)]

    for text in ("// What rests leaves the tick.\n", "/// Pays for\n/// what it uses.\n", "int a;  ///< what it touches\n",
                 "/* of\n * what is near */\n", 'fail("not what it\\n"\n     "should be");\n'):
        expect(len(found("net/a.cpp", text)) == 1, f"a clause in {text}")
    for name, text in {"tools/a.py": '"""Prints what it reads."""\n', "tools/b.py": "x = 1  # what it was\n",
                       "tools/a.sh": "# Builds what is missing\n", "docs/a.md": "| page | what it is |\n",
                       "docs/b.md": "```cpp\nint a;  // what it holds\n```\n"}.items():
        expect_only(found(name, text), f"{name}:{2 if 'cpp' in text else 1}: what: ")
    expect_only(found("core/a.h", "/// Answers whether.\n/// Checks it;\n/// answers how many.\nint a; // answers a ping\n"),
                "core/a.h:1: answers", "core/a.h:2: answers")
    expect_only(found("tests/a.cpp", "TEST(A, KeepsWhatItHolds) {\n}\nTEST(A, HoldsWhateverHappens) {\n}\n"), "tests/a.cpp:1: what: ")
    expect_only(found("net/a.h", "// Writes it; answers the size.\n"), "net/a.h:1: answers")
    expect_only(found("core/a.h", "// Heap\n// loads\n// are handed down.\n"), "core/a.h:1: words: Heap loads",
                "core/a.h:3: words: handed down -> propagate")
    for name, text in {"net/a.cpp": 'auto what = result.what;  // What is next?\nput("what", e.what());  // `what` and what to do\n'
                                    "int heap; // of loads\n", "docs/a.md": "[b](c.md#what-is-it) `what`\n```\nx.what\n```\n",
                       "tools/a.py": "what = {'what': 1}  # what then?\n"}.items():
        expect_only(found(name, text))

    some = [("net", "what", "net/a.h:1"), ("net", "what", "net/a.h:2")]
    expect(len(check(some, {})) == 3, "a folder that is not listed")
    expect(check(some, {"net": {"what": 1}, "core": {"what": 9}}), "a count must not rise")
    expect(not check(some, {"net": {"what": 2}}), "an old count may stay")
    expect(lowered({"net": {"what": 3, "words": 1}, "core": {"what": 1}}, count(some)) == {"net": {"what": 2}},
           "an update only lowers")
    expect(folder_of("core/math/wide/a.h") == "core/math" and folder_of("core/mathx.h") == "core", "folders")
    print("the control is caught")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", default=".")
    parser.add_argument("--list", nargs="?", const="")
    for flag in ("--update", "--control"):
        parser.add_argument(flag, action="store_true")
    arguments = parser.parse_args()
    if arguments.control:
        return control()
    tree = read_tree(arguments.root)
    found = find(tree, read_words(WORDS.read_text(encoding="utf-8")))
    if arguments.list is not None:
        print("\n".join(text for _, _, text in found if text.startswith(arguments.list)))
        return None
    if arguments.update:
        counts = count(found)
        allowed = lowered(json.loads(ALLOWED.read_text(encoding="utf-8")), counts) if ALLOWED.exists() else counts
        ALLOWED.write_text(json.dumps(allowed, indent=2, sort_keys=True) + "\n", encoding="utf-8")
    findings = check(found, json.loads(ALLOWED.read_text(encoding="utf-8")))
    print("\n".join([*findings, *figures(tree, found), f"{len(tree.files)} files, {len(findings)} findings"]))
    return 1 if findings or not tree.files else 0


if __name__ == "__main__":
    sys.exit(main())
