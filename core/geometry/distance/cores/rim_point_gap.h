// How far a point is from a solid with rims, in closed form.
#pragma once

#include "core/geometry/distance/cores/rims.h"

namespace lockstone::geometry {

struct RimPointGap {
  Vec3<Unit> normal{};  ///< of the surface where it is nearest, outward
  Fine distance = 0;    ///< of the point from the surface; negative inside the solid
  RawVec on_surface{};  ///< the nearest point, from the solid's centre
};

/// In the plane through the axis and the point, the solid is a polygon of three or two sides: the
/// discs and the line between the rims. Inside it the nearest side counts, the first of equals in
/// the order base, top, line. Of a point within 2^-21 m of the axis, the line is nearest along u.
/// Error: 1 µm there; elsewhere that of products in fine lanes and of a unit normal, 2^-30 of the
/// sizes.
[[nodiscard]] RimPointGap rim_point_gap(const Rims& rims, const RawVec& point);

/// The outward normal of the side where it passes the point.
[[nodiscard]] Vec3<Unit> rim_side_normal(const Rims& rims, const RawVec& point);

}  // namespace lockstone::geometry
