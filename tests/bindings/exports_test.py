"""The library exports exactly the functions that the header declares, and has one for each command.

usage: exports_test.py NM LIBRARY HEADERS COMMAND-HEADER
"""

import pathlib
import re
import subprocess
import sys

nm, library, headers, commands = sys.argv[1:5]
text = "".join(path.read_text() for path in sorted(pathlib.Path(headers).rglob("*.h")))
declared = set(re.findall(r"LKS_API[^;(]*?(lks_\w+)\(", text))
listed = subprocess.run([nm, "-D", "--defined-only", library], check=True, capture_output=True, text=True)
exported = {words[2].partition("@")[0] for words in map(str.split, listed.stdout.splitlines()) if words[1] != "A"}
manifest = re.findall(r"X\((\w+)\)", pathlib.Path(commands).read_text())
wanted = {"lks_" + re.sub(r"(?<!^)([A-Z])", r"_\1", name).lower() for name in manifest}

faults = [f"declared, not exported: {name}" for name in sorted(declared - exported)]
faults += [f"exported, not declared: {name}" for name in sorted(exported - declared)]
faults += [f"no function for a command: {name}" for name in sorted(wanted - declared)]
print(f"{len(exported)} functions, {len(wanted)} commands")
sys.exit("\n".join(faults) if faults or not wanted else 0)
