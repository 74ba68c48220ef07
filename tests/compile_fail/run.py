"""Wrong code does not compile, with a message that helps; its correct neighbour does.

usage: run.py COMPILER INCLUDE [--control]
"""

import os
import re
import subprocess
import sys

FRONT = """#include <lockstone/literals.h>
using namespace lockstone;
using namespace lockstone::literals;
"""
# The header of worlds takes thrice as long to compile, and few lines need it.
WORLD = "#include <lockstone/world.h>\n"
NEEDS_WORLD = re.compile(r"\b(?:World|BodyDef|Shape|RayHit|ApplyImpulse)")

GAME = "#include <lockstone/game_math.h>\n"
NEEDS_GAME = re.compile(r"\b(?:sqrt|sin|Random)\b")

# The wrong line, the right one in its place, and a word of the message.
BARE = "Fixed|no viable"
PAIRS = [
    ("BodyDef d; void f() { d.position = {1, 2, 3}; }",
     "BodyDef d; void f() { d.position = {1_m, 2_m, 3_m}; }", BARE),
    ("WorldDef d{.gravity = {0, -10, 0}};", "WorldDef d{.gravity = {{}, -10_mps2, {}}};", BARE),
    ("BodyDef d{.velocity = {1, {}, {}}};", "BodyDef d{.velocity = {1_mps, {}, {}}};", BARE),
    ("BodyDef d{.gravity_scale = {2}};", "BodyDef d{.gravity_scale = {2_r}};", BARE),
    ("Shape s = Shape::sphere({1});", "Shape s = Shape::sphere({1_m});", BARE),
    ("Length l{5};", "Length l{5_m};", BARE),
    ("Length l(5);", "Length l(5_m);", BARE),
    ("Length l = 5;", "Length l = 5_m;", BARE),
    ("Length l = {.raw = 5};", "Length l = Length::from_raw(5);", "raw|initializer"),
    ("Length l = 0.5;", "Length l = 0.5_m;", BARE),
    ("bool f(Length l) { return l == 0; }", "bool f(Length l) { return l == 0_m; }", BARE),
    ("bool f(Length l) { return l > 1; }", "bool f(Length l) { return l > 1_m; }", BARE),
    ("Length f(Length l) { return l + 1; }", "Length f(Length l) { return l + 1_m; }", BARE),
    ("RayHit f(World& w) { return w.cast_ray({}, {0, -1, 0}); }",
     "RayHit f(World& w) { return w.cast_ray({}, {{}, -1_m, {}}); }", BARE),
    ("Status f(World& w) { return w.apply(ApplyImpulse{{}, {1, 0, 0}}); }",
     "Status f(World& w) { return w.apply(ApplyImpulse{{}, {1_Ns, {}, {}}}); }", BARE),
    ("Length l = Length::from_integer(1.5);", "Length l = Length::from_ratio(3, 2);",
     "deleted|from_integer"),
    ("Length l = Length::from_ratio(1.5, 2);", "Length l = Length::from_ratio(3, 4);",
     "deleted|from_ratio"),
    ("constexpr Length l = Length::from_integer(5000);",
     "constexpr Position l = Position::from_integer(5000);", "misused|out of range"),
    ("constexpr Length l = Length::from_ratio(1, 0);",
     "constexpr Length l = Length::from_ratio(1, 2);", "misused|denominator"),
    ("constexpr Length l = Length::from_ratio(5000, 1);",
     "constexpr Length l = Length::from_ratio(5000, 4);", "misused|out of range"),
    ("constexpr Length l = Length::from_integer(1) / 0;",
     "constexpr Length l = Length::from_integer(1) / 2;", "misused|divided by 0"),
    ("Length l = 5000_m;", "Position l = 5000_m;", "conver"),
    ("Length f(bool b) { return b ? 1_m : 5000_m; }",
     "Position f(bool b) { return b ? 1_m : 5000_m; }", "conver"),
    ("Length l = 1_mps;", "Velocity l = 1_mps;", "conver"),
    ("auto f(int i) { return 2_m * i; }", "auto f(int i) { return Length(2_m) * i; }", "deleted"),
    ("auto x = 1e3_m;", "auto x = 1000_m;", "decimal literal"),
    ("Length f(Position p) { return p; }", "Length f(Position p) { return saturated<Length>(p); }",
     "conver"),
    ("auto f(Position p, Velocity v) { return p + v; }",
     "auto f(Position p, Length v) { return p + v; }", "operator"),
    ("auto f(Unit a) { return to_decimal(a * a); }",
     "auto f(Unit a) { return to_decimal(a); }", "exact product"),
    ("Length f(Length l) { return sqrt(l); }", "Number f(Number x) { return sqrt(x); }", "sqrt"),
    ("Unit f() { return sin(2_m); }", "Unit f() { return sin(2_rad); }", "sin|conver"),
    ("Random f() { return 5; }", "Random f() { return Random(5); }", "conver"),
    ("Length f(Random& r) { return r.between(1_m, 2_m); }",
     "Length f(Random& r) { return r.between<Length>(1_m, 2_m); }", "between"),
    ("auto f(Random& r) { return r.fraction<Length>(); }",
     "auto f(Random& r) { return r.fraction<Number>(); }", "fraction"),
]


HERE = re.compile(r"^wrong:(\d+):")


def compile_code(compiler, include, code):
    """The compiler's messages; empty when the code compiles."""
    front = (WORLD if NEEDS_WORLD.search(code) else "") + (GAME if NEEDS_GAME.search(code) else "") + FRONT
    done = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-I", include, "-x", "c++", "-"],
                          input=front + code, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"})
    return "" if done.returncode == 0 else done.stderr or "failed"


def in_namespaces(lines):
    return "".join(f"namespace n{i} {{ {line} }}\n" for i, line in enumerate(lines))


def compile_each(compiler, include, lines, messages):
    """The messages for each line, from one translation unit where its own error is found there; a line without
    one is compiled by itself."""
    text = compile_code(compiler, include, '#line 1 "wrong"\n' + in_namespaces(lines))
    if not text:
        return [""] * len(lines)
    found = [""] * len(lines)
    for report in text.splitlines():
        place = HERE.match(report)
        if place and " error: " in report:
            found[int(place[1]) - 1] += report + "\n"
    return [own if re.search(message, own) else compile_code(compiler, include, line)
            for line, own, message in zip(lines, found, messages)]


def main():
    compiler, include = sys.argv[1:3]
    rights, messages = [right for _, right, _ in PAIRS], [message for _, _, message in PAIRS]
    faults = []
    text = compile_code(compiler, include, in_namespaces(rights))
    if text:
        faults.append("correct code does not compile:\n" + text)
    wrongs = rights if "--control" in sys.argv else [wrong for wrong, _, _ in PAIRS]
    for wrong, message, text in zip(wrongs, messages, compile_each(compiler, include, wrongs, messages)):
        if not text:
            faults.append("compiles: " + wrong)
        elif not re.search(message, text):
            faults.append(f"{wrong}\n  is refused without a word of {message}:\n{text}")
    if "--control" in sys.argv:
        sys.exit(0 if len(faults) == len(PAIRS) else f"the control found {len(faults)} faults only")
    if faults:
        sys.exit("\n".join(faults))


main()
