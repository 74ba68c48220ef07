// Groups of joints with loops, as `ProximalLocks` solves them.

#include <algorithm>
#include <cstdlib>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"

namespace lockstone {
namespace {

// Of times in a solve that motors are found to push harder than they may.
constexpr int k_most_holds = 3;

}  // namespace

// Its joints are links yet. A tree has as many joints as bodies that are pushed, or one less if no
// joint holds it to another body; loops may go through such a body.
bool JointSolver::has_loops(const Group& group) const {
  const auto hangs = [this](std::uint32_t link) {
    return !bodies_[links_[link].a].pushed || !bodies_[links_[link].b].pushed;
  };
  const bool is_hung = std::ranges::any_of(joints_of(group), hangs);
  return group.count >= group.body_count + (is_hung ? 1 : 0);
}

// Links yet, as above. A motor pushes as well as locks do, and has a solution along with them.
bool JointSolver::has_motors(const Group& group) const {
  return std::ranges::any_of(joints_of(group), [this](std::uint32_t link) {
    return std::ranges::any_of(links_[link].record->axes, [](const JointAxisRecord& axis) {
      return axis.is_driven() && !axis.is_spring();
    });
  });
}

// Whether contacts press links that are pulled hard. There locks that hold exactly turn errors of
// contacts into energy: ropes about posts flew apart.
bool JointSolver::is_pressed(const Group& group) const {
  bool touches = false, pulled = false;
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const Body& body = bodies_[group_bodies_[group.first_body + i]];
    touches = touches || body.touches;
    pulled = pulled || body.pulled;
  }
  return touches && pulled;
}

bool JointSolver::plan_loops(Group& group) {
  for (std::uint32_t i = 0; i < group.body_count; ++i)
    bodies_[group_bodies_[group.first_body + i]].local = i;
  const auto end_of = [this](std::uint32_t index) -> ProximalLocks::End {
    const Body& body = bodies_[index];
    return {body.pushed ? body.local : ProximalLocks::End::k_unpushed,
            body.record->inverse_mass_value()};
  };
  loops_->begin_group();
  for (const std::uint32_t index : joints_of(group))
    loops_->add_joint(end_of(links_[index].a), end_of(links_[index].b));
  group.loops = loops_->end_group(group.body_count);
  group.exact = has_solved_loops(group);
  return group.exact;
}

// At the beginning of a substep. Impulses of the last one that rows of loops hold against each
// other would turn with the bodies, and grow: locks and motors begin with none.
void JointSolver::forget_impulses(const Cluster& cluster) {
  if (!has_solved_loops(groups_of(cluster)[0])) return;
  for (Joint& joint : joints_of(cluster)) {
    joint.locks = joint.driven_later = {};
    for (std::size_t axis = 0; axis < k_joint_axes; ++axis)
      if (!joint.drives[axis].is_spring()) joint.driven[axis] = 0;
  }
}

// Limits and springs, which are solved one by one, and motors that push as hard as they may.
std::uint32_t JointSolver::rows_left_out(const JointRun& run, const Joint& joint) const {
  std::uint32_t bits = 0;
  for (std::size_t r = joint.rows.locks; r < joint.rows.count; ++r) {
    const JointRow& row = joint.rows.rows[r];
    const Drive& drive = joint.drives[row.axis];
    bool is_out = row.kind != RowKind::drive || drive.is_spring();
    if (!is_out) {
      const std::int64_t total = joint.driven[row.axis] + joint.driven_later[row.axis];
      const std::int64_t speed_now = speed(run, joint, row);
      is_out = total >= drive.bound ? speed_now <= row.speed
                                    : total <= -drive.bound && speed_now >= row.speed;
    }
    if (is_out) bits |= std::uint32_t{1} << r;
  }
  return bits;
}

// Returns whether any row comes in or goes.
bool JointSolver::mark_left_out(const JointRun& run, const Group& group) {
  bool changes = false;
  for (const std::uint32_t index : joints_of(group)) {
    Joint& joint = joints_[index];
    const std::uint32_t bits = rows_left_out(run, joint);
    changes = changes || bits != joint.left_out;
    joint.left_out = bits;
  }
  return changes;
}

void JointSolver::factor_loops(Group& group, bool ahead) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const Body& body = bodies_[group_bodies_[group.first_body + i]];
    loops_->set_inertia(group.loops, i, ahead ? body.inertia_ahead : body.inverse_inertia);
  }
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    loops_->set_rows(group.loops, k, joint.rows.rows.first(joint.rows.count), joint.left_out);
  }
  loops_->factor(group.loops);
}

std::int64_t& JointSolver::loop_impulse(Joint& joint, const JointRow& row, bool positions) {
  if (row.kind == RowKind::drive)
    return positions ? joint.driven[row.axis] : joint.driven_later[row.axis];
  return positions ? joint.locks[row.axis] : joint.relaxed[row.axis];
}

