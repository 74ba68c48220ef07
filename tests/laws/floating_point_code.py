"""Law 1 in the machine code: the libraries contain no floating-point instruction.

usage: floating_point_code.py LIBRARY… [--objdump PROGRAM] [--nm PROGRAM]
       floating_point_code.py --control COMPILER

Banned are instructions that compute with, compare or convert floating-point numbers: their result
could depend on a rounding mode, on contraction or on the compiler. Allowed are the instructions that
compilers and vector code use for integers in the same registers: moves (movaps, movups, movss, movsd, movhlps), shuffles (shufps,
unpcklps, blendps, insertps, permilps), and bitwise logic (andps, orps, xorps).
"""

import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile

# An operand type: scalar or packed; single, double or half. Integer instructions of like names have
# a p before the verb (paddd, pmaxsd, pcmpeqd), so the verbs are matched from the start.
_TYPE = r"(?:[sp][sdh])"
X86 = re.compile(
    r"v?(?:"
    rf"(?:add|sub|mul|div|min|max|sqrt|rcp|rsqrt|round|addsub|hadd|hsub|dp){_TYPE}"
    rf"|u?comi{_TYPE}|cmp[a-z_]*{_TYPE}"
    r"|cvt\w+"                                              # any conversion: cvtsi2sd, vcvttps2dq
    rf"|4?fn?m(?:add|sub)\w*"                               # fused multiply-add, FMA3 and FMA4
    rf"|f?c?(?:mul|madd)c[sp]h"                             # complex half precision
    rf"|(?:getexp|getmant|fixupimm|range|reduce|rndscale|scalef|fpclass|frcz){_TYPE}"
    rf"|(?:rcp|rsqrt|exp2)(?:14|28|2)?{_TYPE}"
    r"|dpbf16ps|dpphps"
    r")"
    r"|f\w+"                                                # x87, even its moves: for long double only
    r"|pf\w+|pi2f\w+")                                      # 3DNow!
# All that AArch64 computes in floating point begins with f; fmov, a plain move, is used for integers.
AARCH64 = re.compile(r"(?!fmov\b)f[a-z0-9]+|[su]cvtf|bf\w*(?:dot|mmla|mlal[bt])|bfcvt\w*")
BANNED = {"elf64-x86-64": X86, "elf64-littleaarch64": AARCH64}

# Routines of the compiler and of the C library that compute in floating point on our behalf.
_SYMBOL = re.compile(
    r"__(?:add|sub|mul|div|neg|fix|float|extend|trunc|pow|cmp|unord|eq|ne|lt|le|gt|ge)"
    r"\w*[hsdxtb]f(?:[hsdxt][fi]|bf)?\d?"
    r"|(?:sqrt|cbrt|hypot|pow|exp2?|log(?:2|10)?|a?sin|a?cos|a?tan|atan2|fmod|fma|floor|ceil|l?l?round"
    r"|trunc|nearbyint|l?l?rint|ldexp|frexp|strtod|strtof|strtold|atof)[fl]?")
_PREFIXES = {"lock", "rep", "repz", "repnz", "bnd", "notrack", "data16", "addr32", "cs", "ds", "es",
             "fs", "gs", "ss"}


def output_of(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True).stdout


def mnemonic(instruction):
    """The first word that is no prefix."""
    for word in instruction.split():
        if word not in _PREFIXES and not word.startswith(("rex", "{")):
            return word
    return ""


def scan_listing(listing):
    """(number of instructions, [findings]) of objdump's output for an archive."""
    banned, counted, where = None, 0, "?"
    found = collections.Counter()
    for line in listing.splitlines():
        if "file format" in line:
            member, _, form = line.partition(":")
            banned = BANNED.get(form.split()[-1])
            if banned is None:
                return 0, [f"{member}: no list of floating-point instructions for{form.split()[-1]}"]
        elif line.endswith(">:"):
            where = line[line.index("<") + 1:-2]
        elif line.startswith(" ") and "\t" in line:
            name = mnemonic(line.split("\t", 1)[1])
            counted += 1
            if name and banned.fullmatch(name):
                found[where, name] += 1
    return counted, [f"{function}: {times} × {name}" for (function, name), times in found.items()]


