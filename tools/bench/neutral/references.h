// The judge's closed forms: free rotation and pendulums.
#pragma once

#include <array>
#include <vector>

#include "tools/bench/neutral/engine.h"

namespace lockstone::bench {

/// q·v·q*
[[nodiscard]] Triple turn(const std::array<double, 4>& orientation, const Triple& v);

/// Of a body about its centre, in the world's frame, over its mass.
struct Spin {
  double energy = 0;
  Triple momentum{};
};

/// As a body begins.
[[nodiscard]] Spin spin_of(const NeutralBody& body);
[[nodiscard]] double seen_energy(const NeutralBody& body, const BodyState& state);
[[nodiscard]] Triple seen_momentum(const NeutralBody& body, const BodyState& state);

/// The angle between a body that turned freely for a time and the recorded state.
[[nodiscard]] double degrees_off(const NeutralBody& body, double seconds, const BodyState& seen);

/// Of a body that is let go level with the pivot at the origin, along x; elliptic integral.
[[nodiscard]] double pendulum_period(const NeutralBody& bob, double gravity);

/// Over m·g·l; 0 where it was let go.
[[nodiscard]] double pendulum_energy(const NeutralBody& bob, double gravity,
                                     const BodyState& state);

/// The mean time between every other pass of the lowest point, from samples of every tick.
[[nodiscard]] double seen_period(const std::vector<std::vector<BodyState>>& samples);

}  // namespace lockstone::bench
