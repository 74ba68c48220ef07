#include "core/dynamics/linkage/locks/loop_locks.h"

#include <algorithm>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/row_motion.h"

namespace lockstone {
namespace {

// Of times in a solve that motors are found to push harder than they may.
constexpr int k_most_bound_rounds = 3;

bool is_left_out(const LinkedJoint& joint, std::size_t row) {
  LKS_ASSERT(row < joint.rows.count);
  return (joint.left_out >> row & 1) != 0;
}

// Limits and springs, and motors that push as hard as they may; a bit for each row.
std::uint32_t rows_left_out(const JointRun& run, const LinkedJoint& joint) {
  static_assert(k_max_joint_rows <= 32);
  std::uint32_t bits = 0;
  LKS_ASSERT(joint.rows.locks <= joint.rows.count && joint.rows.count <= k_max_joint_rows);
  for (std::size_t r = joint.rows.locks; r < joint.rows.count; ++r) {
    const JointRow& row = joint.rows.rows[r];
    const JointDrive& drive = joint.drives[row.axis];
    bool is_out = row.kind != RowKind::drive || drive.is_spring();
    if (!is_out) {
      const std::int64_t total = joint.driven[row.axis] + joint.driven_later[row.axis];
      const std::int64_t speed_now = row_speed(run, joint, row);
      is_out = total >= drive.bound ? speed_now <= row.speed
                                    : total <= -drive.bound && speed_now >= row.speed;
    }
    if (is_out) bits |= std::uint32_t{1} << r;
  }
  return bits;
}

// The impulse that a row has had in this phase of the substep.
std::int64_t& total_impulse(LinkedJoint& joint, const JointRow& row, bool positions) {
  if (row.kind == RowKind::drive)
    return positions ? joint.driven[row.axis] : joint.driven_later[row.axis];
  return positions ? joint.locks[row.axis] : joint.relaxed[row.axis];
}

}  // namespace

LoopLocks::LoopLocks(JointSystem& system, std::size_t body_capacity, std::size_t joint_capacity,
                     bool enabled)
    : system_(system) {
  if (enabled) loops_ = std::make_unique<ProximalLocks>(body_capacity, joint_capacity);
}

void LoopLocks::clear() {
  if (loops_ != nullptr) loops_->clear();
}

bool LoopLocks::plan(JointGroup& group) {
  if (!may_fit(group)) return false;
  const std::span<const std::uint32_t> bodies = system_.bodies_of(group);
  LKS_ASSERT(group.body_count == bodies.size());
  for (std::uint32_t i = 0; i < bodies.size(); ++i)
    system_.bodies[bodies[i]].local = i;
  const auto end_of = [this](std::uint32_t index) -> ProximalLocks::End {
    const LinkedBody& body = system_.bodies[index];
    return {body.pushed ? body.local : ProximalLocks::End::k_unpushed,
            body.record->inverse_mass_value()};
  };
  loops_->begin_group();
  for (const std::uint32_t index : system_.joints_of(group))
    loops_->add_joint(end_of(system_.added[index].a), end_of(system_.added[index].b));
  group.loops = loops_->end_group(group.body_count);
  group.is_direct = group.has_solved_loops();
  return group.is_direct;
}

void LoopLocks::forget_impulses(const JointGroup& group, std::span<LinkedJoint> joints) {
  if (!group.has_solved_loops()) return;
  for (LinkedJoint& joint : joints) {
    joint.locks = joint.driven_later = {};
    for (std::size_t axis = 0; axis < k_joint_axes; ++axis)
      if (!joint.drives[axis].is_spring()) joint.driven[axis] = 0;
  }
}

// Returns whether any row comes in or goes.
bool LoopLocks::mark_left_out(const JointRun& run, const JointGroup& group) {
  bool changes = false;
  for (const std::uint32_t index : system_.joints_of(group)) {
    LinkedJoint& joint = system_.joints[index];
    const std::uint32_t bits = rows_left_out(run, joint);
    changes = changes || bits != joint.left_out;
    joint.left_out = bits;
  }
  return changes;
}

void LoopLocks::make_factor(const JointGroup& group, bool ahead) {
  LKS_ASSERT(group.has_solved_loops());
  const std::span<const std::uint32_t> bodies = system_.bodies_of(group);
  for (std::uint32_t i = 0; i < bodies.size(); ++i) {
    const LinkedBody& body = system_.bodies[bodies[i]];
    LKS_ASSERT(body.local == i);
    loops_->set_inertia(group.loops, i, ahead ? body.inertia_ahead : body.inverse_inertia);
  }
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    loops_->set_rows(group.loops, k, joint.rows.rows.first(joint.rows.count), joint.left_out);
  }
  loops_->factor(group.loops);
}

void LoopLocks::factor(const JointRun& run, JointGroup& group, bool ahead) {
  (void)mark_left_out(run, group);
  make_factor(group, ahead);
  system_.note_factor(group);
}

