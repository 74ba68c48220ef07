"""A second implementation of docs/explanation/numerics.md in exact integers: recomputes every golden vector.

usage: numerics_reference.py FILE [--function NAME]
"""

import argparse
import math
import pathlib
import sys
from fractions import Fraction

import numerics_reference_game as game
import numerics_reference_shapes as shapes

M64 = (1 << 64) - 1
MAX64, MIN64 = (1 << 63) - 1, -(1 << 63)
MAX32, MIN32 = (1 << 31) - 1, -(1 << 31)


def signed(word):
    return word - (1 << 64) if word >> 63 else word


def rounded(x):
    """To nearest, ties away from zero, of a Fraction."""
    size = math.floor(abs(x) + Fraction(1, 2))
    return -size if x < 0 else size


def ratio(n, d):
    return rounded(Fraction(n, d))


def shifted(x, s):
    """⌊x / 2^s⌉, s of either sign and any size."""
    if s <= 0:
        return x << -s
    size = abs(x)
    return with_sign((size + (1 << (s - 1))) >> s, x < 0) if s <= length_of(size) else 0


def bounded(x, low, high):
    return max(low, min(high, x))


def hi(a, b):
    return (a * b) >> 64


def length_of(x):
    return x.bit_length()


def sign(x):
    return (x > 0) - (x < 0)


def with_sign(size, negative):
    return -size if negative else size


# Roots

def nearest_root(n):
    root = math.isqrt(n)
    return root + (n - root * root > root)


