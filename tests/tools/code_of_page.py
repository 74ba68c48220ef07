"""Writes the C++ blocks of a page, in order, as one source file.

usage: code_of_page.py PAGE SOURCE [FUNCTION LINES]…

A FUNCTION of more than LINES lines is an error: the page promises that it is short.
"""

import pathlib
import re
import sys

page, source = map(pathlib.Path, sys.argv[1:3])
blocks = re.findall(r"^```cpp\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)
code = "\n".join(blocks)
for name, limit in zip(sys.argv[3::2], sys.argv[4::2]):
    body = re.search(rf"^\w[^\n]* {name}\(.*?^}}$", code, re.DOTALL | re.MULTILINE)
    if body is None or body[0].count("\n") >= int(limit):
        sys.exit(f"{page}: {name} is missing, or has more than {limit} lines")
source.write_text(code)
