// Rays against polytopes.
#pragma once

#include "core/geometry/convex/polytope.h"
#include "core/geometry/query/ray_hit.h"

namespace lockstone::geometry {

/// The part of the ray below all planes (M. Cyrus and J. Beck, Generalized two- and
/// three-dimensional clipping), whose fractions are compared by cross products: exact for planes
/// whose heights are rounded to 2^-50 m. Of a flat polytope, the point of its plane, which must be
/// in the polygon or within 2 µm of it, so that no ray slips between two that share an edge.
[[nodiscard]] ShapeRayHit cast_ray_at_polytope(const Polytope& polytope, const Mat3& rotation,
                                               const Vec3<Length>& origin,
                                               const Vec3<Length>& translation);

}  // namespace lockstone::geometry