TABLE = [math.isqrt((1 << 39) // (2 * i + 129)) for i in range(192)]


def reciprocal_sqrt(s):
    y0 = TABLE[(s >> 56) - 64]
    e0 = (1 << 62) - y0 * y0 * ((s >> 32) + 1)
    y1 = (y0 << 16) + ((y0 * (e0 >> 14)) >> 33)
    e1 = (1 << 62) - hi(s, y1 * y1)
    q = ((e1 >> 16) ** 2) >> 32
    f = (e1 >> 1) + ((3 * q) >> 1)
    return (y1 << 31) + ((y1 * (f >> 16)) >> 15)


def rsqrt(d, k):
    # r = ⌊√(2^k/d)⌉ by (2r − 1)² < 2^(k + 2)/d ≤ (2r + 1)²
    return min((math.isqrt((1 << (k + 2)) // d) + 1) // 2, 1 << 31)


def unit_vector(parts):
    sizes = [abs(a) for a in parts]
    together = 0
    for size in sizes:
        together |= size
    if together == 0:
        return [0] * len(parts)
    square = sum(a * a for a in sizes)
    k = (128 - length_of(square)) & ~1
    r = reciprocal_sqrt((square << k) >> 64)
    left = 64 - length_of(together)
    m = left + 126 - k // 2 - 94
    return [with_sign((hi(size << left, r) + (1 << (m - 1))) >> m, a < 0)
            for a, size in zip(parts, sizes)]


def norm_squared(q):
    return min(sum(a * a for a in q), M64)


def is_near_unit(square):
    return abs(square - (1 << 60)) <= 1 << 40


def correction(square):
    return shifted((1 << 60) - square, 10)


def normalized(q):
    square = norm_squared(q)
    if is_near_unit(square):
        c = correction(square)
        return [a + shifted(a * c, 51) for a in q]
    return unit_vector(q) if any(q) else [0, 0, 0, 1 << 30]


# Sines

F = [ratio(1 << 32, math.factorial(n)) for n in range(13)]


def q32(a, b):
    return (a * b) >> 32


def chain(z, *coefficients):
    total = F[coefficients[-1]]
    for n in reversed(coefficients[:-1]):
        total = F[n] - q32(z, total)
    return total


def first_octant(r):
    t = (r + (1 << 27)) >> 28
    z2 = t * t
    z = z2 >> 32
    sin = r - ((q32(z, chain(z, 3, 5, 7, 9, 11)) * t) >> 4)
    cos = (1 << 60) - (z2 >> 5) + ((q32(z, z) * chain(z, 4, 6, 8, 10, 12)) >> 4)
    return sin, cos


def wide_sin_cos(a):
    turns = ((a * 0x145f306dc9c882a53f84eafa) & ((1 << 128) - 1)) >> 64
    q = (turns + (1 << 61)) >> 62
    d = turns - (q << 62)
    sin, cos = first_octant(hi(abs(d), 0x6487ed5110b4611a))
    sin = with_sign(sin, d < 0)
    return [(sin, cos), (cos, -sin), (-sin, -cos), (-cos, sin)][q % 4]


def sin_cos(x):
    sin, cos = wide_sin_cos(abs(x) << 6)
    return [with_sign(shifted(sin, 30), x < 0), shifted(cos, 30)]


G = [0, 0, 1 << 63] + [(1 << 64) // math.factorial(n) for n in range(3, 20)]


def long_chain(z, *coefficients):
    total = G[coefficients[-1]]
    for n in reversed(coefficients[:-1]):
        total = G[n] - hi(z, total)
    return total


def tan(x, n):
    u = ((abs(x) * 0xa2f9836e4e441529fc2757d1f) & ((1 << 128) - 1)) >> 64
    q = 0 if u < 1 << 62 or u >= 3 << 62 else 1
    d = signed((u - (q << 63)) & M64)
    r = hi(2 * abs(d), 0xc90fdaa22168c235)
    z = hi(2 * r, 2 * r)
    sin = r - hi(hi(z, r), long_chain(z, *range(3, 20, 2)))
    cos = (1 << 63) - (z >> 2) + (hi(hi(z, z), long_chain(z, *range(4, 19, 2))) >> 1)
    top, bottom = (cos, sin) if q else (sin, cos)
    size = MAX32 if top << n >= bottom << 31 else min(ratio(top << n, bottom), MAX32)
    return with_sign(size, (x < 0) ^ (d < 0) ^ (q == 1))


# Arc tangents

def arc_table():
    """⌊2^40 · atan(i/32)⌉ by the alternating series after halving the angle's tangent twice."""
    bits, table = 200, []
    for i in range(33):
        t = (i << bits) // 32
        for _ in range(3):  # tan(α/2) = t / (1 + √(1 + t²))
            t = (t << bits) // ((1 << bits) + math.isqrt((1 << (2 * bits)) + t * t))
        square, total, n = (t * t) >> bits, 0, 0
        while t:
            total += with_sign(t // (2 * n + 1), n % 2 == 1)
            t = (t * square) >> bits
            n += 1
        table.append(shifted(total, bits - 40 - 3))
    return table


ARC = arc_table()
HALF_PI = 0x1921fb54443


def arc_tangent(a, b):
    shift = 57 - length_of(b)
    a, b = (a << shift, b << shift) if shift >= 0 else (a >> -shift, b >> -shift)
    i = (32 * (a >> 32) + (b >> 32) // 2) // (b >> 32)
    d = ratio((32 * a - i * b) << 40, 32 * b + i * a)
    w = ((d >> 6) ** 2) >> 28
    g = w // 3 - (((w >> 8) ** 2) >> 24) // 5
    return ARC[i] + d - shifted(d * g, 40)


def atan2(y, x):
    if x == 0 and y == 0:
        return 0
    angle = (arc_tangent(abs(y), abs(x)) if abs(y) <= abs(x)
             else HALF_PI - arc_tangent(abs(x), abs(y)))
    if x < 0:
        angle = 2 * HALF_PI - angle
    return with_sign(shifted(angle, 13), y < 0)


def complement(x):
    x = bounded(x, -(1 << 30), 1 << 30)
    return x, nearest_root((1 << 60) - x * x)


# Rotations

def rotation_about(axis, sin, cos):
    return [shifted(u * shifted(sin, 29), 29) for u in axis] + [shifted(cos, 28)]


def wide_rotation(theta):
    square = sum(t * t for t in theta)
    if all(abs(t) < 1 << 31 for t in theta) and square <= 1 << 62:
        z = square >> 34
        k = (1 << 31) - (q32(z, chain(z, 3, 5, 7)) >> 1)
        w = (1 << 60) - (square >> 7) + ((q32(z, z) * chain(z, 4, 6, 8)) >> 4)
        return [shifted(t * k, 32) for t in theta] + [shifted(w, 28)]
    return rotation_about(unit_vector(theta), *wide_sin_cos(nearest_root(square)))


def rotation_from_vector(theta):
    return [shifted(c, 2) for c in wide_rotation(theta)]


def from_axis_angle(axis, x):
    sin, cos = wide_sin_cos(abs(x) << 5)
    return [shifted(c, 2) for c in rotation_about(axis, with_sign(sin, x < 0), cos)]


def integrate(q, theta):
    if not any(theta):
        return q
    q = q if is_near_unit(norm_squared(q)) else normalized(q)
    c = correction(norm_squared(q))
    product = shapes.quaternion_product(wide_rotation(theta), q)
    return [shifted(p + shifted(shifted(p, 32) * c, 19), 32) for p in product]


# Powers and logarithms, with the tables by their definitions

def log2_fraction(x, bits):
    """log2 of a Fraction in [1, 2), `bits` fraction bits, by squaring (good to bits − 4)."""
    guard = 2 * bits + 16
    m, result = (x.numerator << guard) // x.denominator, 0
    for _ in range(bits):
        m = (m * m) >> guard
        result <<= 1
        if m >> (guard + 1):
            m >>= 1
            result += 1
    return result


def power_table():
    return [nearest_root_of_power(i) for i in range(128)]


def nearest_root_of_power(i):
    """⌊2^63 · 2^(i/128)⌉ as the integer r with (2r − 1)^128 < 2^(128·64 + i) < (2r + 1)^128."""
    low, high = 1 << 63, 1 << 64
    target = 1 << (128 * 64 + i)
    while low < high:
        middle = (low + high) // 2
        low, high = (low, middle) if (2 * middle + 1) ** 128 > target else (middle + 1, high)
    return low


POWER = power_table()
RECIPROCAL = [ratio(1 << 20, 2 * i + 257) for i in range(128)]
LOGARITHM = [shifted(log2_fraction(Fraction(4096, c), 100), 38) for c in RECIPROCAL]


def exp2(x, f, n):
    w = x >> f
    if w + n >= 31:
        return 1 << 31
    fraction = ((x - (w << f)) << 64) >> f
    h = hi((fraction << 7) & M64, 0xb17217f7d1cf79ac)
    p = G[7]
    for k in (6, 5, 4, 3, 2):
        p = G[k] + (hi(h, p) >> 7)
    e = h + (hi(h, hi(h, p)) >> 7)
    start = POWER[fraction >> 57]
    return shifted(start + (hi(start, e) >> 7), 63 - w - n)


def log2(x, f, n):
    z = 64 - length_of(x)
    m, w = x << z, 63 - z - f
    i = (m >> 56) & 127
    t = (m * RECIPROCAL[i] - (1 << 75)) >> 5
    p = (1 << 62) // 7
    for k in (6, 5, 4, 3, 2, 1):
        p = (1 << 62) // k - ((t * p) >> 70)
    v = (((t * p) >> 62) * 0x5c551d94ae0bf85e) >> 64
    return (w << n) + shifted(LOGARITHM[i] + (v >> 6), 62 - n)


# Quotients, decimals, block floats

def divide(a, b, s):
    if b == 0:
        return 0 if a == 0 else MAX64 if a > 0 else MIN64
    return bounded(rounded(Fraction(a, b) * Fraction(2) ** s), MIN64, MAX64)


def scale_decimal(negative, whole, fraction, digits, n):
    value = rounded((whole + Fraction(fraction, 10 ** digits)) * (1 << n))
    value = with_sign(value, negative)
    return [0, value] if MIN64 <= value <= MAX64 else [1, 0]


def format_decimal(raw, n):
    for digits in range(15):
        scaled = rounded(Fraction(abs(raw) * 10 ** digits, 1 << n))
        whole, fraction = divmod(scaled, 10 ** digits)
        back = scale_decimal(raw < 0, whole, fraction, digits, n)
        if back == [0, raw]:
            break
    return [int(raw < 0), whole, fraction, digits]


def block_float(v, e):
    if v == 0:
        return [0, 0]
    excess = length_of(v) - 31
    mantissa = shifted(v, excess)
    carry = mantissa >> 31
    return [mantissa >> carry, e + excess + carry]


def inverse_of(x):
    if x == 0:
        return [0, 0]
    z = 64 - length_of(x)
    return block_float(ratio(1 << 94, x << z), z - 62)


def block_value(m, e):
    return m * Fraction(2) ** e


def block_share(ma, ea, mb, eb):
    if ma == 0:
        return 0
    a, b = block_value(ma, ea), block_value(mb, eb)
    return rounded((1 << 30) * a / (a + b))


def block_add(ma, ea, mb, eb):
    total = block_value(ma, ea) + block_value(mb, eb)
    return block_float(int(total * (1 << 60)), -60)


def scale_saturating(raw, m, e, s):
    return bounded(rounded(raw * block_value(m, e + s)), MIN64, MAX64)


def wide_words(x):
    return [signed((x >> 64) & M64), signed(x & M64)]


def root_length(parts, high):
    return min(nearest_root(sum(a * a for a in parts)), high)


def u(word):
    return word & M64


FUNCTIONS = {
    "round_shift": shifted,
    "round_shift_any": shifted,
    "round_divide": ratio,
    "multiply_shift": lambda a, b, s: shifted(a * b, s),
    "saturating_add": lambda a, b: bounded(a + b, MIN64, MAX64),
    "multiply_wide": lambda a, b: wide_words(u(a) * u(b)),
    "divide_wide": lambda h, l, d: [signed(x) for x in divmod((u(h) << 64) + u(l), u(d))],
    "round_shift_wide": lambda h, l, s: wide_words(shifted((h << 64) + u(l), s)),
    "scale_decimal": scale_decimal,
    "format_decimal": format_decimal,
    "divide": divide,
    "exp2": exp2,
    "log2": log2,
    "block_float": lambda v, e: block_float(u(v), e),
    "inverse_of": inverse_of,
    "scale_saturating": scale_saturating,
    "ratio": block_share,
    "block_add": block_add,
    "reciprocal_sqrt": lambda s: signed(reciprocal_sqrt(u(s))),
    "isqrt": lambda n: math.isqrt(u(n)),
    "isqrt_rounded": lambda n: nearest_root(u(n)),
    "isqrt128": lambda h, l: signed(math.isqrt((u(h) << 64) + u(l))),
    "isqrt128_rounded": lambda h, l: signed(nearest_root((u(h) << 64) + u(l))),
    "norm": lambda *v: signed(root_length(v, M64)),
    "length": lambda *v: root_length(v, MAX32),
    "direction_of": lambda *v: unit_vector(v),
    "normalized": lambda *q: normalized(q),
    "sqrt_q20": lambda x: nearest_root(x << 20),
    "sqrt_q30": lambda x: nearest_root(x << 30),
    "rsqrt": rsqrt,
    "hypot": lambda *v: root_length(v, MAX32),
    "hypot_wide": lambda *v: root_length(v, MAX64),
    "sin_cos": sin_cos,
    "tan": tan,
    "atan2": atan2,
    "atan2_near": atan2,
    "asin": lambda x: atan2(*complement(x)),
    "acos": lambda x: atan2(*reversed(complement(x))),
    "rotation_from_vector": lambda *v: rotation_from_vector(v),
    "rotation_from_vector_far": lambda *v: rotation_from_vector(v),
    "from_axis_angle": lambda x, y, z, a: from_axis_angle([x, y, z], a),
    "integrate": lambda *v: integrate(list(v[:4]), v[4:]),
    **shapes.functions(shifted, rounded, normalized),
    **game.functions(sys.modules[__name__]),
}


def recomputed(line):
    """The line as this implementation writes it, or None when it cannot be read."""
    try:
        left = line.split(" =")[0]
        name, *words = left.split(" ")
        result = FUNCTIONS[name](*map(int, words))
    except (KeyError, ValueError, TypeError):
        return None
    words = result if isinstance(result, (list, tuple)) else [result]
    return f"{left} = " + " ".join(str(int(word)) for word in words)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("file", type=pathlib.Path)
    parser.add_argument("--function", help="only this one")
    arguments = parser.parse_args()
    count, seen, wrong = 0, set(), []
    for number, line in enumerate(arguments.file.read_text(encoding="utf-8").splitlines(), 1):
        name = line.split(" ")[0]
        if not line or line[0] == "#" or (arguments.function and name != arguments.function):
            continue
        count += 1
        seen.add(name)
        here = recomputed(line)
        if here != line:
            wrong.append(f"line {number}\n  file {line}\n  here {here}")
    print("\n".join(wrong[:10]))
    print(f"{count} vectors of {len(seen)} functions, {len(wrong)} different")
    missing = [] if arguments.function else sorted(set(FUNCTIONS) - seen)
    if missing:
        print("without a vector:", ", ".join(missing))
    return 1 if wrong or missing or not count else 0


if __name__ == "__main__":
    sys.exit(main())
