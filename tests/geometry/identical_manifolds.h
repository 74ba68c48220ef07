// Whether contacts with triangles are the same to the bit.
#pragma once

#include "core/geometry/mesh_contact/mesh_contacts.h"

namespace lockstone::test {

inline bool are_identical(const geometry::MeshManifolds& a, const geometry::MeshManifolds& b) {
  const auto same_point = [](const ManifoldPoint& p, const ManifoldPoint& q) {
    return p.anchor_a == q.anchor_a && p.anchor_b == q.anchor_b && p.separation == q.separation &&
           p.feature == q.feature;
  };
  if (a.count != b.count) return false;
  for (std::size_t i = 0; i < a.count; ++i) {
    const geometry::MeshManifold& x = a.manifolds[i];
    const geometry::MeshManifold& y = b.manifolds[i];
    if (x.key != y.key || x.part != y.part || x.manifold.normal != y.manifold.normal ||
        x.manifold.count != y.manifold.count) {
      return false;
    }
    for (std::size_t k = 0; k < static_cast<std::size_t>(x.manifold.count); ++k)
      if (!same_point(x.manifold.points[k], y.manifold.points[k])) return false;
  }
  return true;
}

}  // namespace lockstone::test
