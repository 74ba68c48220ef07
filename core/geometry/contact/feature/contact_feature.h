// The part of a convex shape that looks along a direction: a point, a segment or a polygon.
#pragma once

#include <cstdint>

#include "core/base/unset_array.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/distance/manifold.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

struct FeaturePoint {
  RawVec at;         ///< from the shape's centre, world axes, fine
  std::uint32_t id;  ///< unique in the shape, below 2^16
};

/// One point, two of a segment, or a convex polygon, counter-clockwise seen from outside.
struct ContactFeature {
  int count = 0;
  bool is_flat = false;  ///< a face: `normal` is its outward normal
  Vec3<Unit> normal{};
  Length radius{};  ///< by which the points are inflated
  UnsetArray<FeaturePoint, k_max_polytope_face_edges> points;

  void add(const RawVec& at, std::uint32_t id) {
    points[static_cast<std::size_t>(count++)] = {at, id};
  }
};

/// The feature of a convex shape along the unit vector n, which points out of it. Of a one-sided
/// polytope, its front. `out` is overwritten.
void find_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out);

/// How far a convex shape reaches from its centre along a unit vector.
[[nodiscard]] Fine reach_along(const PosedShape& shape, const Vec3<Unit>& n);

}  // namespace lockstone::geometry
