#include <lockstone/hull.h>

#include "core/geometry/assets/hull_rounding.h"
#include "core/geometry/contact/feature/collide_convex.h"
#include "core/geometry/convex/rounded_solid.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/query/ray_rounded.h"
#include "core/geometry/shapes/rim_shape.h"

namespace lockstone {
namespace geometry {

namespace {

Manifold collide_rounded(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                         Length margin, const HeldFeatures& /*held*/) {
  if (a.shape.kind != ShapeKind::half_space) return collide_convex(a, b, offset, margin);
  const Vec3<Unit> normal = unit_axis(a.rotation.y);
  const PlaneMeeting plane{normal, b, offset, margin, lockstone::dot(normal, offset).raw};
  const Manifold manifold = below_feature(plane);
  return manifold.count > 0 ? manifold : Manifold{};
}

}  // namespace

const HullRounding k_hull_rounding{
    {collide_rounded, cast_ray_at_rounded}, rounded_solid_of, facet_correction};

}  // namespace geometry

HullOptions HullOptions::rounded(Length radius, int max_vertices) {
  HullOptions options;
  options.max_vertices = max_vertices;
  options.radius = radius;
  return options;
}

}  // namespace lockstone
