"""The part of numerics_reference.py about rotations between directions and orientations, and random
numbers. `base` is that module: its roots, sines and arcs."""

from numerics_reference_shapes import cross, dot, quaternion_product

M32, M64 = (1 << 32) - 1, (1 << 64) - 1
MAX32, MIN32 = (1 << 31) - 1, -(1 << 31)
ONE = 1 << 30


def negative(v):
    return [-a for a in v]


class Rotations:
    def __init__(self, base):
        self.base = base

    def norm(self, v):
        return self.base.nearest_root(dot(v, v))

    def unit(self, q60):
        return self.base.bounded(self.base.shifted(q60, 30), MIN32, MAX32)

    def perpendicular(self, u):
        least = min(range(3), key=lambda axis: abs(u[axis]))
        return self.base.unit_vector(cross([ONE if axis == least else 0 for axis in range(3)], u))

    def angle_between(self, v, w):
        a, b = self.base.unit_vector(v), self.base.unit_vector(w)
        return self.base.atan2(self.norm(cross(a, b)), dot(a, b))

    def from_directions(self, v, w):
        a, b = self.base.unit_vector(v), self.base.unit_vector(w)
        n, c = cross(a, b), dot(a, b)
        if c >= 0:
            return self.base.normalized([self.unit(x) for x in n] + [self.unit((1 << 60) + c)])
        axis = self.base.unit_vector(n) if any(n) else self.perpendicular(a)
        size = self.unit((1 << 60) - c)
        return self.base.normalized([self.base.shifted(x * size, 30) for x in axis] + [self.unit(self.norm(n))])

    def orientation_of(self, x, y, z):
        """The quaternion of three columns."""
        squares = [ONE + x[0] - y[1] - z[2], ONE - x[0] + y[1] - z[2], ONE - x[0] - y[1] + z[2],
                   ONE + x[0] + y[1] + z[2]]
        xy, yz, zx = x[1] + y[0], y[2] + z[1], z[0] + x[2]
        wx, wy, wz = y[2] - z[1], z[0] - x[2], x[1] - y[0]
        greatest = max((3, 0, 1, 2), key=lambda i: squares[i])  # the first of equals
        row = [[squares[0], xy, zx, wx], [xy, squares[1], yz, wy], [zx, yz, squares[2], wz],
               [wx, wy, wz, squares[3]]][greatest]
        root = self.base.nearest_root(squares[greatest] << 30)
        q = [self.base.ratio(entry << 29, root) for entry in row]
        return self.base.normalized(negative(q) if q[3] < 0 else q)

    def look_rotation(self, forward, up):
        z, u = self.base.unit_vector(forward), self.base.unit_vector(up)
        if not any(z):
            return [0, 0, 0, ONE]
        side = cross(u, z)
        x = self.base.unit_vector(side) if any(side) else self.perpendicular(z)
        return self.orientation_of(x, self.base.unit_vector(cross(z, x)), z)

    def arc(self, a, b):
        """±b, and the angle of the turn from a to it, Q32."""
        turn = quaternion_product(b, negative(a[:3]) + [a[3]])
        y, x = self.norm(turn[:3]), turn[3]
        angle = 0
        if y or x:
            small, great = min(y, abs(x)), max(y, abs(x))
            arc = self.base.arc_tangent(small, great)
            angle = arc if y <= abs(x) else self.base.HALF_PI - arc
        return (negative(b) if x < 0 else b), 2 * self.base.shifted(angle, 8)

    def along(self, a, b, whole, part):
        weights = [whole - part, part]
        if whole > 1 << 18:
            weights = [self.base.shifted(self.base.wide_sin_cos(w)[0], 29) for w in weights]
        return self.base.unit_vector([weights[0] * p + weights[1] * q for p, q in zip(a, b)])

    def slerp(self, a, b, t):
        if t <= 0 or t >= ONE:
            return a if t <= 0 else b
        end, whole = self.arc(a, b)
        part = self.base.shifted(whole * t, 30)
        if part in (0, whole):
            return a if part == 0 else b
        return self.along(a, end, whole, part)

    def rotate_toward(self, a, b, most):
        if most <= 0:
            return a
        end, whole = self.arc(a, b)
        return b if most * 32 >= whole else self.along(a, end, whole, most * 32)

    def angle_between_orientations(self, a, b):
        return self.base.shifted(self.arc(a, b)[1], 5)


def philox(counter, key):
    keys = [key & M32, key >> 32]
    for _ in range(10):
        a, b = 0xd2511f53 * counter[0], 0xcd9e8d57 * counter[2]
        counter = [(b >> 32) ^ counter[1] ^ keys[0], b & M32, (a >> 32) ^ counter[3] ^ keys[1], a & M32]
        keys = [(keys[0] + 0x9e3779b9) & M32, (keys[1] + 0xbb67ae85) & M32]
    return counter


class Stream:
    def __init__(self, base, key, drawn):
        self.base, self.key, self.drawn = base, key & M64, drawn & M64

    def block(self, number=None, domain=0):
        if number is None:
            number, self.drawn = self.drawn, (self.drawn + 1) & M64
        return philox([number & M32, (number >> 32) & M32, domain, 0], self.key)

    def word(self, **counter):
        block = self.block(**counter)
        return block[0] | block[1] << 32

    def below(self, n):
        while True:
            product = self.word() * n
            if product & M64 >= (1 << 64) % n:
                return product >> 64

    def between(self, low, high):
        if low == high:
            return low
        return self.base.signed((low + self.below(high - low + 1)) & M64)

    def direction(self):
        while True:
            v = [word - (1 << 32) if word >> 31 else word for word in self.block()[:3]]
            if 1 << 44 <= dot(v, v) <= 1 << 62:
                return self.base.unit_vector(v)

    def after(self, result):
        return (result if isinstance(result, list) else [result]) + [self.base.signed(self.drawn)]


def functions(base):
    rotations = Rotations(base)

    def halves(function, size):
        return lambda *v: function(list(v[:size]), list(v[size:2 * size]), *v[2 * size:])

    def drawn(draw):
        def function(key, drawn_before, *arguments):
            stream = Stream(base, key, drawn_before)
            return stream.after(draw(stream, *arguments))
        return function

    return {
        "angle_between": halves(rotations.angle_between, 3),
        "angle_between_orientations": halves(rotations.angle_between_orientations, 4),
        "from_directions": halves(rotations.from_directions, 3),
        "look_rotation": halves(rotations.look_rotation, 3),
        "slerp": halves(rotations.slerp, 4),
        "rotate_toward": halves(rotations.rotate_toward, 4),
        "philox": lambda low, high, key: philox([low & M32, (low & M64) >> 32, high & M32, (high & M64) >> 32],
                                                key & M64),
        "random_stream": lambda key, n: base.signed(Stream(base, key, 0).word(number=n & M64, domain=1)),
        "random_below": drawn(Stream.below),
        "random_between": drawn(Stream.between),
        "random_direction": drawn(Stream.direction),
    }