// The errors of locks are there already, except for their compliance.
void JointSolver::find_loop_errors(const JointRun& run, const Group& group, bool positions) {
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Joint& joint = joints_[joints_of(group)[k]];
    for (std::size_t r = 0; r < joint.rows.count; ++r) {
      if ((joint.left_out >> r & 1) != 0) continue;
      const JointRow& row = joint.rows.rows[r];
      if (row.kind == RowKind::drive)
        loops_->errors(group.loops, k)[r] =
            bounded(speed(run, joint, row), k_row_bound) - bounded(row.speed, k_row_bound);
      loops_->give(group.loops, k, r, loop_impulse(joint, row, positions));
    }
  }
}

// The greatest error of the speed of a motor that does not push as hard as it may, Q50.
std::int64_t JointSolver::motor_error(const JointRun& run, const Group& group) const {
  std::int64_t greatest = 0;
  for (const std::uint32_t index : joints_of(group)) {
    const Joint& joint = joints_[index];
    for (std::size_t r = joint.rows.locks; r < joint.rows.count; ++r) {
      const JointRow& row = joint.rows.rows[r];
      if (row.kind != RowKind::drive || (joint.left_out >> r & 1) != 0) continue;
      greatest =
          std::max(greatest, std::abs(speed(run, joint, row) - bounded(row.speed, k_row_bound)));
    }
  }
  return greatest;
}

// Adds the present speeds of the rows to the errors (`sign` 1), or subtracts them (−1).
void JointSolver::add_loop_speeds(const JointRun& run, const Group& group, int sign) {
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    for (std::size_t r = 0; r < joint.rows.count; ++r) {
      if ((joint.left_out >> r & 1) != 0) continue;
      std::int64_t& error = loops_->errors(group.loops, k)[r];
      const std::int64_t now = bounded(speed(run, joint, joint.rows.rows[r]), k_row_bound);
      error = bounded(error + sign * now, 2 * k_row_bound);
    }
  }
}

// The motor's impulse, as far as it may push.
std::int64_t JointSolver::motor_impulse(const Group& group, std::uint32_t place, std::size_t row,
                                        bool positions) {
  const Joint& joint = joints_[joints_of(group)[place]];
  const std::uint8_t axis = joint.rows.rows[row].axis;
  const std::int64_t bound = joint.drives[axis].bound;
  const std::int64_t before = joint.driven[axis] + (positions ? 0 : joint.driven_later[axis]);
  return bounded(before + loops_->impulse(group.loops, place, row), bound) - before;
}

// Motors that would have to push harder than they may push as hard as they may, and the other rows
// are solved again: impulses of locks against the whole push would turn the motor back. Returns
// whether there are such motors.
bool JointSolver::hold_motors(const JointRun& run, const Group& group, bool positions) {
  bool holds = false;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Joint& joint = joints_[joints_of(group)[k]];
    for (std::size_t r = joint.rows.locks; r < joint.rows.count; ++r) {
      if ((joint.left_out >> r & 1) != 0) continue;
      const std::int64_t impulse = motor_impulse(group, k, r, positions);
      if (impulse == loops_->impulse(group.loops, k, r)) continue;
      if (!holds) add_loop_speeds(run, group, -1);
      holds = true;
      loop_impulse(joint, joint.rows.rows[r], positions) += impulse;
      push(run, joint, r, impulse);
      joint.left_out |= std::uint32_t{1} << r;
    }
  }
  if (holds) add_loop_speeds(run, group, 1);
  return holds;
}

void JointSolver::push_loops(const JointRun& run, const Group& group, bool positions) {
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Joint& joint = joints_[joints_of(group)[k]];
    RowImpulses impulses{};
    for (std::size_t r = 0; r < joint.rows.count; ++r) {
      if ((joint.left_out >> r & 1) != 0) continue;
      const JointRow& row = joint.rows.rows[r];
      impulses[r] = row.kind == RowKind::drive ? motor_impulse(group, k, r, positions)
                                               : loops_->impulse(group.loops, k, r);
      std::int64_t& total = loop_impulse(joint, row, positions);
      total = bounded(total + impulses[r], k_product_bound);
    }
    push(run, joint, 0, joint.rows.count, impulses);
  }
}

// Takes away the errors of locks and of motors, as far as one solve does.
void JointSolver::solve_loops(const JointRun& run, Group& group, bool positions) {
  if (mark_left_out(run, group) || !has_factor(group)) factor(run, group, false);
  find_loop_errors(run, group, positions);
  loops_->solve(group.loops);
  for (int i = 0; i < k_most_holds && hold_motors(run, group, positions); ++i) {
    factor_loops(group, false);
    loops_->solve(group.loops);
  }
  push_loops(run, group, positions);
}

}  // namespace lockstone
