// Free rotation of a rigid body in long double, found without the core's splitting.
#pragma once

#include "tools/bench/accuracy/long_vectors.h"

namespace lockstone::bench {

struct LongQuat {
  Long x = 0;
  Long y = 0;
  Long z = 0;
  Long w = 1;
};

[[nodiscard]] LongQuat multiply(const LongQuat& a, const LongQuat& b);
[[nodiscard]] LongQuat conjugate(const LongQuat& q);
/// The rotation by the angle |v| about v.
[[nodiscard]] LongQuat exponential(const Long3& v);
/// q·v·q*
[[nodiscard]] Long3 rotate(const LongQuat& q, const Long3& v);
/// The angle between two orientations, rad.
[[nodiscard]] Long angle_between(const LongQuat& a, const LongQuat& b);

/// A torque-free body: principal moments, and the angular momentum, which stays, in the world.
struct FreeBody {
  Long3 moments{};
  Long3 momentum{};
};

/// Half of ω·L.
[[nodiscard]] Long energy(const FreeBody& body, const LongQuat& q);

/// The orientation after a time. H. Munthe-Kaas, "High order Runge-Kutta methods on manifolds",
/// 1999: fourth order, in equal steps.
[[nodiscard]] LongQuat turn_freely(const FreeBody& body, const LongQuat& start, Long seconds,
                                   int steps);

/// The times at which the component of L along the middle axis vanishes, for a body that starts
/// with none along the axis of its least moment, and more energy than L²/2 over the greatest. L.
/// Landau, E. Lifshitz, "Mechanics", §37: the first after a quarter of the period, 2K each then.
struct FlipTimes {
  Long first = 0;
  Long interval = 0;
};

/// Moments ascending; L² above twice the energy times the middle one.
[[nodiscard]] FlipTimes flip_times(const Long3& moments, Long momentum_squared, Long twice_energy);

}  // namespace lockstone::bench
