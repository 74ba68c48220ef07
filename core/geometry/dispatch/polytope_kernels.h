// The operations on polytopes, behind pointers that hulls and triangles carry: a program that makes
// none of them links none of this.
#pragma once

#include "core/geometry/distance/manifold.h"
#include "core/geometry/query/ray_hit.h"

namespace lockstone::geometry {

struct PolytopeKernels {
  /// As `lockstone::collide`; `a` is a polytope, `b` a primitive or polytope. Of polytopes with a
  /// radius, either of the two is one, and `a` may be a half-space.
  Manifold (*collide)(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                      Length margin, const HeldFeatures& held);
  /// As `lockstone::cast_ray`.
  ShapeRayHit (*cast_ray)(const Polytope& polytope, const Mat3& rotation,
                          const Vec3<Length>& origin, const Vec3<Length>& translation);
};

/// That of polytopes without a radius; others have `hull_rounding`.
[[nodiscard]] const PolytopeKernels& polytope_kernels();

}  // namespace lockstone::geometry
