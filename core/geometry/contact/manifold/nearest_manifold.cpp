#include "core/geometry/contact/manifold/nearest_manifold.h"

#include <lockstone/assert.h>

#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/manifold_checks.h"

namespace lockstone::geometry {
namespace {

constexpr std::uint32_t k_nearest_feature = 1U << 30;

Fine fine_of(Position distance) {
  return distance.raw * (Fine{1} << (k_fine_bits - Position::frac_bits));
}

}  // namespace

Manifold nearest_manifold(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                          Length margin) {
  const ClosestPoints near = distance(a, b, offset);
  Manifold manifold;
  if (!near.overlapping) {
    manifold.normal = near.normal;
    const RawVec on_b = geometry::fine(near.point_b) + geometry::fine(offset);
    add_point_on(b.shape, manifold, {geometry::fine(near.point_a), on_b}, offset,
                 fine_of(near.distance), margin, k_nearest_feature);
  } else {
    const Penetration deep = penetration(a, b, offset);
    manifold.normal = deep.normal;
    const RawVec on_b = geometry::fine(deep.point_b) + geometry::fine(offset);
    add_point_on(b.shape, manifold, {geometry::fine(deep.point_a), on_b}, offset,
                 -fine_of(deep.depth), margin, k_nearest_feature);
  }
  LKS_ASSERT(is_unit(manifold.normal) && manifold.count <= 1);
  return manifold;
}

}  // namespace lockstone::geometry
