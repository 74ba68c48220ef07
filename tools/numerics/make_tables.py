"""Prints core/math/exponential_tables.h, from exact integers: Newton's root for 2^(1/128), and the
series of the inverse hyperbolic tangent for logarithms (Abramowitz and Stegun, 4.1.29).

usage: make_tables.py [--check FILE]
"""

import argparse
import math
import pathlib
import sys

GUARD = 256  # fraction bits of every intermediate value
ENTRIES = 128

HEAD = """\
// Written by tools/numerics/make_tables.py; a test compares.
// Definitions: docs/explanation/numerics.md.
#pragma once

#include <array>
#include <cstdint>

namespace lockstone::exponential_detail {
"""


def natural_log(numerator, denominator):
    """ln(numerator/denominator) for a quotient in [½, 2], GUARD fraction bits."""
    u = ((numerator - denominator) << GUARD) // (numerator + denominator)
    square, total, n = (u * u) >> GUARD, 0, 1
    while u:
        total += u // n
        u = (u * square) >> GUARD
        n += 2
        if u == -1:
            break
    return 2 * total


def rounded(value, fraction_bits):
    shift = GUARD - fraction_bits
    return (value + (1 << (shift - 1))) >> shift


def powers():
    """⌊2^63 · 2^(i/128)⌉"""
    root = 1 << (GUARD + 1)
    for _ in range(7):
        root = math.isqrt(root << GUARD)
    value, table = 1 << GUARD, []
    for _ in range(ENTRIES):
        table.append(rounded(value, 63))
        value = (value * root) >> GUARD
    return table


def reciprocals():
    """⌊2^20 / (2i + 257)⌉"""
    return [(2 ** 21 + 2 * i + 257) // (2 * (2 * i + 257)) for i in range(ENTRIES)]


def logarithms():
    """⌊2^62 · −log2(c_i / 2^12)⌉"""
    ln2 = natural_log(2, 1)
    return [rounded((natural_log(4096, c) << GUARD) // ln2, 62) for c in reciprocals()]


def array_text(comment, name, values, per_line, digits):
    rows = [", ".join(f"0x{v:0{digits}x}" for v in values[i:i + per_line])
            for i in range(0, len(values), per_line)]
    kind = "std::uint64_t" if digits > 4 else "std::uint16_t"
    body = "".join(f"    {row},\n" for row in rows)
    return f"/// {comment}\ninline constexpr std::array<{kind}, {len(values)}> {name} = {{\n{body}}};\n"


def header():
    ln2 = natural_log(2, 1)
    inverse = rounded((1 << (2 * GUARD)) // ln2, 62)
    return "\n".join([
        HEAD,
        "/// ⌊2^64 · ln 2⌉ and ⌊2^62 / ln 2⌉.\n"
        f"inline constexpr std::uint64_t k_ln2_q64 = 0x{rounded(ln2, 64):x};\n"
        f"inline constexpr std::int64_t k_inverse_ln2_q62 = 0x{inverse:x};\n",
        array_text("⌊2^63 · 2^(i/128)⌉.", "k_power_of_two", powers(), 4, 16),
        array_text("cᵢ = ⌊2^20 / (2i + 257)⌉: with 12 fraction bits 1/(1 + (i + ½)/128).",
                   "k_reciprocal", reciprocals(), 13, 3),
        array_text("⌊−2^62 · log2(cᵢ / 2^12)⌉.", "k_logarithm", logarithms(), 4, 16),
        "}  // namespace lockstone::exponential_detail\n"])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", type=pathlib.Path)
    arguments = parser.parse_args()
    if not arguments.check:
        sys.stdout.write(header())
        return 0
    same = arguments.check.read_text(encoding="utf-8") == header()
    print(f"{arguments.check}: {'equal' if same else 'differs from the tables'}")
    return 0 if same else 1


if __name__ == "__main__":
    sys.exit(main())
