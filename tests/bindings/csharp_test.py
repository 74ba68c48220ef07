"""The package of C#: its tests, a behaviour of Unity against stubs, the README's program, some golden scenes.

usage: csharp_test.py ROOT BUILD-FOLDER LIBRARY MCS MONO
"""

import os
import pathlib
import re
import subprocess
import sys

root, build, library = map(pathlib.Path, sys.argv[1:4])
mcs, mono = sys.argv[4:6]
package, tests = root / "tools/bindings/csharp", root / "tests/bindings/csharp"
runtime = package / "com.lockstone.core/Runtime"
environment = {**os.environ, "LD_LIBRARY_PATH": str(library.parent)}
build.mkdir(exist_ok=True)


def run(*command, **options):
    return subprocess.run([str(word) for word in command], check=True, env=environment, cwd=build, text=True, **options)


def compile(target, *sources, references=()):
    kind = "library" if target.endswith(".dll") else "exe"
    # The compiler warns of C structures whose fields only C writes.
    run(mcs, "-unsafe", "-langversion:7.2", "-warnaserror+", "-nowarn:649", f"-target:{kind}", f"-out:{target}",
        *[f"-r:{name}.dll" for name in references], *sources)


compile("Lockstone.dll", *sorted(runtime.glob("*.cs")))
compile("UnityEngine.dll", tests / "UnityStubs.cs")
compile("Lockstone.Unity.dll", *sorted((runtime / "Unity").glob("*.cs")), references=["Lockstone", "UnityEngine"])
pushers = package / "examples/Pushers.cs"
compile("SessionTest.exe", tests / "SessionTest.cs", pushers, references=["Lockstone", "UnityEngine", "Lockstone.Unity"])
compile("Play.exe", package / "examples/Play.cs", pushers, references=["Lockstone"])
compile("Ball.exe", package / "examples/Ball.cs", references=["Lockstone"])
compile("GoldenScenes.exe", package / "examples/GoldenScenes.cs", references=["Lockstone"])

run(mono, "SessionTest.exe")
readme = re.search(r"^```csharp\n(.*?)^```$", (package / "README.md").read_text(), re.DOTALL | re.MULTILINE)[1]
assert readme == (package / "examples/Ball.cs").read_text(), "the README's program is not examples/Ball.cs"
printed = run(mono, "Ball.exe", capture_output=True).stdout
assert printed.startswith("y = 250 mm, hash "), printed
print(printed, end="")
run(sys.executable, "-B", root / "tests/bindings/golden_scenes.py", "--some", mono, build / "GoldenScenes.exe")
