#include "core/geometry/contact/manifold/contact_choice.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/numeric/normals.h"

namespace lockstone::geometry {

bool attains(const Manifold& manifold, Fine separation) {
  LKS_ASSERT(manifold.count >= 0 && manifold.count <= k_max_manifold_points);
  const std::int64_t least = to_separation(separation - k_agreement).raw;
  const std::int64_t most = to_separation(separation + k_face_slack).raw;
  std::int64_t deepest = most + 1;
  for (int i = 0; i < manifold.count; ++i) {
    const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
    deepest = std::min<std::int64_t>(deepest, point.separation.raw);
  }
  return deepest >= least && deepest <= most;
}

bool touches(const Manifold& manifold) {
  for (int i = 0; i < manifold.count; ++i) {
    if (manifold.points[static_cast<std::size_t>(i)].separation.raw <= 0) return true;
  }
  return false;
}

Manifold separated_by(const Vec3<Unit>& normal) {
  Manifold manifold;
  manifold.normal = unit_axis(normal);
  return manifold;
}

}  // namespace lockstone::geometry
