#include "core/dynamics/joint/turn_springs.h"

#include <lockstone/assert.h>
#include <lockstone/quat.h>

#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

constexpr std::size_t k_twist = 3;

bool is_sprung(const JointRecord& joint, std::size_t axis) {
  return joint.axes[axis].is_spring();
}

std::int64_t product(std::int64_t x, std::int64_t y) {
  return raw::round_shift(x * y, 30);
}

// α / sin α of an angle within ±π/2, Q30. Below 2^-4 the series 1 + s²/6 + 3·s⁴/40, within 2^-28.
std::int64_t angle_over_sine(std::int64_t sine, std::int64_t cosine) {
  LKS_ASSERT(sine >= 0 && cosine >= 0);
  if (sine < k_one >> 4) {
    const std::int64_t square = product(sine, sine);
    return k_one + square / 6 + 3 * product(square, square) / 40;
  }
  return raw::round_divide(std::int64_t{atan2_raw(sine, cosine).raw} << 33, sine);
}

Quat target_of(const JointRecord& joint) {
  RotationVector target;
  for (int i = 0; i < 3; ++i) {
    const std::size_t axis = k_twist + static_cast<std::size_t>(i);
    if (joint.mode(axis) == AxisMode::locked) continue;
    target[i].raw = std::int64_t{joint.axes[axis].target} << 5;
  }
  return rotation_from_vector(target);
}

RawVec3 in_world_axes(const Mat3& frame, const RawVec3& v) {
  RawVec3 result;
  for (int i = 0; i < 3; ++i) {
    std::int64_t sum = 0;
    for (int j = 0; j < 3; ++j)
      sum += frame.column(j)[i].raw * v[static_cast<std::size_t>(j)];
    result[static_cast<std::size_t>(i)] = raw::round_shift(sum, 30);
  }
  return result;
}

// With n the direction of θ, α half its length, k = α / sin α and v the vector part of the
// quaternion, row i of J is k·w·e_i + (1 − k·w)·n_i·n + k·e_i × v.
SpringTurnRows whole_rows(Quat off, const Mat3& frame_b) {
  if (off.w < Unit{}) off = {-off.x, -off.y, -off.z, -off.w};
  const RawVec3 v{off.x.raw, off.y.raw, off.z.raw};
  const auto sine = static_cast<std::int64_t>(norm(v[0], v[1], v[2]));
  const std::int64_t k = angle_over_sine(sine, off.w.raw), cosine = product(k, off.w.raw);
  LKS_ASSERT(sine <= k_one + 4 && k >= k_one && k <= 2 * k_one);  // 1 … π/2
  SpringTurnRows rows;
  RawVec3 n{};
  for (std::size_t i = 0; i < 3 && sine > 0; ++i)
    n[i] = raw::round_divide(v[i] * k_one, sine);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3, l = (i + 2) % 3;
    RawVec3 row;
    for (std::size_t axis = 0; axis < 3; ++axis)
      row[axis] = product(k_one - cosine, product(n[i], n[axis]));
    row[i] += cosine;
    row[j] -= product(k, v[l]);
    row[l] += product(k, v[j]);
    rows.axes[i] = in_world_axes(frame_b, row);
    const std::int64_t along = product(n[i], n[i]);
    const std::int64_t square = along + product(product(k, k), k_one - along);
    rows.errors[i] = product_rounded(raw::round_shift(k * v[i], 27), square, 30);
  }
  return rows;
}

// The turn by the shortest arc from the x axis that is the target to that of frame B.
SpringTurnRows swing_rows(const Mat3& target, const Mat3& frame_b) {
  const std::int64_t along = raw::round_shift(dot(target.x, frame_b.x).raw, 30);
  const RawVec3 across{0, -raw::round_shift(dot(target.z, frame_b.x).raw, 30),
                       raw::round_shift(dot(target.y, frame_b.x).raw, 30)};
  const auto sine = static_cast<std::int64_t>(norm(0, across[1], across[2]));
  SpringTurnRows rows;
  rows.axes[1] = {target.y.x.raw, target.y.y.raw, target.y.z.raw};
  rows.axes[2] = {target.z.x.raw, target.z.y.raw, target.z.z.raw};
  const std::int64_t angle = atan2_raw(sine, along).raw;
  LKS_ASSERT(sine >= 0 && angle >= 0);
  if (sine == 0) {  // at the target, or opposite it, where one side is as good as another
    rows.errors[1] = angle << 5;
    return rows;
  }
  for (std::size_t i = 1; i < 3; ++i) {
    rows.errors[i] = along > 0
                         ? raw::round_shift(angle_over_sine(sine, along) * across[i], 28)
                         : raw::round_shift(angle * raw::round_divide(across[i] * k_one, sine), 25);
  }
  return rows;
}

}  // namespace

SpringTurn spring_turn(const JointRecord& joint) {
  if (joint.is(JointKind::path)) return SpringTurn::apart;
  const auto has_spring_or_lock = [&](std::size_t axis) {
    return is_sprung(joint, axis) || joint.mode(axis) == AxisMode::locked;
  };
  const bool tilts = is_sprung(joint, 4) && is_sprung(joint, 5);
  if (!has_spring_or_lock(3)) return tilts ? SpringTurn::swing : SpringTurn::apart;
  const bool one_tilt = is_sprung(joint, 4) || is_sprung(joint, 5);
  const bool whole = tilts || (one_tilt && is_sprung(joint, 3));
  return whole && has_spring_or_lock(4) && has_spring_or_lock(5) ? SpringTurn::whole
                                                                 : SpringTurn::apart;
}

bool acts_together(const JointRecord& joint, SpringTurn turn, std::size_t axis) {
  LKS_ASSERT(axis < k_joint_axes);
  if (turn == SpringTurn::apart || !is_sprung(joint, axis)) return false;
  return turn == SpringTurn::whole || axis != k_twist;
}

SpringTurnRows spring_turn_rows(const JointRecord& joint, SpringTurn turn,
                                const Quat& orientation_a, const Quat& orientation_b) {
  LKS_ASSERT(turn != SpringTurn::apart);
  const Quat target = multiply(multiply(orientation_a, joint.orientation_a), target_of(joint));
  const Quat frame_b = multiply(orientation_b, joint.orientation_b);
  if (turn == SpringTurn::swing) return swing_rows(to_matrix(target), to_matrix(frame_b));
  return whole_rows(multiply(conjugate(target), frame_b), to_matrix(frame_b));
}

}  // namespace lockstone
