// Rays at the side of a cone, of which frusta and tapered capsules have a part.
#pragma once

#include "core/geometry/shapes/rim_shape.h"

namespace lockstone::geometry {

/// The side of a solid about the y axis with the outward normal out · (x, z) / |(x, z)| + up · y.
/// At the height `level` its plane has the distance `at_level` from the axis' point there.
struct SlopingSide {
  Unit out;
  Unit up;
  Fine level;
  Fine at_level;
};

/// Heights of a part of a side.
struct HeightRange {
  Fine low;
  Fine high;
};

/// Where a ray from outside enters through the side between two heights.
[[nodiscard]] RimHit meet_side(const SlopingSide& side, const AxisRay& ray,
                               const HeightRange& range);

}  // namespace lockstone::geometry
