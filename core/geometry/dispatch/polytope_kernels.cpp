#include "core/geometry/dispatch/polytope_kernels.h"

#include "core/geometry/contact/polytope/polytope_collide.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/query/ray_polytope.h"

namespace lockstone::geometry {
namespace {

Manifold collide_polytope(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                          Length margin, const HeldFeatures& held) {
  if (b.polytope != nullptr && b.polytope->radius > Length{})
    return b.polytope->kernels->collide(a, b, offset, margin, held);
  if (b.shape.kind == ShapeKind::sphere) return collide_polytope_sphere(a, b, offset, margin);
  if (b.shape.kind == ShapeKind::capsule) return collide_polytope_capsule(a, b, offset, margin);
  if (b.polytope == nullptr && b.shape.kind != ShapeKind::box)
    return traits_of(b.shape).collide(a, b, offset, margin);
  return collide_polytopes(a, b, offset, margin, held);
}

constexpr PolytopeKernels k_kernels{collide_polytope, cast_ray_at_polytope};

}  // namespace

const PolytopeKernels& polytope_kernels() {
  return k_kernels;
}

}  // namespace lockstone::geometry
