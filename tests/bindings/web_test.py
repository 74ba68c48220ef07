"""The npm package in Node, on eight golden scenes: skipped unless `tools/web.sh` has built it from the present sources.
`tools/web.sh test` plays all of them, in Chromium too. With Chromium at hand two tabs play a match of ten seconds with native clients of
the command.

usage: web_test.py ROOT [LOCKSTONE]
"""

import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
root = pathlib.Path(sys.argv[1])
package = root / "build/web/package/dist"
modules = sorted(package.glob("*.wasm"))
sources = [path for folder in ("core", "tools/arena", "tools/bindings/c", "net", "replay", "tools/scenes", "tools/web/src", "tools/web/native")
           for path in (root / folder).rglob("*") if path.is_file()]

if not shutil.which("node") or len(modules) < 6:
    sys.exit(SKIPPED)
if min(path.stat().st_mtime for path in package.iterdir()) < max(path.stat().st_mtime for path in sources):
    print("the package is older than its sources: tools/web.sh builds it")
    sys.exit(SKIPPED)
tests = [str(root / f"tools/web/test/{name}.test.mjs") for name in ("units", "world", "golden", "package", "match")]
command = {"LOCKSTONE_COMMAND": sys.argv[2]} if sys.argv[2:] and sys.argv[2] else {}
sys.exit(subprocess.run(["node", "--test", *tests], env={**os.environ, **command, "LOCKSTONE_WEB_SCENES": "some"}, check=False).returncode)
