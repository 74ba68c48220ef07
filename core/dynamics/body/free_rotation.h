// How a rigid body turns on its own, its angular momentum at rest in the world.
#pragma once

#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/dynamics/state/body_record.h"
#include "core/math/trig.h"

namespace lockstone {

/// A turn without torque: where it ends, and how many rotations about a principal axis it took
/// besides the one about the angular momentum.
struct FreeTurn {
  Quat orientation;
  std::uint32_t axis_turns = 0;
};

/// A duration: `fraction` / `rate` seconds, 1 ≤ rate < 2^20.
struct TurnTime {
  std::int32_t rate = 1;
  Unit fraction = Unit::from_integer(1);
};

/// The orientation of a dynamic body after a time with the angular momentum `spin` (as in
/// BodyRecord). `rotation` is the matrix of its orientation.
///
/// If all moments were the middle one, I_a, the body would turn about its angular momentum,
/// exactly. The differences of the others from I_a are rotations about their own axes, j the nearer
/// in 1/I and k the third, by (1/I − 1/I_a)·m with m the momentum in body axes: each keeps |m| and
/// is exact by itself. A sphere needs none, a symmetric top (I_j = I_a) one, and is then exact too.
/// Any other body takes them by turns, by the fourth-order scheme S6 of S. Blanes and P. Moan,
/// "Practical symplectic partitioned Runge-Kutta and Runge-Kutta-Nyström methods", 2002, or by
/// half, whole, half (Strang) where these turns are so small that this is as good. The energy has
/// no trend; it is off by less than 5e-3 of itself at any speed, by less than 1e-6 up to ¼ rad.
///
/// A body that turns about k by more than 1 rad goes in several pieces, at most 32; beyond, I_j
/// counts as I_a.
[[nodiscard]] FreeTurn turn_freely(const BodyRecord& body, const Mat3& rotation,
                                   const Vec3<Velocity>& spin, const TurnTime& time);

/// Principal axes by inverse moment, and the factors of one turn about each.
struct FreeAxes {
  int nearer = 0;
  int third = 0;
  std::int64_t nearer_excess = 0;  // of 1/I over that of the middle axis, 30 bits
  std::int64_t third_excess = 0;
  std::int64_t middle_step = 0;  // 1/I times the duration, 50 bits
  std::int64_t nearer_step = 0;  // of the excess
  std::int64_t third_step = 0;
};

/// The same for many turns of one body that take the same time each.
class FreeRotor {
 public:
  /// Moments and scale as in BodyRecord; moments may be up to 2.
  FreeRotor(const Vec3<Unit>& inertia, int scale_exponent, const TurnTime& time);

  [[nodiscard]] FreeTurn turn(const Quat& orientation, const Mat3& rotation,
                              const Vec3<Velocity>& spin) const;

  /// Rotation vector of the turn about the angular momentum alone.
  [[nodiscard]] RotationVector about_momentum(const Vec3<Velocity>& spin) const;

 private:
  FreeAxes axes_;
  TurnTime time_;
  int scale_exponent_;
};

/// The turn about the angular momentum alone.
[[nodiscard]] RotationVector turn_about_momentum(const BodyRecord& body, const TurnTime& time);

}  // namespace lockstone
