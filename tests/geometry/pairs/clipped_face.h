// How deep a box's face reaches into another's, clipped to its sides: exact, and a little wider.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "tests/geometry/reference.h"

namespace lockstone::test {

/// The corners of a face of `other`, the one most opposed to the face `axis` of `own` on the side
/// of `up`: x and y along the face of `own`, z the height above it.
inline std::vector<RealVec> incident_corners(const Placed& own, int axis, const RealVec& up,
                                             const Placed& other) {
  const auto lean = [&](int k) {
    return std::fabs(dot(other.axes[static_cast<std::size_t>(k)], up));
  };
  int most = 0;
  for (int k = 1; k < 3; ++k)
    if (lean(k) > lean(most)) most = k;
  std::vector<RealVec> corners;
  for (const auto& [u, v] : {std::pair{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}) {
    RealVec along;
    along[most] = dot(other.axes[static_cast<std::size_t>(most)], up) > 0 ? -1 : 1;
    along[(most + 1) % 3] = u;
    along[(most + 2) % 3] = v;
    RealVec corner = other.centre - own.centre;
    for (int k = 0; k < 3; ++k)
      corner = corner + other.axes[static_cast<std::size_t>(k)] * (along[k] * other.size[k]);
    corners.push_back({dot(corner, own.axes[static_cast<std::size_t>((axis + 1) % 3)]),
                       dot(corner, own.axes[static_cast<std::size_t>((axis + 2) % 3)]),
                       dot(corner, up) - own.size[axis]});
  }
  return corners;
}

/// The part of the polygon where sign · lane ≤ limit.
inline std::vector<RealVec> clipped(const std::vector<RealVec>& polygon, int lane, int sign,
                                    Real limit) {
  std::vector<RealVec> result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const RealVec& from = polygon[i];
    const RealVec& to = polygon[(i + 1) % polygon.size()];
    const Real inside = limit - sign * from[lane];
    const Real after = limit - sign * to[lane];
    if (inside >= 0) result.push_back(from);
    if ((inside < 0) != (after < 0))
      result.push_back(from + (to - from) * (inside / (inside - after)));
  }
  return result;
}

/// The least height of a face of `other` above a face of `own`, within the sides of that moved
/// outward by `wider`; 1e30 where nothing is within.
inline Real deepest_within(const Placed& own, int axis, const RealVec& up, const Placed& other,
                           Real wider) {
  std::vector<RealVec> polygon = incident_corners(own, axis, up, other);
  for (const int sign : {1, -1}) {
    polygon = clipped(polygon, 0, sign, own.size[(axis + 1) % 3] + wider);
    polygon = clipped(polygon, 1, sign, own.size[(axis + 2) % 3] + wider);
  }
  Real least = 1e30L;
  for (const RealVec& v : polygon)
    least = std::min(least, v.z);
  return least;
}

}  // namespace lockstone::test
