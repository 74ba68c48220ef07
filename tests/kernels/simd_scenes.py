"""Every scene has the same hashes whichever vectors compute it.

usage: simd_scenes.py LOCKSTONE

Names that this processor or build does not have are reported and left out; `scalar` is always there.
"""

import json
import subprocess
import sys

NAMES = ["scalar", "sse4", "avx2", "avx512", "neon", "wasm"]
WRONG_USAGE = 64


def ask(lockstone, *arguments):
    """The JSON that the command prints, or None when it does not know an argument's value."""
    done = subprocess.run([lockstone, *arguments, "--json"], capture_output=True, text=True, timeout=120)
    if done.returncode == WRONG_USAGE:
        return None
    done.check_returncode()
    return json.loads(done.stdout)


def hashes(lockstone, scene, *arguments):
    answer = ask(lockstone, "run", "--scene", scene["name"], "--ticks",
                 str(scene["golden_ticks"]), *arguments)
    return answer and (answer["final_hash"], [entry["hash"] for entry in answer["chain"]])


def main():
    lockstone = sys.argv[1]
    scenes = ask(lockstone, "scenes")
    present = [name for name in NAMES if hashes(lockstone, scenes[0], "--simd", name) is not None]
    print("targets:", *present)
    if "scalar" not in present or hashes(lockstone, scenes[0], "--simd", "abacus") is not None:
        print("scalar must be known, and abacus must not")
        return 1
    wrong = 0
    for scene in scenes:
        # Without --simd one of the names is taken: golden_scenes compares that with the record.
        wanted, *others = [hashes(lockstone, scene, "--simd", name) for name in present]
        different = [name for name, other in zip(present[1:], others) if other != wanted]
        print(f"{scene['name']:<14} {wanted[0]}", *(f"other on {name}" for name in different))
        wrong += len(different)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
