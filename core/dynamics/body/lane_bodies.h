// Bodies as kernels read them.
#pragma once

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/solver_body.h"
#include "core/kernels/ball/ball_block.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {

/// From the Q32 of velocities to the Q50 of rows.
inline constexpr int k_grid_to_row = lanes::k_velocity_bits - lanes::k_grid_bits;

/// The velocity, or the spin, that a row holds, rounded down.
[[nodiscard]] inline Vec3<Velocity> velocity_of_row(const std::array<std::int64_t, 3>& v) {
  return {Velocity::from_raw(v[0] >> k_grid_to_row), Velocity::from_raw(v[1] >> k_grid_to_row),
          Velocity::from_raw(v[2] >> k_grid_to_row)};
}

[[nodiscard]] inline lanes::BodyInertia body_inertia(const InverseInertia& m) {
  return {{m.xx, m.yy, m.zz, m.xy, m.xz, m.yz}};
}

[[nodiscard]] inline lanes::BodyPlace body_place(const Vec3<Position>& position, const Mat3& r) {
  const auto both = [](Unit low, Unit high) { return lanes::scalar::pack(low.raw, high.raw); };
  return {{position.x.raw, position.y.raw, position.z.raw, both(r.x.x, r.x.y), both(r.x.z, r.y.x),
           both(r.y.y, r.y.z), both(r.z.x, r.z.y), both(r.z.z, {})}};
}

/// Eight steps of the velocities that rows can read, 7.6 µm/s: a body supported by contacts
/// trembles by so much.
inline constexpr std::int64_t k_tremble = std::int64_t{8} << (lanes::k_velocity_bits - 20);

[[nodiscard]] constexpr bool is_below(std::int64_t x, std::int64_t bound) {
  return x < bound && x > -bound;
}

/// Impulses that change no component of a velocity by more give little energy: 1/4 m/s.
inline constexpr std::int64_t k_soft_push = std::int64_t{1} << (lanes::k_velocity_bits - 2);

/// Whether all components of its motion are.
[[nodiscard]] inline bool is_below(const lanes::BodyVelocity& row, std::int64_t bound) {
  return is_below(row.velocity[0], bound) && is_below(row.velocity[1], bound) &&
         is_below(row.velocity[2], bound) && is_below(row.spin[0], bound) &&
         is_below(row.spin[1], bound) && is_below(row.spin[2], bound);
}

/// Velocities of a substep stay within 2048 m/s.
inline constexpr std::int64_t k_greatest_velocity = std::int64_t{1}
                                                    << (lanes::k_velocity_bits + 11);

[[nodiscard]] constexpr std::int64_t bounded_row(std::int64_t x) {
  return std::clamp(x, -k_greatest_velocity, k_greatest_velocity);
}

/// As if both were within these bounds: several contacts may push a body by more.
[[nodiscard]] inline lanes::BodyVelocity difference(const lanes::BodyVelocity& a,
                                                    const lanes::BodyVelocity& b) {
  lanes::BodyVelocity result = a;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    result.velocity[axis] = bounded_row(a.velocity[axis]) - bounded_row(b.velocity[axis]);
    result.spin[axis] = bounded_row(a.spin[axis]) - bounded_row(b.spin[axis]);
  }
  LKS_ASSERT(is_below(result, 2 * k_greatest_velocity + 1));
  return result;
}

/// A body that only trembles counts as still.
[[nodiscard]] inline bool is_still(const lanes::BodyVelocity& row) {
  return is_below(row, k_tremble);
}

/// Clears each component below k_tremble, if all are below eight times that: a body that sinks or
/// rises by a hair on a slope does not creep down meanwhile. Only for bodies that touch one other,
/// which does not give way: in a pile, the cleared velocities would add up.
[[nodiscard]] inline lanes::BodyVelocity steadied(const lanes::BodyVelocity& row) {
  if (!is_below(row, 8 * k_tremble)) return row;
  lanes::BodyVelocity result = row;
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_below(row.velocity[i], k_tremble)) result.velocity[i] = 0;
    if (is_below(row.spin[i], k_tremble)) result.spin[i] = 0;
  }
  return result;
}

/// Whether a body is slower than 2^-shift of the speed that gravity and forces give it in a
/// substep.
[[nodiscard]] inline bool is_slower(const lanes::BodyVelocity& row, const SolverBody& body,
                                    int shift) {
  return is_below(row, (body.greatest_gain() >> shift) * (std::int64_t{1} << k_grid_to_row));
}

/// Whether it is slower than 1/4 m/s along each axis, so that contact impulses may be taken for
/// weight.
[[nodiscard]] inline bool is_at_rest(const lanes::BodyVelocity& row) {
  constexpr std::int64_t k_most = std::int64_t{1} << (lanes::k_velocity_bits - 2);
  return is_below(row.velocity[0], k_most) && is_below(row.velocity[1], k_most) &&
         is_below(row.velocity[2], k_most);
}

}  // namespace lockstone
