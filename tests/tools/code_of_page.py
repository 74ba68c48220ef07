"""Writes the C++ blocks of a page, in order, as one source file.

usage: code_of_page.py PAGE SOURCE
"""

import pathlib
import re
import sys

page, source = map(pathlib.Path, sys.argv[1:])
blocks = re.findall(r"^```cpp\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)
source.write_text("\n".join(blocks))
