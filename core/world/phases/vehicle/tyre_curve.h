// The shape of a tyre's force over its slip.
#pragma once

#include "core/world/phases/vehicle/real.h"

namespace lockstone {

/// The greatest slopes of the curves at zero: no force grows faster with slip.
inline constexpr Real k_steepest_grip = Real::ratio(7, 2);

/// Of the greatest force, −1 … 1.
struct Grip {
  Real along, across;
};

/// The force for slips that are 1 where a tyre grips best, along and across: towards the slip, of a
/// length that both curves give by their shares in the squared slip.
[[nodiscard]] Grip grip_of(Real along, Real across);

}  // namespace lockstone
