"""The examples of the bindings' pages: all print the same state of the same world.

usage: pages_test.py ROOT C-PROGRAM
"""

import pathlib
import re
import subprocess
import sys

root, program = pathlib.Path(sys.argv[1]), sys.argv[2]
pages = [root / "docs/how-to/bindings.md", root / "tools/bindings/python/README.md"]
code = [re.findall(r"^```python\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE) for page in pages]
commands = [[program]] + [[sys.executable, "-B", "-c", block] for blocks in code for block in blocks]
lines = [subprocess.run(command, check=True, capture_output=True, text=True).stdout for command in commands]
print(*lines, sep="", end="")
hashes = {line.split()[-1] for line in lines}
sys.exit(0 if len(lines) == 3 and len(hashes) == 1 and all("y = " in line for line in lines) else 1)
