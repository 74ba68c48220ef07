// Geometry for scenes: hulls, compounds, meshes and terrains, made of integers alone.
#pragma once

#include <span>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>

#include "tools/scenes/build.h"

namespace lockstone::scenes {

using Point = Vec3<Length>;

/// The hull of points that a scene knows to have one.
[[nodiscard]] AssetPtr hull_of(std::span<const Point> points);

/// The hull of `count` points at random on an ellipsoid.
[[nodiscard]] AssetPtr random_hull(Random& random, const Point& half_axes, int count);

/// A pointed roof lying on its side: five faces, one edge along z.
[[nodiscard]] AssetPtr wedge(Length half_x, Length half_y, Length half_z);

/// A regular pillar about the y axis.
[[nodiscard]] AssetPtr prism(int sides, Length radius, Length half_height);

[[nodiscard]] AssetPtr compound_of(std::span<const CompoundChild> children);

/// A box as a child, `density` times as dense as the body.
[[nodiscard]] CompoundChild box_child(const Point& position, const Point& half_extents,
                                      Number density = Number::from_integer(1));

/// Furniture and tools; all but the dumbbell stand on y = 0.
[[nodiscard]] AssetPtr chair();
[[nodiscard]] AssetPtr table();
[[nodiscard]] AssetPtr dumbbell();
[[nodiscard]] AssetPtr hammer();  ///< a head of steel on a handle of wood
[[nodiscard]] AssetPtr axe();     ///< its blade is a hull

/// A polyline in the x-y plane, pulled along z over ±half_width in `strips` strips. The side to the
/// left of its path (above, when x ascends) is the front.
[[nodiscard]] AssetPtr extruded(std::span<const Point> profile, Length half_width, int strips);

/// A level floor of square panels, in the plane y = 0 about the origin: those of a row along x are
/// groups one after the other.
[[nodiscard]] AssetPtr panels(std::uint32_t columns, std::uint32_t rows, std::int32_t side_mm);

/// A paraboloid that opens upwards, its lowest point at the origin.
[[nodiscard]] AssetPtr bowl(Length radius, Length depth, int rings, int segments);

/// A flat wall in the plane x = 0, its front towards −x.
[[nodiscard]] AssetPtr wall_mesh(Length half_width, Length half_height);

}  // namespace lockstone::scenes
