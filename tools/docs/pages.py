"""Copies docs/ for MkDocs. Links that leave docs/ become plain text; those to the README lead to the index.

usage: pages.py ROOT TARGET
"""

import pathlib
import posixpath
import re
import shutil
import sys

LINK = re.compile(r"\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s#]+)(?:#[^)\s]*)?\)")
API = """# API

- [All files](api/files.html): the public headers of `lockstone::core`, `lockstone::net` and `lockstone::replay`
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


def main():
    root, target = map(pathlib.Path, sys.argv[1:3])
    docs = root / "docs"
    names = {path.relative_to(docs).as_posix() for path in docs.rglob("*") if path.is_file()}
    shutil.rmtree(target, ignore_errors=True)
    shutil.copytree(docs, target)
    for path in target.rglob("*.md"):
        page = path.relative_to(target).as_posix()
        path.write_text(rewritten(page, path.read_text(encoding="utf-8"), names), encoding="utf-8")
    (target / "api.md").write_text(API, encoding="utf-8")


main()
