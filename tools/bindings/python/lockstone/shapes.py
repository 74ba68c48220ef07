"""Shapes, and assets that some of them name."""

from __future__ import annotations

import ctypes
from typing import Iterable, Tuple

from . import units
from ._library import I32x3, PathPoint, Shape, lib
from .units import Quantity, Vector


def _length(value: Quantity) -> int:
    return units.raw(value, units.LENGTH, 32)


def lengths(vector: Vector) -> I32x3:
    return I32x3(*map(_length, vector))


def sphere(radius: Quantity) -> Shape:
    return Shape(0, I32x3(_length(radius), 0, 0), 0)


def capsule(half_height: Quantity, radius: Quantity) -> Shape:
    """Along y; the half height is that of the core segment."""
    return Shape(1, I32x3(_length(radius), _length(half_height), 0), 0)


def box(half_x: Quantity, half_y: Quantity, half_z: Quantity) -> Shape:
    return Shape(2, lengths((half_x, half_y, half_z)), 0)


def cylinder(half_height: Quantity, radius: Quantity) -> Shape:
    """Along y."""
    return Shape(8, I32x3(_length(radius), _length(half_height), 0), 0)


def cone(height: Quantity, radius: Quantity) -> Shape:
    """Along y, the apex up; its base is a quarter of the height below the centre of mass."""
    return Shape(9, I32x3(_length(radius), _length(height), 0), 0)


def tapered_capsule(height: Quantity, bottom_radius: Quantity, top_radius: Quantity) -> Shape:
    """The hull of two balls along y, whose centres are the height apart."""
    return Shape(10, lengths((bottom_radius, height, top_radius)), 0)


def rounded_box(half_x: Quantity, half_y: Quantity, half_z: Quantity, radius: Quantity) -> Shape:
    """A box of these half extents, and all within the radius of it."""
    return Shape(11, lengths((half_x, half_y, half_z)), _length(radius))


def half_space() -> Shape:
    """All below the plane y = 0 of its body, which must be static."""
    return Shape(4, I32x3(0, 0, 0), 0)


class Assets:
    """Geometry that worlds are made with. Every peer needs the same set."""

    def __init__(self) -> None:
        handle = ctypes.c_void_p()
        lib.lks_assets_create(ctypes.byref(handle))
        self.handle = handle

    def __del__(self) -> None:
        if hasattr(self, "handle"):
            lib.lks_assets_destroy(self.handle)

    def add_hull(self, points: Iterable[Vector], max_vertices: int = 64,
                 radius: Quantity = 0) -> Shape:
        """The convex hull of 4 … 65536 points; with a radius, all points within it of that hull."""
        raw = [lengths(point) for point in points]
        asset = ctypes.c_uint64()
        lib.lks_assets_add_rounded_hull(self.handle, (I32x3 * len(raw))(*raw), len(raw), max_vertices,
                                        _length(radius), ctypes.byref(asset))
        return Shape(3, I32x3(0, 0, 0), asset.value)

    def add_scaled(self, asset: int, factors: Vector) -> int:
        """A hull, mesh or height field of the set scaled along its axes; its name. Negative factors mirror."""
        name = ctypes.c_uint64()
        lib.lks_assets_add_scaled(self.handle, asset, I32x3(*(units.raw(factor, units.NUMBER, 32) for factor in factors)),
                                  ctypes.byref(name))
        return name.value

    def find_part(self, compound: int, part: int) -> Tuple[int, int]:
        """The child of a compound that a part of an event or query belongs to; of a mesh also the triangle, else 0."""
        child, triangle = ctypes.c_uint32(), ctypes.c_uint32()
        lib.lks_assets_find_part(self.handle, compound, part, ctypes.byref(child), ctypes.byref(triangle))
        return child.value, triangle.value

    def add_path(self, points: Iterable[Tuple[Vector, Vector]], closed: bool = False,
                 banks: Iterable[Quantity] = ()) -> int:
        """A smooth curve through 2 … 4096 points, each with the direction up there; its name, for path joints.

        `banks`: none, or for each point the angle in radians by which the track leans to the right.
        """
        raw = [PathPoint(lengths(point), I32x3(*(units.raw(part, units.UNIT, 32) for part in up)))
               for point, up in points]
        angles = [units.raw(bank, units.ANGLE, 32) for bank in banks]
        if angles and len(angles) != len(raw):
            raise ValueError("banks: as many as points, or none")
        asset = ctypes.c_uint64()
        if angles:
            lib.lks_assets_add_banked_path(self.handle, (PathPoint * len(raw))(*raw),
                                           (ctypes.c_int32 * len(raw))(*angles), len(raw), int(closed),
                                           ctypes.byref(asset))
            return asset.value
        lib.lks_assets_add_path(self.handle, (PathPoint * len(raw))(*raw), len(raw), int(closed),
                                ctypes.byref(asset))
        return asset.value
