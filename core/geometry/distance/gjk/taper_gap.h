// The distance of tapered capsules from other convex cores.
#pragma once

#include "core/geometry/distance/gjk/closest_features.h"

namespace lockstone::geometry {

struct TaperGap {
  bool apart = false;  ///< the axis of the taper has a distance from the other core
  CoreGap gap{};       ///< of the swollen cores: then its distance may be negative, and is a depth
  Simplex features{};  ///< indices of vertices only
};

/// Of two cores, one or both tapered; `offset` is that of B's centre from A's. A tapered capsule is
/// the union of balls along its axis. The distance of the other core from a ball's centre is
/// a convex function of the place on the axis, and so is that less the radius. Its derivative has
/// the normal alone in it: n · axis + the growth of the radius. So the least is at an end, or where
/// the derivative is zero, which the Illinois method finds (M. Dowell, P. Jarratt, A modified
/// regula falsi method, 1971). The normal is exact to the last bits: it is that of a point.
[[nodiscard]] TaperGap taper_gap(const ConvexCore& a, const ConvexCore& b, const RawVec& offset);

/// Of a tapered core and a point, in closed form, the centre at any depth.
[[nodiscard]] CoreGap taper_point_core_gap(const ConvexCore& a, const ConvexCore& b,
                                           const RawVec& offset);

}  // namespace lockstone::geometry
