"""The libraries, the player of scenes under Node and the C interface of the npm package compile for WebAssembly
with the C++ library of Debian's Emscripten (libc++ 14): of algorithms on ranges there are those of the toolchain's
wasm_algorithms.h, and some of C++20 is not there at all."""

import pathlib
import re

from cpp_source import Tree, code_only, expect_only, matching_lines, run_law

FOLDERS = ["core", "net", "replay", "tools/arena", "tools/bench/neutral", "tools/bench/player", "tools/bindings/c",
           "tools/cmake/toolchains", "tools/scenes", "tools/web"]
SHIM = pathlib.PurePosixPath("tools/cmake/toolchains/wasm_algorithms.h")

MISSING = {"make_unique_for_overwrite", "make_shared_for_overwrite", "format", "jthread", "stop_token",
           "atomic_ref", "source_location", "bind_front"}
# No algorithms.
OTHERS = {"less", "greater", "equal_to"}

ALGORITHM = re.compile(r"(?<=\bstd::ranges::)\w+")
NAME = re.compile(r"(?<=\bstd::)\w+")


def given(shim):
    """The functions that the toolchain's header defines."""
    return set(re.findall(r"^constexpr \w+ (\w+)\(", shim, re.MULTILINE))


def check(tree):
    known = given(tree.files[SHIM]) | OTHERS
    findings = []
    for file, text in tree.items():
        if file == SHIM:
            continue
        code = code_only(text)
        findings += [f"{file}:{line}: std::ranges::{name} is not in {SHIM}"
                     for line, name in matching_lines(ALGORITHM, code) if name not in known]
        findings += [f"{file}:{line}: std::{name} is not in libc++ 14"
                     for line, name in matching_lines(NAME, code) if name in MISSING]
    return findings


def control():
    shim = {SHIM.as_posix(): "constexpr auto find(\nconstexpr void fill(\n"}

    def found(line):
        return check(Tree(shim | {"core/base/a.cpp": f"// std::ranges::rotate\n{line}\n"}))

    expect_only(found("std::ranges::rotate(a, b);"), "core/base/a.cpp:2: std::ranges::rotate is not in")
    expect_only(found("auto p = std::make_unique_for_overwrite<int[]>(3);"), "a.cpp:2: std::make_unique_for_overwrite is not")
    # Must pass.
    expect_only(found("std::ranges::find(a, std::ranges::less{});"))
    expect_only(found("std::ranges::fill(a, 0); std::make_unique<int[]>(3);"))


if __name__ == "__main__":
    run_law(check, control, FOLDERS)
