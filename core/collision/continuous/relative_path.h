// How far a body goes as another body in motion sees it.
#pragma once

#include "core/geometry/distance/motion/separating_motion.h"

namespace lockstone {

/// At least the way of any point within `radius` of A's centre in a frame that moves and turns with
/// B, m. Where B turns by half a radian or more about any axis, the greatest position.
///
/// B sees A's centre at R(−sω)(r + s·d), r its place at first and d the difference of the
/// translations: its speed is |d − ω×(r + s·d)|, so that its way is at most |d − ω×r| + |ω|·|d|/2.
[[nodiscard]] Position relative_way(const Sweep& a, const Sweep& b, Length radius);

}  // namespace lockstone
