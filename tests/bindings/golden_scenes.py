"""Compares the hashes that a program plays through a binding with those in tests/golden/scenes.json.

usage: golden_scenes.py [--some] PROGRAM…

--some plays eight short scenes alone: enough for a binding, for the library is the same. PROGRAM (SCENE TICKS)… prints, for each scene, its name and the hashes of every tenth tick and of the
last, on one line.
"""

import json
import pathlib
import subprocess
import sys

golden = json.loads((pathlib.Path(__file__).resolve().parents[1] / "golden" / "scenes.json").read_text())
program = sys.argv[1:]
if program[0] == "--some":
    program = program[1:]
    golden = dict(sorted(golden.items(), key=lambda scene: (scene[1]["ticks"], scene[0]))[:8])
arguments = [word for name, scene in golden.items() for word in (name, str(scene["ticks"]))]
done = subprocess.run([*program, *arguments], check=True, capture_output=True, text=True)
played = {name: chain for name, *chain in map(str.split, done.stdout.splitlines())}
wrong = [name for name, scene in golden.items() if played.get(name) != scene["chain"]]
print(f"{len(golden)} scenes, {len(wrong)} other than on record {' '.join(wrong)}")
sys.exit(1 if wrong or not golden else 0)
