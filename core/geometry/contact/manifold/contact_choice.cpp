#include "core/geometry/contact/manifold/contact_choice.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/distance/manifold_checks.h"
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
  return deepest_of(manifold) <= 0;
}

bool are_alike(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  LKS_ASSERT(is_unit(a) && is_unit(b));
  constexpr std::int64_t k_cosine = Unit::from_ratio(97, 100).raw;
  return dot(a, b).raw >= k_cosine * (std::int64_t{1} << Unit::frac_bits);
}

Fine deepest_of(const Manifold& manifold) {
  LKS_ASSERT(manifold.count >= 0 && manifold.count <= k_max_manifold_points);
  Fine deepest = 1;
  for (int i = 0; i < manifold.count; ++i)
    deepest = std::min(deepest, fine(manifold.points[static_cast<std::size_t>(i)].separation));
  return deepest;
}

bool stays_reference(const Manifold& on_face, Fine separation) {
  LKS_ASSERT(separation <= 0);
  const Fine deepest = deepest_of(on_face);
  return deepest <= 0 && second_face_threshold(deepest) >= separation;
}

bool is_better_than_held(const Manifold& on_face, const Vec3<Unit>& edge_normal,
                         Fine edge_separation) {
  LKS_ASSERT(edge_separation <= 0);
  const Fine deepest = deepest_of(on_face);
  return deepest <= 0 &&
         (are_alike(on_face.normal, edge_normal) || edge_separation < held_edge_threshold(deepest));
}

Manifold separated_by(const Vec3<Unit>& normal) {
  LKS_ASSERT(is_unit(normal));
  Manifold manifold;
  manifold.normal = unit_axis(normal);
  return manifold;
}

}  // namespace lockstone::geometry