def scan(library, objdump="objdump", nm="nm"):
    """(number of instructions, [findings]) of an archive or object file."""
    counted, findings = scan_listing(output_of(objdump, "-d", "--no-show-raw-insn", "-C", library))
    symbols = {line.split()[-1].partition("@")[0] for line in output_of(nm, "-u", library).splitlines()
               if line.split()[:1] == ["U"]}
    findings += [f"calls {name}" for name in sorted(symbols)
                 if _SYMBOL.fullmatch(name)]
    return counted, findings


CAUGHT = {
    "multiply": "double f(double a, double b) { return a * b; }",
    "add": "float f(float a, float b) { return a + b; }",
    "compare": "bool f(double a, double b) { return a < b; }",
    "from integer": "double f(long long a) { return a; }",
    "to integer": "long long f(float a) { return a; }",
    "widen": "double f(float a) { return a; }",
    "long double": "long double f(long double a) { return a + 1; }",
    "packed": "void f(float* a) { for (int i = 0; i < 1024; ++i) a[i] *= a[i]; }",
    "fused": "double f(double a, double b, double c) { return __builtin_fma(a, b, c); }",
    "library": "double f(double a) { return __builtin_pow(a, a); }",
    "quadruple": "__extension__ typedef __float128 q; q f(q a) { return a + a; }",
}
# Integer code that uses vector registers wherever a compiler can.
PASSES = """
#include <cstdint>
#include <cstring>
struct Body { std::int64_t x[3]; std::int32_t v[3]; std::int32_t flags; };
void copy(Body* to, const Body* from) { *to = *from; }
void clear(Body* body) { *body = Body{}; }
void step(Body* body, int count) {
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < 3; ++k) body[i].x[k] += (std::int64_t{body[i].v[k]} * 1234567) >> 20;
}
std::int32_t greatest(const std::int32_t* a) {
  std::int32_t best = a[0];
  for (int i = 1; i < 4096; ++i) best = a[i] > best ? a[i] : best;
  return best;
}
std::int64_t divide(std::int64_t a, std::int64_t b) { return a / b; }
"""


def control(compiler):
    """Each of CAUGHT is found at every level, PASSES at none."""
    on_x86 = "x86_64" in output_of(compiler, "-dumpmachine")
    levels = [["-O0"], ["-O2"], ["-O3"]] + ([["-O3", "-mavx2", "-mfma"], ["-O3", "-mavx512f"]] if on_x86 else [])
    with tempfile.TemporaryDirectory() as folder:
        source, compiled = pathlib.Path(folder, "a.cpp"), pathlib.Path(folder, "a.o")

        def scan_text(text, flags):
            source.write_text(text)
            subprocess.run([compiler, "-std=c++20", "-w", *flags, "-c", source, "-o", compiled], check=True)
            return scan(compiled)

        for flags in levels:
            for name, text in CAUGHT.items():
                if not scan_text(text, flags)[1]:
                    sys.exit(f"control failed: {name} with {flags} is not caught")
            counted, findings = scan_text(PASSES, flags)
            if not counted or findings:
                sys.exit(f"control failed: integer code with {flags} gives {counted}, {findings}")
    print("the control is caught")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("libraries", nargs="*")
    parser.add_argument("--objdump", default="objdump")
    parser.add_argument("--nm", default="nm")
    parser.add_argument("--control", metavar="COMPILER")
    arguments = parser.parse_args()
    if arguments.control:
        control(arguments.control)
        return
    failed = not arguments.libraries
    for library in arguments.libraries:
        counted, findings = scan(library, arguments.objdump, arguments.nm)
        print(f"{library}: {counted} instructions, {len(findings)} findings")
        print("".join(f"  {finding}\n" for finding in findings), end="")
        # Nothing to read (link-time optimisation leaves no machine code) is no proof.
        failed = failed or bool(findings) or counted == 0
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
