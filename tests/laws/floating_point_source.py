"""Law 1 in the source: core, net and replay name no floating-point type, literal or function."""

import re

from cpp_source import Tree, code_only, expect_only, matching_lines, run_law

FOLDERS = ["core", "net", "replay"]
# Conversions to and from double, for tools and tests only.
EXEMPT = "core/include/lockstone/testing/floating.h"

BANNED = {
    "type": r"\b(?:float|double|float_t|double_t|_Float\d+x?|__float\d+|__fp16|__bf16)\b",
    # A literal with a suffix of ours (1.5_m) is read by a consteval operator from its characters;
    # an operator that took a long double would be found by its type.
    "literal": r"(?<![\w.])(?:(?:\d[\d']*)?\.\d[\d']*(?:[eE][+-]?\d+)?|\d[\d']*\.(?:[eE][+-]?\d+)?"
               r"|\d[\d']*[eE][+-]?\d+|0[xX][\da-fA-F'.]+[pP][+-]?\d+)[fFlL]?(?![\w.])",
    "header": r"#\s*include\s*<(?:cmath|math\.h|cfloat|float\.h|cfenv|fenv\.h|complex|numbers|random"
              r"|valarray)>",
    "function": r"\b(?:strto[fd]|strtold|ato[f]|sto[fd]|stold)\b"
                r"|\bstd::(?:sqrt|cbrt|hypot|pow|exp2?|log(?:2|10)?|sin|cos|tan|asin|acos|atan2?|floor"
                r"|ceil|round|trunc|l?lround|l?lrint|nearbyint|fmod|fma|lerp)\b",
}
PATTERNS = {name: re.compile(pattern) for name, pattern in BANNED.items()}


def check(tree):
    findings = []
    for path, text in tree.items():
        if path.as_posix() == EXEMPT:
            continue
        code = code_only(text)
        for name, pattern in PATTERNS.items():
            findings += [f"{path}:{line}: floating-point {name}: {match}"
                         for line, match in matching_lines(pattern, code)]
    return findings


def control():
    def found(line, path="core/a.cpp"):
        return check(Tree({path: f"int a;\n{line}\n"}))

    expect_only(found("float x;"), "core/a.cpp:2: floating-point type: float")
    expect_only(found("long double x;"), "double")
    expect_only(found("auto x = 1.5;"), "literal: 1.5")
    expect_only(found("auto x = .5f;"), "literal")
    expect_only(found("auto x = 1'000.;"), "literal")
    expect_only(found("auto x = 1e9;"), "literal: 1e9")
    expect_only(found("auto x = 0x1p3;"), "literal")
    expect_only(found("#include <cmath>"), "header")
    expect_only(found("auto x = std::sqrt(4);"), "function: std::sqrt")
    expect_only(found("auto x = strtod(text, nullptr);"), "function: strtod")
    expect_only(found("auto s = R\"(a\nb)\"; double x;"), "core/a.cpp:3")
    # Must pass: comments, strings, separators, our own literals, other names, the exception.
    for line in ('// float\n', '/* double\n float */', '"float \\" double"', "auto c = '\"'; int floating;",
                 "auto x = 1'000'000 + 0xfe1 + 2u;", "auto x = 1.5_m + 1e3_kg;", "a.e1 = b.x;",
                 'auto s = R"x(double " )" float)x";', 'to_string(1); "1.5";'):
        expect_only(found(line))
    expect_only(found("double x;", EXEMPT))


if __name__ == "__main__":
    run_law(check, control, FOLDERS)
