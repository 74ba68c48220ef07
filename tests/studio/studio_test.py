"""The studio's page in headless Chromium: skipped unless the command has the page, and the page is newer than its sources.
`tools/studio.sh test` builds both.

usage: studio_test.py ROOT COMMAND
"""

import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
root, command = pathlib.Path(sys.argv[1]), sys.argv[2]
page = root / "build/studio/page"
sources = [path for folder in ("core", "replay", "tools/arena", "tools/scenes", "tools/studio/src", "tools/studio/native", "tools/web/src")
           for path in (root / folder).rglob("*") if path.is_file()]


def skip(reason):
    print(reason)
    sys.exit(SKIPPED)


if not shutil.which("node") or not shutil.which("chromium"):
    skip("Node or Chromium is not installed")
if "Serve a page on this machine" not in subprocess.run([command, "--help"], capture_output=True, text=True, check=True).stdout:
    skip("the command has no studio: tools/studio.sh builds it")
if not (root / "build/studio/node/node_modules/playwright-core").is_dir():
    skip("the browser's driver is not there: tools/studio.sh fetches it")
if min(path.stat().st_mtime for path in page.iterdir()) < max(path.stat().st_mtime for path in sources):
    skip("the page is older than its sources: tools/studio.sh builds it")
tests = sorted(str(path) for path in (root / "tools/studio/test").glob("*.test.mjs"))
result = subprocess.run(["node", "--test", "--test-concurrency=1", *tests], env={**os.environ, "LOCKSTONE_COMMAND": command}, check=False)
sys.exit(result.returncode)
