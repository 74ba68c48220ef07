#include "core/dynamics/linkage/system/linked_joint.h"

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/product_sum.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

MassShare mass_share(BlockFloat part, BlockFloat whole) {
  if (part.mantissa == 0) return {};
  const int distance = whole.exponent - part.exponent;
  if (distance > 60) return {};
  LKS_ASSERT(distance >= 0);
  // Below 2^32: both mantissas lie in [2^30, 2^31).
  const std::int64_t mantissa =
      raw::round_divide(std::int64_t{part.mantissa} << 31, whole.mantissa);
  LKS_ASSERT(mantissa >> 32 == 0);
  const int more = MassShare::k_shift - 31 - distance;
  if (more < 0) return {mantissa, 31 + distance};
  return {mantissa << more, MassShare::k_shift};
}

// `from`, turned in its own axes by angles of Q32 radians.
Quat turned_by(const Quat& from, const RotationVector& by) {
  return normalized(multiply(from, rotation_from_vector(by)));
}

}  // namespace

JointFrames frames_of(const JointRecord& joint, const TimeStep& step, std::int32_t substeps_left) {
  LKS_ASSERT(substeps_left >= 0 && substeps_left <= step.substeps);
  Quat a = joint.orientation_a;
  if (locks_turning(joint)) {
    RotationVector target, left;
    for (int i = 0; i < 3; ++i) {
      const JointAxisRecord& axis = joint.axes[static_cast<std::size_t>(i) + 3];
      target[i].raw = std::int64_t{axis.target} * 32;
      const std::int64_t way = std::int64_t{axis.speed} * substeps_left * (1 << 12);
      left[i].raw = raw::round_divide(-way, step.substep_rate());
    }
    if (target != RotationVector{} || left != RotationVector{})
      a = turned_by(turned_by(a, target), left);
  }
  return {to_matrix(a), to_matrix(joint.orientation_b)};
}

std::uint64_t list_rows(const JointRows& rows) {
  static_assert(5 * k_max_joint_rows < 64);
  LKS_ASSERT(rows.locks <= rows.count && rows.count <= rows.rows.size());
  std::uint64_t list = 1;
  for (const JointRow& row : rows.rows.first(rows.count))
    list = list << 5 | static_cast<std::uint64_t>(row.kind) << 3 | row.axis;
  return list;
}

void set_masses(LinkedJoint& joint, const LinkedBody& a, const LinkedBody& b) {
  const JointRecord& record = *joint.record;
  const BlockFloat inverse_a = a.record->inverse_mass_value(),
                   inverse_b = b.record->inverse_mass_value();
  joint.solver_a = a.solver;
  joint.solver_b = b.solver;
  joint.inverse_mass = add(inverse_a, inverse_b);
  joint.share_a = mass_share(inverse_a, joint.inverse_mass);
  joint.share_b = mass_share(inverse_b, joint.inverse_mass);
  joint.exponent = angular_exponent(*a.record, *b.record);
  LKS_ASSERT(joint.share_a.mantissa >= 0 && joint.share_b.mantissa >= 0);
  joint.lever_a = size_of(record.anchor_a);
  joint.lever_b = size_of(record.anchor_b);
}

void load_impulses(LinkedJoint& joint, int shift) {
  LKS_ASSERT(shift == 29 || shift == 30);
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    const JointAxisRecord& axis = joint.record->axes[i];
    joint.locks[i] = std::int64_t{axis.impulse.raw} * (1 << shift);
    joint.relaxed[i] = 0;
    joint.driven[i] = std::int64_t{axis.drive_impulse.raw} * (1 << 30);
    if (joint.drives[i].is_spring())
      joint.driven[i] = product_rounded(joint.driven[i], joint.drives[i].before.share, 30);
  }
}

void store_impulses(const LinkedJoint& joint, bool moves_first, JointRecord& record) {
  const auto to_record = [](std::int64_t impulse) {
    return SolverVelocity::from_raw(raw::saturate<std::int32_t>(raw::round_shift(impulse, 30)));
  };
  record.energy_gained = joint.energy_gained;
  if (joint.turns_locks)
    for (std::size_t i = 3; i < k_joint_axes; ++i)
      record.axes[i].speed = 0;
  for (JointAxisRecord& axis : record.axes)
    axis.impulse = axis.drive_impulse = {};
  for (std::size_t i = 0; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    LKS_ASSERT(row.axis < k_joint_axes);
    JointAxisRecord& axis = record.axes[row.axis];
    if (row.kind == RowKind::drive) {
      axis.drive_impulse = to_record(joint.driven[row.axis] + joint.driven_later[row.axis]);
    } else {
      axis.impulse = to_record(bounded(joint.locks[row.axis] + joint.relaxed[row.axis] +
                                           (moves_first ? joint.carried[row.axis] : 0),
                                       k_product_bound));
    }
  }
}

bool only_locks(const JointRecord& joint) {
  if (turns_locks(joint)) return false;
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    const JointAxisRecord& axis = joint.axes[i];
    if (axis.is_driven()) return false;
    if (joint.mode(i) == AxisMode::limited && axis.lower != axis.upper) return false;
  }
  return true;
}

}  // namespace lockstone
