"""Compiles the wide kernels and their checks for 64-bit ARM, where the lanes are NEON's, and runs them
under qemu.

usage: neon.py ROOT HEADERS…

HEADERS are the header files and folders of others that the sources need: the same for every processor,
they are shown to the cross compiler through links. Without that compiler or qemu the test is skipped.
"""

import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

COMPILER, EMULATOR = "aarch64-linux-gnu-g++", "qemu-aarch64"
SKIPPED = 77


def main():
    root, headers = pathlib.Path(sys.argv[1]), map(pathlib.Path, sys.argv[2:])
    lacking = [program for program in (COMPILER, EMULATOR) if shutil.which(program) is None]
    if lacking:
        print("not here:", *lacking)
        return SKIPPED
    sources = [path for folder in ("core/base", "core/math", "core/kernels") for path in (root / folder).rglob("*.cpp")]
    sources += [path for path in (root / "tests/kernels").glob("*.cpp") if not path.name.endswith("_test.cpp")]
    with tempfile.TemporaryDirectory() as folder:
        for header in headers:
            os.symlink(header, pathlib.Path(folder, header.name))
        program = pathlib.Path(folder, "wide_check")
        subprocess.run([COMPILER, "-std=c++20", "-O2", "-static", "-Wall", "-Wextra", "-DLOCKSTONE_WITH_HIGHWAY",
                        "-isystem", folder, "-I", root, "-I", root / "core/include", "-o", program, *sources],
                       check=True)
        done = subprocess.run([EMULATOR, program], capture_output=True, text=True, timeout=200)
    print(done.stdout, done.stderr)
    return done.returncode if "neon" in done.stdout else 1


if __name__ == "__main__":
    sys.exit(main())
