"""Compares the hashes of every scene with those on record in tests/golden/scenes.json.

usage: golden_scenes.py LOCKSTONE [--update]

--update writes the hashes of this build: for a change that is meant to change results. Say why in
docs/explanation/determinism.md and raise k_simulation_abi. Without the file the test is skipped (exit code 77).
"""

import json
import pathlib
import subprocess
import sys

FILE = pathlib.Path(__file__).resolve().parents[1] / "golden" / "scenes.json"
SKIPPED = 77


def ask(lockstone, *arguments):
    done = subprocess.run([lockstone, *arguments], check=True, capture_output=True,
                          text=True, timeout=280)
    return json.loads(done.stdout)


def compute(lockstone):
    """{scene: {ticks, hashes}}: the whole chain, so that a failure names the first wrong stretch."""
    hashes = ask(lockstone, "hash", "--suite", "golden", "--name", "here")
    assert hashes["name"] == "here"
    chains = hashes["scenes"]
    ticks = {scene["name"]: scene["golden_ticks"] for scene in ask(lockstone, "scenes", "--json")}
    return {name: {"ticks": ticks[name], "final_hash": chain[-1], "chain": chain}
            for name, chain in chains.items()}


def complain(name, golden, actual):
    print(f"{name}: {actual['final_hash']} after {actual['ticks']} ticks, "
          f"expected {golden['final_hash']} after {golden['ticks']}")
    for position, (want, have) in enumerate(zip(golden["chain"], actual["chain"])):
        if want != have:
            print(f"  first difference at chain entry {position}: {have}, expected {want}")
            return


def main():
    lockstone = sys.argv[1]
    actual = compute(lockstone)
    if "--update" in sys.argv[2:]:
        FILE.write_text(json.dumps(actual, indent=1) + "\n")
        print(f"{len(actual)} scenes written")
        return 0
    for name, entry in actual.items():
        print(f"{name:<10} {entry['ticks']:>4} {entry['final_hash']}")
    if not FILE.exists():
        print("no golden hashes yet")
        return SKIPPED
    golden = json.loads(FILE.read_text())
    wrong = [name for name in golden | actual if golden.get(name) != actual.get(name)]
    for name in wrong:
        if name in golden and name in actual:
            complain(name, golden[name], actual[name])
        else:
            print(f"{name}: only {'on record' if name in golden else 'in this build'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
