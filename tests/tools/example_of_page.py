"""The example game is the one of the page: each block of C++ that the example's source holds stands in the page,
word for word.

usage: example_of_page.py PAGE SOURCE
"""

import pathlib
import re
import sys

page, source = (pathlib.Path(path).read_text() for path in sys.argv[1:3])
code = "\n".join(re.findall(r"^```cpp\n(.*?)^```$", page, re.DOTALL | re.MULTILINE))
body = source[source.index("using namespace lockstone;"):].replace("inline Result", "Result")
missing = [part for part in body.split("\n\n") if part.strip() not in code]
for part in missing:
    print(f"{sys.argv[2]}: not in the page:\n{part}\n")
sys.exit(bool(missing))
