"""Prints, or writes to a file, a page's blocks of one language, one after the other.

usage: page_code.py PAGE LANGUAGE [FILE]
"""

import pathlib
import re
import sys

page, language = pathlib.Path(sys.argv[1]), sys.argv[2]
blocks = re.findall(rf"^```{language}\n(.*?)^```$", page.read_text(), re.DOTALL | re.MULTILINE)
if not blocks:
    sys.exit(f"{page}: no block of {language}")
if len(sys.argv) > 3:
    pathlib.Path(sys.argv[3]).write_text("\n".join(blocks))
else:
    print("\n".join(blocks))
