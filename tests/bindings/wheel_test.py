"""Builds a wheel with the library in it, installs it into a scratch folder and runs the README's example there.

usage: wheel_test.py PACKAGE-FOLDER LIBRARY
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

package, library = map(pathlib.Path, sys.argv[1:3])


def can_build_wheels(python: str) -> bool:
    done = subprocess.run([python, "-c", "import setuptools, wheel, pip"], capture_output=True)
    return done.returncode == 0


python = next(filter(can_build_wheels, filter(shutil.which, (sys.executable, "/usr/bin/python3"))), None)
if python is None:
    print("needs a Python with pip, setuptools and wheel")
    sys.exit(77)
pip = [python, "-m", "pip", "--disable-pip-version-check", "--no-cache-dir"]
offline = ["--no-deps", "--no-index", "-q"]
environment = {name: value for name, value in os.environ.items() if name not in ("LOCKSTONE_LIBRARY", "PYTHONPATH")}
with tempfile.TemporaryDirectory() as scratch:
    folder = pathlib.Path(scratch)
    # A build writes beside its sources: let it do so in a copy of the checkout's two places that it reads.
    copy = folder / "checkout" / "tools" / "bindings" / "python"
    shutil.copytree(package, copy)
    shutil.copy(package.parents[2] / "CMakeLists.txt", folder / "checkout")
    subprocess.run([*pip, "wheel", *offline, "--no-build-isolation", "--wheel-dir", folder, copy], check=True,
                   env={**environment, "LOCKSTONE_LIBRARY": str(library)})
    (wheel,) = folder.glob("*.whl")
    print(wheel.name)
    assert re.fullmatch(r"lockstone-[\d.]+-py3-none-linux_\w+\.whl", wheel.name), wheel.name
    subprocess.run([*pip, "install", *offline, "--target", folder / "site", wheel], check=True, env=environment)
    example = re.search(r"```python\n(.*?)```", (package / "README.md").read_text(), re.DOTALL)
    assert example is not None
    printed = subprocess.run([python, "-c", example[1]], check=True, capture_output=True, text=True, cwd=folder,
                             env={**environment, "PYTHONPATH": str(folder / "site")}).stdout
print(printed, end="")
assert re.fullmatch(r"y = 0\.2(49|50)\d{3} m, hash [0-9a-f]{16}\n", printed), printed
