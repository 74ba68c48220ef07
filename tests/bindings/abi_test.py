"""tools/abi.sh is silent about an unchanged interface and loud about a broken one.

usage: abi_test.py ROOT
"""

import pathlib
import shutil
import subprocess
import sys
import tempfile

root = pathlib.Path(sys.argv[1])
headers = root / "tools/bindings/c"
USER_DATA = "uint64_t user_data; /* the game's own; part of the state */"

# Name, file, text, its replacement, text that abidiff must print (None: the change is compatible).
CASES = [
    ("the same", "bodies.h", USER_DATA, USER_DATA, None),
    ("a new function", "base.h", "LKS_API uint32_t lks_c_abi(void);",
     "LKS_API uint32_t lks_c_abi(void); LKS_API uint32_t lks_new(uint32_t x);", None),
    ("a removed field", "bodies.h", USER_DATA, "", "user_data"),
    ("a field of another type", "bodies.h", USER_DATA, "uint32_t user_data[2];", "user_data"),
    ("a removed function", "base.h", "LKS_API uint32_t lks_c_abi(void);", "", "lks_c_abi"),
    ("another argument", "state.h", "lks_hash(const lks_world* world, uint64_t* out)",
     "lks_hash(const lks_world* world, uint32_t* out)", "lks_hash"),
]

if shutil.which("abidiff") is None:
    print("abidiff is not there: apt-get install abigail-tools")
    sys.exit(77)
wrong = 0
for name, file, text, replacement, said in CASES:
    with tempfile.TemporaryDirectory() as folder:
        changed = pathlib.Path(folder) / "c"
        shutil.copytree(headers, changed)
        path = changed / "lockstone_c" / file
        old = path.read_text()
        assert old.count(text) == 1, (name, text)
        path.write_text(old.replace(text, replacement))
        done = subprocess.run([root / "tools/abi.sh", headers, changed], capture_output=True, text=True)
    right = done.returncode == 0 if said is None else done.returncode & 4 and said in done.stdout
    print(f"{name}: status {done.returncode}{'' if right else ', WRONG'}\n{'' if right else done.stdout + done.stderr}", end="")
    wrong += not right
sys.exit(wrong)
