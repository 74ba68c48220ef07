"""Quantities: raw fixed-point integers, exactly from and to whole numbers, fractions and decimals."""

from __future__ import annotations

from decimal import Decimal
from fractions import Fraction
from typing import Tuple, Union

POSITION = VELOCITY = ANGULAR_VELOCITY = ACCELERATION = MASS = 32
IMPULSE = 24
MASS = 32
INERTIA = 28
FORCE = LENGTH = NUMBER = RATE = SPEED = 20
UNIT = 30
ANGLE = 27
DENSITY = 8


class Raw(int):
    """A quantity that is a raw integer already."""


Quantity = Union[int, str, Fraction, Decimal, Raw]
Vector = Tuple[Quantity, Quantity, Quantity]
Rotation = Tuple[Quantity, Quantity, Quantity, Quantity]


def raw(value: Quantity, bits: int, width: int = 64) -> int:
    """`value` · 2^bits to nearest, ties away from zero: 1, "9.81", Fraction(1, 3), Raw(12).

    A float is refused: two machines may have computed two. OverflowError beyond the format.
    """
    if isinstance(value, float):
        raise TypeError("a float is no exact quantity: write '1.5', Fraction(3, 2) or Raw(…)")
    result = int(value) if isinstance(value, Raw) else _rounded(Fraction(value) * (1 << bits))
    if not -(1 << (width - 1)) <= result < 1 << (width - 1):
        raise OverflowError(f"{value} does not fit in {width} bits")
    return result


def _rounded(exact: Fraction) -> int:
    size = (2 * abs(exact.numerator) + exact.denominator) // (2 * exact.denominator)
    return -size if exact < 0 else size


def exact(raw_value: int, bits: int) -> Fraction:
    """The value of a raw integer, exactly. `float` of it is for drawing."""
    return Fraction(raw_value, 1 << bits)
