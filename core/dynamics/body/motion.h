// How bodies move within a tick.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include <lockstone/assert.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/math/trig.h"

namespace lockstone {

/// Whether the body has a velocity or turns.
[[nodiscard]] inline bool has_motion(const BodyRecord& body) {
  return body.velocity != Vec3<Velocity>{} || body.spin != Vec3<Velocity>{};
}

/// Whether it moves by less than 2^exponent m/s along each axis, centre and surface.
[[nodiscard]] bool is_slower_than(const BodyRecord& body, int exponent);

/// Of parts of a tick.
inline constexpr Unit k_whole_tick = Unit::from_integer(1);

[[nodiscard]] constexpr Velocity times(Velocity v, Unit factor) {
  return Velocity::from_raw(raw::multiply_shift(v.raw, factor.raw, Unit::frac_bits));
}

/// Scales velocity, or spin, by e^(−damping·dt). Flight damps the velocity by itself.
void damp_velocity(BodyRecord& body, const TimeStep& step);
void damp_spin(BodyRecord& body, const TimeStep& step);

/// Clamps the speed to the world's limit and the body's, the surface speed to 500 m/s and the
/// body's. Returns whether it had to.
bool limit_speed(BodyRecord& body, const InverseInertia& inertia, Velocity world_limit);

/// Velocity and spin along locked axes are zero.
void apply_axis_locks(BodyRecord& body);

/// Clamps each component to ±500 m/s, since commands may add up between two ticks. The tick's end
/// limits the speeds themselves.
void clamp_speed(Vec3<Velocity>& v);

/// Clamps the position to the world, and stops the components of motion out of it. Returns whether
/// it had to.
bool limit_position(BodyRecord& body);

/// The exact step of a body that nothing touches, and of a kinematic one. In flight
/// x ← x + v·dt + g·dt²/2, under damping c exactly as v' = g − c·v says, and spin is constant; the
/// orientation follows `turn_freely`. Returns the number of turns about an axis that this took.
///
/// The changes of a tick are rounded so that `tick_rate` ticks in a row, counted from `tick`, add
/// up to exactly the change of one second: drift and free fall lose nothing.
std::uint32_t fly(BodyRecord& body, const Mat3& rotation, const Vec3<Acceleration>& gravity,
                  const TimeStep& step, std::uint64_t tick);

/// Turns a body for a part of a tick as in flight; `rotation` is the matrix of its orientation.
std::uint32_t turn_in_flight(BodyRecord& body, const Mat3& rotation, const TimeStep& step,
                             Unit part);

/// How a body came from an orientation, with the matrix `rotation`, to the one that it has in a
/// part of a tick: the rotation between them, with the whole turns that follow from its spin. A
/// thin and fast body is taken to turn about its angular momentum alone, without the spin about its
/// axis.
[[nodiscard]] RotationVector turn_since(const Quat& start, const Mat3& rotation,
                                        const BodyRecord& body, const TimeStep& step, Unit part);

/// gravity · gravity_scale, and 0 along locked axes and for static and kinematic bodies.
[[nodiscard]] Vec3<Acceleration> gravity_on(const BodyRecord& body,
                                            const Vec3<Acceleration>& gravity);

/// The velocity that gravity gives a body in a fraction of a tick.
[[nodiscard]] Vec3<Velocity> gravity_gain(const BodyRecord& body, const Vec3<Acceleration>& gravity,
                                          const TimeStep& step, Unit fraction);

/// The velocity that gravity and forces give a body in a tick.
[[nodiscard]] Vec3<Velocity> tick_gain(const BodyRecord& body, const Vec3<Acceleration>& gravity,
                                       const TimeStep& step);

/// A body as the solver takes it up.
[[nodiscard]] SolverBody solver_body(const BodyRecord& body, const Mat3& rotation,
                                     const Vec3<Acceleration>& gravity, const TimeStep& step);

/// Surface velocity (m/s, Q32) from spin in Q50, rounded to 2^-22 m/s before it is multiplied.
[[nodiscard]] inline std::array<std::int64_t, 3> surface_velocity(
    const InverseInertia& m, const std::array<std::int64_t, 3>& spin_q50) {
  // |spin| ≤ 2^31 in Q22, so that three products stay below 2^63.
  const auto read = [](std::int64_t x) {
    const std::int64_t bound = std::int64_t{1} << 31;
    return std::clamp(raw::round_shift(x, 28), -bound, bound);
  };
  const std::int64_t x = read(spin_q50[0]), y = read(spin_q50[1]), z = read(spin_q50[2]);
  // Q22 · Q(30 − exponent), to Q32.
  const int shift = 20 - m.exponent;
  LKS_ASSERT(m.exponent >= 0 && m.exponent <= 20);
  const auto row = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    return raw::round_shift(a * x + b * y + c * z, shift);
  };
  return {row(m.xx, m.xy, m.xz), row(m.xy, m.yy, m.yz), row(m.xz, m.yz, m.zz)};
}

/// Moves a body by its travel in the solver, m: `displacement` of its centre, and `turned` of its
/// surface (rotation vector · 2^scale_exponent) with its geometry fixed. The body turns
/// freely with the mean angular momentum of the tick. Returns as `fly`. `body` has its new spin
/// already. Impulses without torque about the old axis of a thin body have none about its new one.
std::uint32_t end_substeps(BodyRecord& body, const Mat3& rotation,
                           const Vec3<Velocity>& displacement, const Vec3<Velocity>& turned,
                           const TimeStep& step);

}  // namespace lockstone
