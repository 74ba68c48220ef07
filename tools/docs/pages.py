"""Copies docs/ for MkDocs, with its configuration: TARGET/pages and TARGET/mkdocs.yml. Links that leave
docs/ become plain text; those to the README lead to the index. The navigation follows docs/index.md:
its headings, and below each the pages that it links.

usage: pages.py ROOT TARGET
"""

import pathlib
import posixpath
import re
import shutil
import sys

LINK = re.compile(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(?:#[^)\s]*)?\)")
API = """# API

- [All files](api/files.html): the public headers of `lockstone::core`, `lockstone::net`, `lockstone::replay` and `lockstone::view`
- [All classes](api/annotated.html)
- [World](api/classlockstone_1_1World.html), [Simulation](api/classlockstone_1_1Simulation.html),
  [Server](api/classlockstone_1_1net_1_1Server.html), [Client](api/classlockstone_1_1net_1_1Client.html),
  [Recorder](api/classlockstone_1_1replay_1_1Recorder.html)
- [Search](api/index.html) has a field at the upper right

The C interface is documented in `tools/bindings/c/lockstone.h`.
"""


def within(page, target):
    return posixpath.normpath(posixpath.join(posixpath.dirname(page), target))


def rewritten(page, text, names):
    """The page with links that MkDocs can follow. `names` are the files and folders of docs/."""
    def link(match):
        words, target = match[1], match[2]
        full = within(page, target)
        if re.match(r"\w+:", target) or full in names:
            return match[0]
        if full == "../README.md":
            return f"[{words}]({posixpath.relpath('index.md', posixpath.dirname(page) or '.')})"
        return words

    return LINK.sub(link, text)


def navigation(index):
    """The `nav` of mkdocs.yml."""
    lines = ["nav:", "  - Home: index.md"]
    for section in re.split(r"^## ", index, flags=re.MULTILINE)[1:]:
        title, _, text = section.partition("\n")
        pages = [(match[1], match[2]) for match in LINK.finditer(text) if match[2].endswith(".md")]
        lines += [f"  - {title}:", *(f'      - "{words}": {page}' for words, page in pages)]
        if title == "Reference":
            lines.append("      - API: api.md")
    return "\n".join(lines) + "\n"


def main():
    root, folder = map(pathlib.Path, sys.argv[1:3])
    docs, target = root / "docs", folder / "pages"
    names = {path.relative_to(docs).as_posix() for path in docs.rglob("*") if path.is_file()}
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(docs, target)
    for path in target.rglob("*.md"):
        page = path.relative_to(target).as_posix()
        path.write_text(rewritten(page, path.read_text(encoding="utf-8"), names), encoding="utf-8")
    (target / "api.md").write_text(API, encoding="utf-8")
    configuration = (root / "tools/docs/mkdocs.yml").read_text(encoding="utf-8")
    index = (docs / "index.md").read_text(encoding="utf-8")
    (folder / "mkdocs.yml").write_text(configuration + navigation(index), encoding="utf-8")


main()
