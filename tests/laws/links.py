"""Links in pages lead somewhere: README.md, docs/ and the README of every folder.

  - a relative link names a file or a folder that exists
  - an anchor names a heading of its page; GitHub and MkDocs derive the same anchor from that heading
  - docs/index.md links every page of docs/
  - a page that source text names ("docs/…/name.md") exists

usage: links.py [--root DIR | --control]
"""

import argparse
import pathlib
import posixpath
import re
import sys
import unicodedata

from cpp_source import SUFFIXES, expect_only

TOPS = ["README.md", "core", "docs", "net", "replay", "tests", "tools"]
INDEX = "docs/index.md"
SOURCES = SUFFIXES | {".c", ".py", ".sh", ".cmake", ".txt"}

_FENCE = re.compile(r"^[ \t]*```.*?^[ \t]*```[ \t]*$", re.MULTILINE | re.DOTALL)
_SPAN = re.compile(r"`[^`\n]*`")
_LINK = re.compile(r"\]\(\s*<?([^)\s>]+)>?(?:\s+\"[^\"]*\")?\)")
_HEADING = re.compile(r"^#{1,6}[ \t]+(.*?)[ \t]*#*[ \t]*$", re.MULTILINE)
_NAMED = re.compile(r"\bdocs/[\w./-]*\.md\b")


def blanked(text):
    return re.sub(r"[^\n]", " ", text)


def heading_text(heading):
    """A heading without its marks: links become their text, code its content."""
    return re.sub(r"[`*]", "", re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading))


def github_anchor(heading):
    return re.sub(r"[^\w\- ]", "", heading_text(heading).strip().lower()).replace(" ", "-")


def mkdocs_anchor(heading):
    ascii_text = unicodedata.normalize("NFKD", heading_text(heading)).encode("ascii", "ignore").decode()
    return re.sub(r"[-\s]+", "-", re.sub(r"[^\w\s-]", "", ascii_text).strip().lower())


def headings(text):
    return _HEADING.findall(_FENCE.sub(lambda m: blanked(m[0]), text))


def anchor_fault(text, anchor):
    """The fault of a link to this anchor of a page, or None."""
    found = [heading for heading in headings(text) if github_anchor(heading) == anchor]
    if not found:
        return "no such heading"
    if len(found) > 1:
        return "several headings have this anchor"
    if mkdocs_anchor(found[0]) != anchor:
        return f"MkDocs calls it #{mkdocs_anchor(found[0])}: write the heading without marks that one of the two drops"
    return None


def links_of(text):
    """[(line, target)] of a page, without code."""
    prose = _SPAN.sub(lambda m: blanked(m[0]), _FENCE.sub(lambda m: blanked(m[0]), text))
    return [(prose.count("\n", 0, match.start()) + 1, match[1]) for match in _LINK.finditer(prose)]


def check_page(page, text, texts, exists):
    findings = []
    for line, target in links_of(text):
        if re.match(r"\w+:|\.\./\.\./actions/", target):  # elsewhere, or a page of GitHub's own
            continue
        path, _, anchor = target.partition("#")
        full = posixpath.normpath(posixpath.join(posixpath.dirname(page), path)) if path else page
        if not exists(full):
            findings.append(f"{page}:{line}: {target}: no such file")
        elif anchor and full in texts:
            fault = anchor_fault(texts[full], anchor)
            findings += [f"{page}:{line}: {target}: {fault}"] if fault else []
    return findings


def check_index(texts):
    """The pages of docs/ that the index does not link."""
    linked = {posixpath.normpath(posixpath.join("docs", target.partition("#")[0]))
              for _, target in links_of(texts.get(INDEX, ""))}
    return [f"{page}: {INDEX} does not link it" for page in sorted(texts)
            if page.startswith("docs/") and page != INDEX and page not in linked]


def check_sources(sources, exists):
    return [f"{path}:{text.count(chr(10), 0, match.start()) + 1}: {match[0]}: no such page"
            for path, text in sorted(sources.items()) for match in _NAMED.finditer(text) if not exists(match[0])]


def check(pages, sources, exists):
    findings = [finding for page, text in sorted(pages.items()) for finding in check_page(page, text, pages, exists)]
    return findings + check_index(pages) + check_sources(sources, exists)


def read_tree(root):
    """(pages, other sources): the texts by path."""
    pages, sources = {}, {}
    for top in TOPS:
        for path in [root / top] if (root / top).is_file() else sorted((root / top).rglob("*")):
            name = path.relative_to(root).as_posix()
            if not path.is_file() or name.startswith(("tests/fuzz/corpus/", "tests/laws/")):
                continue
            if path.suffix == ".md":
                pages[name] = path.read_text(encoding="utf-8")
            elif path.suffix in SOURCES:
                sources[name] = path.read_text(encoding="utf-8")
    return pages, sources


def control():
    def found(pages, sources=None):
        files = {*pages, *(sources or {}), "docs/a.svg"}
        return check(pages, sources or {}, lambda path: path in files)

    index = "[a](a.md)\n"
    good = {"docs/index.md": index + "[b](sub/b.md#two-words) [c](#c) [d](https://x.y/z#q) ![p](a.svg)\n# C\n`[x](y.md)`\n",
            "docs/a.md": "# A\n```\n[x](nowhere.md)\n# not a heading\n```\n", "docs/sub/b.md": "## Two words\n[a](../a.md)\n"}
    expect_only(found(good))
    expect_only(found({"docs/index.md": index + "[b](b.md)\n", "docs/a.md": ""}), "docs/index.md:2: b.md: no such file")
    expect_only(found({"docs/index.md": index, "docs/a.md": "\n[x](index.md#gone)\n"}), "docs/a.md:2: index.md#gone: no such heading")
    expect_only(found({"docs/index.md": index, "docs/a.md": "# B\n# B\n[x](#b)\n"}), "docs/a.md:3: #b: several headings")
    expect_only(found({"docs/index.md": index, "docs/a.md": "# B – c\n[x](#b--c)\n"}), "docs/a.md:2: #b--c: MkDocs calls it #b-c")
    expect_only(found({"docs/index.md": "", "docs/a.md": ""}), "docs/a.md: docs/index.md does not link it")
    expect_only(found({"docs/index.md": ""}, {"core/a.h": "// see\n// docs/gone.md.\n"}), "core/a.h:2: docs/gone.md: no such page")
    print("the control is caught")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--root", default=".", type=pathlib.Path)
    parser.add_argument("--control", action="store_true")
    arguments = parser.parse_args()
    if arguments.control:
        return control()
    pages, sources = read_tree(arguments.root)
    findings = check(pages, sources, lambda path: (arguments.root / path).exists())
    links = sum(len(links_of(text)) for text in pages.values())
    print("\n".join([*findings, f"{len(pages)} pages, {links} links, {len(findings)} findings"]))
    return 1 if findings or not pages else 0


if __name__ == "__main__":
    sys.exit(main())
