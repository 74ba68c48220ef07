"""Puts the library that LOCKSTONE_LIBRARY names into the wheel, which is then one of this platform."""

import os
import pathlib
import re
import shutil

from setuptools import setup
from setuptools.command.build_py import build_py
from wheel.bdist_wheel import bdist_wheel

HERE = pathlib.Path(__file__).resolve().parent
LIBRARY = os.environ.get("LOCKSTONE_LIBRARY")


def version() -> str:
    """That of the project, from the CMakeLists.txt of the checkout."""
    found = re.search(r"project\(\w+\s+VERSION\s+([\d.]+)", (HERE.parents[2] / "CMakeLists.txt").read_text())
    assert found is not None
    return found[1]


class BuildWithLibrary(build_py):
    def run(self) -> None:
        super().run()
        if LIBRARY is not None:
            shutil.copy(LIBRARY, pathlib.Path(self.build_lib, "lockstone", pathlib.Path(LIBRARY).name))


class WheelOfPlatform(bdist_wheel):
    """Any Python of this platform: ctypes needs no extension module. Without a library: of any platform."""

    def finalize_options(self) -> None:
        super().finalize_options()
        self.root_is_pure = LIBRARY is None

    def get_tag(self) -> tuple[str, str, str]:
        return "py3", "none", "any" if LIBRARY is None else super().get_tag()[2]


setup(version=version(), cmdclass={"build_py": BuildWithLibrary, "bdist_wheel": WheelOfPlatform})
