// Mass distribution of polyhedra.
#pragma once

#include <optional>
#include <span>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/convex/hull_triangles.h"
#include "core/geometry/convex/solid.h"

namespace lockstone::geometry {

/// Of the solid that the triangles bound, closed, counter-clockwise from outside and of positive
/// volume, |coordinate| ≤ k_max_asset_coordinate; nothing when its radius exceeds
/// k_max_hull_radius. `inner_radius` is left at zero.
///
/// Integrals over tetrahedra with a common apex (D. Eberly, Polyhedral mass properties revisited),
/// as exact whole numbers: of products of five coordinates in 192 bits, with the apex at the centre
/// of mass, so that neither the distance from the frame's origin nor thinness costs a digit.
[[nodiscard]] std::optional<Solid> solid_of(std::span<const Vec3<Length>> vertices,
                                            std::span<const Triangle> triangles);

}  // namespace lockstone::geometry
