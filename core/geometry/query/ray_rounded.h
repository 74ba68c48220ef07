// Rays against polytopes with a radius.
#pragma once

#include "core/geometry/convex/polytope.h"
#include "core/geometry/query/ray_hit.h"

namespace lockstone::geometry {

/// The first of all meetings with the faces raised by the radius, with cylinders around the edges
/// and with balls around the vertices; of solids only. The fraction errs by the effect of a surface
/// that is off by 4 µm, and 2^-30.
[[nodiscard]] ShapeRayHit cast_ray_at_rounded(const Polytope& polytope, const Mat3& rotation,
                                              const Vec3<Length>& origin,
                                              const Vec3<Length>& translation);

}  // namespace lockstone::geometry
