"""Only the parts that a program names are linked: one that uses spheres and boxes has no code of hulls,
meshes and height fields, and is smaller than one that does.

usage: link_test.py NM PRIMITIVES ASSETS
"""

import pathlib
import re
import subprocess
import sys

# Making, reading and colliding assets. Names of types alone (a mesh's kernels are a null pointer to
# a program without meshes) are no code.
UNUSED = re.compile(r"lockstone::(?:\w+::)*(Hull|Mesh|HeightField|Compound)::|load_asset|MeshData|"
                    r"HeightFieldData|collide_polytope|MeshContacts|StaticTree::")


def code_of(nm, program):
    """{symbol: bytes} of the program's text section."""
    text = subprocess.run([nm, "-C", "-S", "--defined-only", program], check=True, capture_output=True,
                          text=True).stdout
    sizes = {}
    for line in text.splitlines():
        found = re.match(r"[0-9a-f]+ ([0-9a-f]+) [tTwW] (.*)", line)
        if found:
            sizes[found[2]] = int(found[1], 16)
    return sizes


def main():
    nm, primitives, assets = sys.argv[1:]
    small, large = code_of(nm, primitives), code_of(nm, assets)
    wrong = [symbol for symbol in small if UNUSED.search(symbol)]
    for symbol in wrong:
        print(f"linked, but never used: {symbol}")
    control = [symbol for symbol in large if UNUSED.search(symbol)]
    if not control:
        print("the control has no such code either: this test cannot fail")
    for name, sizes, program in (("primitives", small, primitives), ("assets", large, assets)):
        print(f"{name:<11} {sum(sizes.values()):>8} bytes of named code, "
              f"{pathlib.Path(program).stat().st_size:>8} in the file")
    if not small or sum(small.values()) >= sum(large.values()):
        print("the program without assets is no smaller")
        return 1
    return 1 if wrong or not control else 0


if __name__ == "__main__":
    sys.exit(main())
