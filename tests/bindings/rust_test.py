"""The crates of Rust: their tests, the README's program, some golden scenes, the game as a library for the command.

usage: rust_test.py ROOT BUILD-FOLDER LIBRARY CARGO
"""

import os
import pathlib
import re
import subprocess
import sys

root, build, library, cargo = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), pathlib.Path(sys.argv[3]), sys.argv[4]
crates = root / "tools/bindings/rust"
environment = {**os.environ, "LOCKSTONE_LIB_DIR": str(library.parent), "LD_LIBRARY_PATH": str(library.parent),
               "CARGO_TARGET_DIR": str(build), "CARGO_INCREMENTAL": "0"}


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, env=environment, text=True, **options)


# The library may have changed without any source of Rust.
run(cargo, "test", "--release", "--offline", "--locked", "--quiet", "--lib", "--tests", "--examples", cwd=crates)
run(cargo, "build", "--release", "--offline", "--locked", "--quiet", "--examples", cwd=crates)
examples = build / "release/examples"

readme = re.search(r"^```rust\n(.*?)^```$", (crates / "README.md").read_text(), re.DOTALL | re.MULTILINE)[1]
assert readme == (crates / "lockstone/examples/ball.rs").read_text(), "the README's program is not examples/ball.rs"
printed = run(examples / "ball", capture_output=True).stdout
assert printed.startswith("y = 250 mm, hash "), printed
print(printed, end="")

run(sys.executable, "-B", root / "tests/bindings/golden_scenes.py", "--some", examples / "golden_scenes")

command = library.parents[2] / "lockstone"
if command.exists():
    game, log = [command, "--game", examples / "libpushers_game.so"], build / "rust.lks"
    run(*game, "record", log, "--players", 2, "--ticks", 120, "--force", capture_output=True)
    verified = run(*game, "verify", "--strict", log, capture_output=True).stdout
    assert "same; 120 ticks verified" in verified, verified
    print(verified, end="")
