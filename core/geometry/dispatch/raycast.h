// Rays against single shapes.
#pragma once

#include <lockstone/quat.h>
#include <lockstone/shape.h>

#include "core/geometry/distance/manifold.h"
#include "core/geometry/query/ray_hit.h"

namespace lockstone {

/// The ray runs from `origin` to `origin + translation`; `origin` is relative to the shape's
/// centre, in world axes. Components of both within ±1448 m (so that |v|² fits 63 bits). A start
/// inside or on the surface hits at fraction 0 with a zero normal.
[[nodiscard]] ShapeRayHit cast_ray(const Shape& shape, const Mat3& rotation,
                                   const Vec3<Length>& origin, const Vec3<Length>& translation);

/// Likewise, and of hulls and half-spaces. The rays of a flat polytope meet its polygon, those of a
/// one-sided one only from the front; those of a half-space meet the space below its plane, each
/// within 2 µm. To rays, a hull is the intersection of its faces' half-spaces; where faces were
/// merged that holds its vertices, and reaches beyond them at sharp edges.
[[nodiscard]] ShapeRayHit cast_ray(const PosedShape& posed, const Vec3<Length>& origin,
                                   const Vec3<Length>& translation);

}  // namespace lockstone
