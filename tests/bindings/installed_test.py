"""Installs the C library into a scratch folder and builds a program there by pkg-config, as a user would.

usage: installed_test.py CMAKE BUILD-FOLDER SOURCE
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

cmake, build, source = sys.argv[1:4]
if shutil.which("pkg-config") is None or shutil.which("cc") is None:
    print("needs pkg-config and cc")
    sys.exit(77)
with tempfile.TemporaryDirectory() as folder:
    for component in ("runtime", "c"):
        subprocess.run([cmake, "--install", build, "--component", component, "--prefix", folder], check=True,
                       stdout=subprocess.DEVNULL)
    package = next(pathlib.Path(folder).rglob("lockstone_c.pc"))
    environment = {**os.environ, "PKG_CONFIG_PATH": str(package.parent), "LD_LIBRARY_PATH": str(package.parents[1])}
    flags = subprocess.run(["pkg-config", "--cflags", "--libs", "lockstone_c"], check=True, env=environment,
                           capture_output=True, text=True).stdout.split()
    program = f"{folder}/program"
    subprocess.run(["cc", "-std=c11", "-Wall", "-Werror", source, "-o", program, *flags], check=True)
    printed = subprocess.run([program], check=True, env=environment, capture_output=True, text=True).stdout
    needed = subprocess.run(["readelf", "-d", program], check=True, capture_output=True, text=True).stdout
print(printed, end="")
assert printed.startswith("y = 250 mm, hash "), printed
assert "[liblockstone_c.so.0]" in needed, needed
