"""The part of numerics_reference.py about matrices, transforms and predicates. The contacts of
segments are found by clipping in rationals, not by orientations."""

from fractions import Fraction

MAX64 = (1 << 63) - 1


def sign(x):
    return (x > 0) - (x < 0)


def minus(a, b):
    return [x - y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def quaternion_product(a, b):
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return [aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz]


def thirds(words):
    return [words[i:i + 3] for i in range(0, len(words), 3)]


def full(s):
    xx, yy, zz, xy, xz, yz = s
    return [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]


def six(m):
    return [m[0][0], m[1][1], m[2][2], m[0][1], m[0][2], m[1][2]]


def adjugate(m):
    return [cross(m[1], m[2]), cross(m[2], m[0]), cross(m[0], m[1])]


def determinant(m):
    return dot(m[0], cross(m[1], m[2]))


# Contacts

class Interval:
    """The s in [0, 1] for which linear functions of s are not negative."""

    def __init__(self):
        self.low, self.high = Fraction(0), Fraction(1)

    def keep(self, start, end):
        """f(0) = start, f(1) = end."""
        slope = end - start
        if slope == 0:
            if start < 0:
                self.high = Fraction(-1)
            return
        root = Fraction(-start, slope)
        if slope > 0:
            self.low = max(self.low, root)
        else:
            self.high = min(self.high, root)

    def keep_zero(self, start, end):
        self.keep(start, end)
        self.keep(-start, -end)


NONE, TOUCH, CROSS, OVERLAP = range(4)


def segment_segment(a, b, c, d):
    if c == d:
        a, b, c, d = c, d, a, b
    if c == d:
        return TOUCH if a == c else NONE
    v = minus(d, c)
    common = Interval()
    for start, end in zip(cross(minus(a, c), v), cross(minus(b, c), v)):
        common.keep_zero(start, end)
    along = [dot(v, minus(a, c)), dot(v, minus(b, c))]
    length = dot(v, v)
    common.keep(*along)
    common.keep(length - along[0], length - along[1])
    if common.low > common.high:
        return NONE
    if a == b:
        return TOUCH
    if common.low < common.high:
        return OVERLAP
    at = along[0] + common.low * (along[1] - along[0])
    return TOUCH if common.low in (0, 1) or at in (0, length) else CROSS


def segment_triangle(p, q, a, b, c):
    normal = cross(minus(b, a), minus(c, a))
    if not any(normal):
        contacts = [segment_segment(p, q, *edge) for edge in ((a, b), (b, c), (c, a))]
        return min(max(contacts), TOUCH) if OVERLAP not in contacts else OVERLAP
    heights = [dot(normal, minus(p, a)), dot(normal, minus(q, a))]
    edges = [(cross(normal, minus(end, start)), start)
             for start, end in ((a, b), (b, c), (c, a))]
    values = [[dot(n, minus(p, o)), dot(n, minus(q, o))] for n, o in edges]
    common = Interval()
    common.keep_zero(*heights)
    for value in values:
        common.keep(*value)
    if common.low > common.high:
        return NONE
    if p == q:
        return TOUCH
    if common.low < common.high:
        return OVERLAP
    on_edge = any(v[0] + common.low * (v[1] - v[0]) == 0 for v in values)
    return TOUCH if on_edge or heights == [0, 0] or common.low in (0, 1) else CROSS


def point_in_triangle(a, b, c, p):
    normal = cross(minus(b, a), minus(c, a))
    if not any(normal):
        return 0 if segment_triangle(p, p, a, b, c) != NONE else -1
    if dot(normal, minus(p, a)) != 0:
        return -1
    return min(sign(dot(cross(normal, minus(end, start)), minus(p, start)))
               for start, end in ((a, b), (b, c), (c, a)))


def orient3d(a, b, c, d):
    return sign(determinant([minus(b, a), minus(c, a), minus(d, a)]))


def side_of_circumsphere(a, b, c, d, e):
    m = [minus(b, a), minus(c, a), minus(d, a)]
    det = determinant(m)
    if det == 0:
        return 0
    # The centre, times 2·det, solves m·x = squares: by the adjugate.
    squares = [dot(row, row) for row in m]
    columns = adjugate(m)
    centre = [sum(columns[j][i] * squares[j] for j in range(3)) for i in range(3)]
    e = minus(e, a)
    return sign(det) * sign(dot(e, centre) - det * dot(e, e))


def functions(shifted, rounded, normalized):
    """The golden functions; the arguments are those of numerics_reference.py."""

    def to_matrix(q):
        x, y, z, w = q
        h = 1 << 59
        sums = [h - y * y - z * z, x * y + w * z, z * x - w * y,
                x * y - w * z, h - z * z - x * x, y * z + w * x,
                z * x + w * y, y * z - w * x, h - x * x - y * y]
        return [shifted(s, 29) for s in sums]

    def rotate(q, v, extra=0):
        columns = thirds(to_matrix(q))
        return [shifted(sum(columns[j][i] * v[j] for j in range(3)), 30 + extra) for i in range(3)]

    def rotate_inverse(q, v):
        return [shifted(dot(column, v), 30) for column in thirds(to_matrix(q))]

    def multiply(a, b):
        return [shifted(c, 30) for c in quaternion_product(a, b)]

    def plus(a, b):
        return [x + y for x, y in zip(a, b)]

    def sym_rotate(q, s):
        r, m = thirds(to_matrix(q)), full(s)  # r[j][i] is entry (i, j)
        return six([[shifted(sum(r[i][a] * m[i][j] * r[j][b] for i in range(3) for j in range(3)), 60)
                     for b in range(3)] for a in range(3)])

    def sym_inverse(s, f):
        m = full(s)
        a, d = adjugate(m), determinant(m)
        e = [(a[i][i].bit_length() + f - d.bit_length() + 2) >> 1 for i in range(3)]
        entries = [[rounded(Fraction(a[i][j], d) * Fraction(2) ** (f + 30 - e[i] - e[j]))
                    for j in range(3)] for i in range(3)]
        return six(entries) + e

    def sym_solve(s, b, shift):
        m = full(s)
        a, d = adjugate(m), determinant(m)
        exact = [rounded(Fraction(dot(row, b), d) * Fraction(2) ** shift) for row in a]
        return [max(-MAX64, min(MAX64, x)) for x in exact]

    def to_lattice(*v):
        return [shifted(p - o, v[6]) for p, o in zip(v[:3], v[3:6])]

    def on_points(function):
        return lambda *v: function(*thirds(list(v)))

    unsigned = lambda x: x & ((1 << 64) - 1)
    listed = {
        "quat_multiply": lambda *v: multiply(v[:4], v[4:]),
        "to_matrix": lambda *q: to_matrix(q),
        "rotate": lambda *v: rotate(v[:4], v[4:]),
        "rotate_inverse": lambda *v: rotate_inverse(v[:4], v[4:]),
        "sym_product": lambda *v: [dot(row, v[6:]) for row in full(v[:6])],
        "sym_rotate": lambda *v: sym_rotate(v[:4], v[4:]),
        "sym_inverse": lambda *v: sym_inverse(v[:6], v[6]),
        "sym_solve": lambda *v: sym_solve(v[:6], v[6:9], v[9]),
        "transform_apply": lambda *v: plus(v[:3], rotate(v[3:7], v[7:])),
        "transform_apply_length": lambda *v: plus(v[:3], rotate(v[3:7], v[7:], 20 - 32)),
        "transform_apply_inverse": lambda *v: rotate_inverse(v[3:7], minus(v[7:], v[:3])),
        "transform_compose": lambda *v: (plus(v[:3], rotate(v[3:7], v[7:10])) +
                                         normalized(multiply(v[3:7], v[10:]))),
        "transform_inverse": lambda *v: ([-c for c in rotate_inverse(v[3:], v[:3])] +
                                         [-v[3], -v[4], -v[5], v[6]]),
        "lattice_shift": lambda x: max(0, (unsigned(x) - 1).bit_length() - 19) if x else 0,
        "to_lattice": to_lattice,
        "side_of_plane": lambda *v: sign(dot(v[:3], v[4:]) - v[3]),
        "side_of_sphere": lambda *v: sign(v[3] ** 2 - sum((a - b) ** 2 for a, b in zip(v[:3], v[4:]))),
    }
    for function in (orient3d, side_of_circumsphere, point_in_triangle, segment_segment,
                     segment_triangle):
        listed[function.__name__] = listed[function.__name__ + "_few"] = on_points(function)
    return listed