// Adds the errors of motors, and the compliance of all rows. Those of locks are there already.
void LoopLocks::complete_errors(const JointRun& run, const JointGroup& group, bool positions) {
  for (std::uint32_t k = 0; k < group.count; ++k) {
    LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    RowImpulses totals;
    for (std::size_t r = 0; r < joint.rows.count; ++r) {
      totals[r] = 0;
      if (is_left_out(joint, r)) continue;
      const JointRow& row = joint.rows.rows[r];
      LKS_ASSERT(row.kind != RowKind::limit);
      if (row.kind == RowKind::drive)
        errors(group, k)[r] = row_speed(run, joint, row) - bounded(row.speed, k_row_bound);
      totals[r] = total_impulse(joint, row, positions);
    }
    loops_->give(group.loops, k, totals);
  }
}

std::int64_t LoopLocks::motor_error(const JointRun& run, const JointGroup& group) const {
  std::int64_t greatest = 0;
  for (const std::uint32_t index : system_.joints_of(group)) {
    const LinkedJoint& joint = system_.joints[index];
    LKS_ASSERT(joint.rows.locks <= joint.rows.count);
    for (std::size_t r = joint.rows.locks; r < joint.rows.count; ++r) {
      const JointRow& row = joint.rows.rows[r];
      if (row.kind != RowKind::drive || is_left_out(joint, r)) continue;
      greatest = std::max(greatest,
                          std::abs(row_speed(run, joint, row) - bounded(row.speed, k_row_bound)));
    }
  }
  return greatest;
}

// Adds the present speeds of the rows to the errors (`sign` 1), or subtracts them (−1).
void LoopLocks::add_speeds(const JointRun& run, const JointGroup& group, int sign) {
  LKS_ASSERT(sign == 1 || sign == -1);
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    for (std::size_t r = 0; r < joint.rows.count; ++r) {
      if (is_left_out(joint, r)) continue;
      std::int64_t& error = errors(group, k)[r];
      error = bounded(error + sign * row_speed(run, joint, joint.rows.rows[r]), 2 * k_row_bound);
    }
  }
}

// The motor's impulse, as far as it may push.
std::int64_t LoopLocks::motor_impulse(const JointGroup& group, std::uint32_t place, std::size_t row,
                                      bool positions) {
  const LinkedJoint& joint = system_.joints[system_.joints_of(group)[place]];
  LKS_ASSERT(joint.rows.rows[row].kind == RowKind::drive);
  const std::uint8_t axis = joint.rows.rows[row].axis;
  const std::int64_t bound = joint.drives[axis].bound;
  const std::int64_t before = joint.driven[axis] + (positions ? 0 : joint.driven_later[axis]);
  return bounded(before + loops_->impulses(group.loops, place)[row], bound) - before;
}

// Motors that would have to push harder than they may push as hard as they may, and the other rows
// are solved again: impulses of locks against the whole push would turn the motor back. Returns
// whether there are such motors.
bool LoopLocks::bound_motors(const JointRun& run, const JointGroup& group, bool positions) {
  LKS_ASSERT(group.has_solved_loops());
  bool holds = false;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    for (std::size_t r = joint.rows.locks; r < joint.rows.count; ++r) {
      if (is_left_out(joint, r)) continue;
      const std::int64_t impulse = motor_impulse(group, k, r, positions);
      if (impulse == loops_->impulses(group.loops, k)[r]) continue;
      if (!holds) add_speeds(run, group, -1);
      holds = true;
      total_impulse(joint, joint.rows.rows[r], positions) += impulse;
      push(run, joint, r, impulse);
      joint.left_out |= std::uint32_t{1} << r;
    }
  }
  if (holds) add_speeds(run, group, 1);
  return holds;
}

void LoopLocks::apply(const JointRun& run, const JointGroup& group, bool positions) {
  for (std::uint32_t k = 0; k < group.count; ++k) {
    LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    const std::span<const std::int64_t> found = loops_->impulses(group.loops, k);
    RowImpulses impulses{};
    for (std::size_t r = 0; r < joint.rows.count; ++r) {
      if (is_left_out(joint, r)) continue;
      const JointRow& row = joint.rows.rows[r];
      impulses[r] = row.kind == RowKind::drive ? motor_impulse(group, k, r, positions) : found[r];
      std::int64_t& total = total_impulse(joint, row, positions);
      total = bounded(total + impulses[r], k_product_bound);
    }
    push(run, joint, 0, joint.rows.count, impulses);
  }
}

void LoopLocks::solve(const JointRun& run, JointGroup& group, bool positions) {
  LKS_ASSERT(group.has_solved_loops());
  if (mark_left_out(run, group) || !system_.has_factor(group)) factor(run, group, false);
  complete_errors(run, group, positions);
  loops_->solve(group.loops);
  for (int i = 0; i < k_most_bound_rounds && bound_motors(run, group, positions); ++i) {
    make_factor(group, false);
    loops_->solve(group.loops);
  }
  apply(run, group, positions);
}

}  // namespace lockstone
