#include "core/dynamics/linkage/island_joints.h"

#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/joint_drives.h"
#include "core/dynamics/linkage/rows/row_motion.h"

namespace lockstone {

IslandJoint IslandJoints::joint(std::uint32_t index) const {
  LKS_ASSERT(index < system_.joints.size());
  const LinkedJoint& joint = system_.joints[index];
  const LinkedBody &a = system_.bodies[joint.a], &b = system_.bodies[joint.b];
  const BlockFloat inverse_a = a.record->inverse_mass_value(),
                   inverse_b = b.record->inverse_mass_value();
  IslandJoint result;
  result.joint = index;
  result.a = a.pushed ? a.solver : 0;
  result.b = b.pushed ? b.solver : 0;
  if (result.a != 0) result.part_a = part_of(ratio(inverse_a, inverse_b).raw);
  if (result.b != 0) result.part_b = part_of(ratio(inverse_b, inverse_a).raw);
  result.inverse_mass = joint.inverse_mass;
  return result;
}

void IslandJoints::put_among_contacts(std::uint32_t joint) {
  system_.bodies[system_.joints[joint].a].is_among_contacts = true;
  system_.bodies[system_.joints[joint].b].is_among_contacts = true;
}

std::int64_t IslandJoints::speed(const JointRun& run, std::uint32_t joint, std::size_t row) const {
  return row_speed(run, system_.joints[joint], rows(joint)[row]);
}

std::int64_t IslandJoints::limit_speed(const JointRow& row, bool positions) const {
  return lockstone::limit_speed(system_.step, row, positions);
}

std::int64_t IslandJoints::limit_impulse(std::uint32_t index, std::size_t row) const {
  const LinkedJoint& joint = system_.joints[index];
  const JointRow& limit = joint.rows.rows[row];
  LKS_ASSERT(limit.kind == RowKind::limit);
  const std::int64_t stored = joint.locks[limit.axis];
  return std::max<std::int64_t>(limit.flipped ? -stored : stored, 0);
}

void IslandJoints::give(const JointRun& run, std::uint32_t index, const RowImpulses& impulses) {
  LinkedJoint& joint = system_.joints[index];
  std::size_t end = 0;
  for (std::size_t i = 0; i < joint.rows.count; ++i) {
    if (impulses[i] == 0) continue;
    const JointRow& row = joint.rows.rows[i];
    LKS_ASSERT(row.kind != RowKind::drive);  // the problem has locks and limits
    std::int64_t& total = joint.locks[row.axis];
    total = bounded(total + (row.flipped ? -impulses[i] : impulses[i]), k_product_bound);
    end = std::max<std::size_t>(i + 1, joint.rows.locks);
  }
  if (end == 0) return;
  const std::array<std::uint32_t, 2> ends = {joint.a, joint.b};
  begin_pushes(run, system_, ends);
  push(run, joint, 0, end, impulses);
  end_pushes(run, system_, ends);
}

}  // namespace lockstone
