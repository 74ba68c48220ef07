// How far a point is from a ball, a capsule or a tapered capsule, in closed form.
#pragma once

#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/distance/cores/rim_point_gap.h"

namespace lockstone::geometry {

struct TaperPointGap {
  RimPointGap gap{};
  Fine from_axis = 0;  ///< the distance of the point from the centre of the nearest ball
};

/// Of a core of one generator or none. The gap is that of the swollen core, without its radius:
/// negative inside. In the plane through the axis and the point, the ball that the point is nearest
/// to has its centre where a line square to the side meets the axis, or at an end. Of a point
/// within 2^-21 m of that centre, the side is nearest where it looks most along `perpendicular_to`
/// the axis.
[[nodiscard]] TaperPointGap taper_point_gap(const ConvexCore& core, const RawVec& point);

/// The length of a taper's side, between where it leaves the balls: of the axis `length`, and of
/// radii that differ by `fall`, at most as much.
[[nodiscard]] Fine taper_rise(Fine length, Fine fall);

/// Whether a core is one of those.
[[nodiscard]] constexpr bool is_taper(const ConvexCore& core) {
  return core.rims.count == 0 && core.vertex_count == 0 && core.generator_count <= 1;
}

}  // namespace lockstone::geometry
