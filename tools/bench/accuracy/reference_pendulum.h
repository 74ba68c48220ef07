// The motion of pendulums, in double.
#pragma once

#include <array>

namespace lockstone::bench {

/// The complete elliptic integral of the first kind, by the arithmetic-geometric mean.
[[nodiscard]] double elliptic_k(double modulus);

/// Angles from straight down of two bobs at arms of 1 m, let go level; `gyration`: the square of
/// their radii of gyration. The classic method of Runge and Kutta, a microsecond a step.
[[nodiscard]] std::array<double, 2> double_pendulum_angles(double seconds, double gravity,
                                                           double gyration);

}  // namespace lockstone::bench
