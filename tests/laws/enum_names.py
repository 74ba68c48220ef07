"""Every enumeration of a public header has a `to_string`, so that logs need no table of their own.

usage: enum_names.py --root FOLDER | --control
"""

import pathlib
import re
import sys

ROOMS = ("core", "net", "replay")
ENUM = re.compile(r"^enum class (?:\[\[\w+\]\] )?(\w+)", re.MULTILINE)  # of a namespace: not indented


def unnamed(texts):
    """The enumerations of some headers' texts, of one namespace, that no `to_string` takes."""
    whole = "\n".join(texts)
    return sorted(name for name in set(ENUM.findall(whole))
                  if not re.search(rf"\bto_string\({name}\b", whole))


def check(root):
    faults = []
    for room in ROOMS:
        headers = sorted((root / room / "include").rglob("*.h"))
        assert headers, room
        faults += [f"{room}: {name} has no to_string"
                   for name in unnamed(path.read_text() for path in headers)]
    return faults


def control():
    named = "enum class Fruit : int { apple };\nstd::string_view to_string(Fruit fruit);\n"
    assert unnamed([named]) == []
    assert unnamed([named, "enum class Nut { hazel };\n"]) == ["Nut"]
    assert unnamed(["enum class [[nodiscard]] Status : int{\n"]) == ["Status"]
    assert unnamed(["class A {\n  enum class Inner { one };\n};\n"]) == []


if sys.argv[1:] == ["--control"]:
    control()
else:
    sys.exit("\n".join(check(pathlib.Path(sys.argv[2]))) or 0)
