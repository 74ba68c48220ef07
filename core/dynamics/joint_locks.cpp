// The locks of a group of joints: positions, then velocities.

#include <algorithm>
#include <cstdlib>

#include "core/dynamics/joint_numbers.h"
#include "core/dynamics/joint_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// Of solves for positions in a substep.
constexpr int k_position_solves = 3;

// Locks that are open by less, m, Q32, are closed: 1 µm.
constexpr std::int64_t k_closed = 1 << 12;

// Joints of groups that are not solved at once close this part of an opening a substep.
constexpr int k_close_shift = 2;

}  // namespace

// Locks as they will be after the substep as it stands: Newton's step needs their directions there.
void JointSolver::look_ahead(const JointRun& run, Group& group, bool turn) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const std::uint32_t body = group_bodies_[group.first_body + i];
    after_[body] = pose_after(run, bodies_[body]);
  }
  for (const std::uint32_t index : joints_of(group)) {
    Joint& joint = joints_[index];
    fill_rows(place_of(joint, after_[joint.a], after_[joint.b]), scratch_);
    if (scratch_.locks != joint.rows.locks) continue;
    if (!turn) {
      for (std::size_t r = 0; r < joint.rows.locks; ++r)
        joint.rows.rows[r].error = scratch_.rows[r].error;
      continue;
    }
    std::copy_n(scratch_.rows.begin(), scratch_.locks, joint.rows.rows.begin());
    respond(joint, joint.rows.locks, true);
  }
  if (turn) factor_group(group);
}

// What is left open after the substep as it stands, per substep.
void JointSolver::set_position_errors(const Group& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      factor_.rhs(columns[k].first_row + static_cast<std::uint32_t>(r)) =
          bounded(closing_speed(joint.rows.rows[r].error, step_.substep_rate()), k_close_speed);
    }
  }
}

void JointSolver::set_speed_errors(const JointRun& run, const Group& group, bool positions) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      const JointRow& row = joint.rows.rows[r];
      std::int64_t error = speed(run, joint, row);
      if (positions) {
        error += bounded(closing_speed(row.error, step_.substep_rate(), k_close_shift),
                         k_close_speed / 2);
      }
      factor_.rhs(columns[k].first_row + static_cast<std::uint32_t>(r)) = error;
    }
  }
}

// Velocities such that locks hold after the substep: impulses along the directions that locks have
// now, as RATTLE wants them, while that converges. Where links swing fast it does not, and Newton's
// method with the directions after the substep takes its place.
void JointSolver::solve_positions(const JointRun& run, Group& group) {
  if (!is_stiff(group)) {
    save(run, group);
    for (int i = 0; i < k_position_solves; ++i) {
      look_ahead(run, group, false);
      set_position_errors(group);
      solve_locks(run, group, true);
    }
    look_ahead(run, group, false);
    if (is_closed(group)) return;
    restore(run, group);
  }
  for (int i = 0; i < k_position_solves; ++i) {
    look_ahead(run, group, true);
    set_position_errors(group);
    solve_locks(run, group, true);
  }
}

bool JointSolver::is_closed(const Group& group) const {
  for (const std::uint32_t index : joints_of(group)) {
    const Joint& joint = joints_[index];
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      if (std::abs(joint.rows.rows[r].error) > k_closed) return false;
    }
  }
  return true;
}

bool JointSolver::is_stiff(const Group& group) const {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    if (bodies_[group_bodies_[group.first_body + i]].least_inertia > 0) return true;
  }
  return false;
}

void JointSolver::save(const JointRun& run, const Group& group) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    Body& body = bodies_[group_bodies_[group.first_body + i]];
    body.saved_row = run.rows[body.solver];
    body.saved_before = run.before[body.solver];
  }
  for (const std::uint32_t index : joints_of(group))
    joints_[index].saved = joints_[index].locks;
}

void JointSolver::restore(const JointRun& run, const Group& group) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const Body& body = bodies_[group_bodies_[group.first_body + i]];
    run.rows[body.solver] = body.saved_row;
    run.before[body.solver] = body.saved_before;
  }
  for (const std::uint32_t index : joints_of(group))
    joints_[index].locks = joints_[index].saved;
}

// Solves for the errors that stand on the right-hand side, and pushes.
void JointSolver::solve_locks(const JointRun& run, Group& group, bool positions) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const auto for_each_row = [&](auto&& f) {
    for (std::uint32_t k = 0; k < group.count; ++k) {
      Joint& joint = joints_[joints_of(group)[k]];
      for (std::uint32_t r = 0; r < joint.rows.locks; ++r)
        f(joint, r, factor_.rhs(columns[k].first_row + r));
    }
  };
  for_each_row([&](const Joint& joint, std::size_t r, std::int64_t& rhs) {
    const int shift = 4 + joint.solved[r].exponent - group.exponent;
    rhs = raw::round_shift(-rhs, std::min(shift, 62));
  });
  factor_.solve(group.column, group.count);
  for_each_row([&](Joint& joint, std::size_t r, std::int64_t& rhs) {
    const int shift = 4 - joint.solved[r].exponent - group.exponent;
    const JointRow& row = joint.rows.rows[r];
    const std::int64_t impulse =
        bounded(scale_saturating(rhs, joint.inverse_mass, shift), k_row_bound);
    const bool later = group.exact && !positions;
    std::int64_t& total = later ? joint.relaxed[row.axis] : joint.locks[row.axis];
    total = bounded(total + impulse, k_product_bound);
    push(run, joint, row, impulse);
  });
}

}  // namespace lockstone
