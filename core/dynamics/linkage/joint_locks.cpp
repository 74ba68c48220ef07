// The locks of a group of joints: positions, then velocities.

#include <algorithm>
#include <array>
#include <cstdlib>
#include <optional>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// Of solves for positions in a substep.
constexpr int k_position_solves = 3;
constexpr int k_most_passes = 8;
constexpr int k_most_solves = 12;

// Locks that are open by less, m, Q32, are closed: 1 µm.
constexpr std::int64_t k_closed = 1 << 12;

// Where they are left open by more than 2 mm, the method has failed.
constexpr std::int64_t k_lost = 1 << 23;

// Openings that rounding leaves: 4 nm.
constexpr std::int64_t k_rounding = 16;

// Where there are limits or drives: 15 nm. After one step most openings lie between both.
constexpr std::int64_t k_pushed_rounding = 64;

// Openings that ropes and chains may leave: 30 nm, as much as rounding of spin does at an arm of 1
// m.
constexpr std::int64_t k_noise = 128;

// Openings whose squares fit, 0.25 m.
constexpr std::int64_t k_far = std::int64_t{1} << 30;

// Joints of groups without a direct solve close this part of an opening in a substep.
constexpr int k_close_shift = 2;

// x · mass · 2^shift within ±k_row_bound
std::int64_t times_mass(std::int64_t x, BlockFloat mass, int shift) {
  const int right = -shift - mass.exponent;
  if (right >= 1 && right <= 125) return product_rounded(x, mass.mantissa, right);
  return bounded(scale_saturating(x, mass, shift), k_row_bound);
}

}  // namespace

// Locks as they will be after the substep as it stands: Newton's step needs their directions there.
void JointSolver::look_ahead(const JointRun& run, Group& group, bool turn) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const std::uint32_t body = group_bodies_[group.first_body + i];
    after_[body] = pose_after(run, bodies_[body]);
    if (bodies_[body].solver == 0) continue;
    bodies_[body].looked = run.rows[bodies_[body].solver];
    bodies_[body].has_looked = true;
  }
  std::optional<std::array<JointRow, k_max_joint_rows>> rows;  // where there is more than points
  for (const std::uint32_t index : joints_of(group)) {
    Joint& joint = joints_[index];
    const JointPlace place = place_of(joint, after_[joint.a], after_[joint.b]);
    if (!turn && joint.rows.is_point && joint.rows.locks == 3) {
      const RawVec3 gap = point_gap(place);
      for (std::size_t r = 0; r < 3; ++r)
        joint.rows.rows[r].error = gap[r];
      continue;
    }
    if (!rows) rows.emplace();
    JointRows ahead{*rows};
    fill_rows(place, turn ? RowParts::locks : RowParts::lock_errors, ahead);
    if (ahead.locks != joint.rows.locks) continue;
    if (!turn) {
      for (std::size_t r = 0; r < joint.rows.locks; ++r)
        joint.rows.rows[r].error = ahead.rows[r].error;
      continue;
    }
    std::copy_n(ahead.rows.begin(), ahead.locks, joint.rows.rows.begin());
    respond(joint, joint.rows.locks, true);
  }
  if (!turn) return;
  if (has_solved_loops(group)) {
    (void)mark_left_out(run, group);
    return factor_loops(group, true);
  }
  factor_group(group);
}

// Where the right-hand side of a joint's locks stands, by its place in the group.
std::int64_t* JointSolver::errors_at(const Group& group, std::uint32_t joint) {
  if (has_solved_loops(group)) return loops_->errors(group.loops, joint).data();
  return &factor_.rhs(factor_.columns(group.column, group.count)[joint].first_row);
}

// Sets the errors to the speeds that close the openings left after the substep as it stands.
// Returns the widest opening, Q32.
std::int64_t JointSolver::set_position_errors(const Group& group) {
  std::int64_t widest = 0;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    if (joint.rows.locks == 0) continue;
    std::int64_t* errors = errors_at(group, k);
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      const std::int64_t error = joint.rows.rows[r].error - joint.left_open[r];
      widest = std::max(widest, std::abs(error));
      errors[r] = bounded(closing_speed(error, group.rate), k_row_bound);
    }
  }
  return widest;
}

// Returns the greatest of them, Q50.
std::int64_t JointSolver::set_speed_errors(const JointRun& run, const Group& group,
                                           bool positions) {
  std::int64_t greatest = 0;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    if (joint.rows.locks == 0) continue;
    std::int64_t* errors = errors_at(group, k);
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      const JointRow& row = joint.rows.rows[r];
      std::int64_t error = speed(run, joint, row);
      if (positions) {
        error += bounded(closing_speed(row.error, step_.substep_rate(), k_close_shift),
                         k_close_speed / 2);
      }
      greatest = std::max(greatest, std::abs(error));
      errors[r] = error;
    }
  }
  return greatest;
}

// Velocities such that locks hold after the substep: impulses along the directions that locks have
// now, as RATTLE wants them, while that converges. Where links swing fast it does not, and Newton's
// method with the directions after the substep takes its place.
void JointSolver::solve_positions(const JointRun& run, Group& group) {
  save(run, group);
  if (find_positions(run, group) <= k_lost) return;
  restore(run, group);
  hold_roughly(run, group);
  group.is_rough = true;
}

// Returns the widest opening that is left.
std::int64_t JointSolver::find_positions(const JointRun& run, Group& group) {
  if (has_solved_loops(group)) {
    close_loops(run, group);
  } else {
    if (!is_stiff(group)) {
      if (close(run, group)) return 0;
      restore(run, group);
    }
    for (int i = 0; i < k_most_solves; ++i) {
      const std::int64_t widest = approach(run, group, 0, true);
      if (i + 1 >= k_position_solves && widest <= k_closed) return 0;
    }
  }
  look_ahead(run, group, false);
  return set_position_errors(group);
}

// Where the method does not converge: velocities such that locks do not open, and close by a
// quarter of their openings. A projection, which gives no energy but for that.
void JointSolver::hold_roughly(const JointRun& run, Group& group) {
  for (const std::uint32_t index : joints_of(group))
    linearize(joints_[index]);
  group.is_factored = false;
  set_speed_errors(run, group, true);
  solve_locks(run, group, true);
}

// One step of the method, unless no opening is wider than `enough`. Returns the widest before it.
std::int64_t JointSolver::approach(const JointRun& run, Group& group, std::int64_t enough,
                                   bool turn) {
  look_ahead(run, group, turn);
  const std::int64_t widest = set_position_errors(group);
  if (widest > enough) solve_locks(run, group, true);
  return widest;
}

// Returns whether all locks hold afterwards. Each step leaves about the same part of an opening:
// once the next step would leave less than rounding does, the check after it is skipped. Where
// bodies are pulled hard, every step is taken, or swings that the substep hardly resolves grow
// unseen.
bool JointSolver::close(const JointRun& run, Group& group) {
  const bool pulled = is_pulled(group);
  const std::int64_t enough = pulled ? 0 : group.is_plain ? k_rounding : k_pushed_rounding;
  const std::int64_t expected = pulled ? 0 : group.is_plain ? k_noise : k_pushed_rounding;
  const int solves = pulled && !group.drifts ? k_position_solves : k_most_passes;
  std::int64_t before = 0;
  for (int i = 0; i < solves; ++i) {
    const std::int64_t widest = approach(run, group, enough, false);
    if (widest <= enough) return true;
    const bool falls = 2 * widest <= before;
    if (falls && widest <= k_far && widest * widest <= expected * before) return true;
    if (i + 1 >= k_position_solves && !falls) break;
    before = widest;
  }
  look_ahead(run, group, false);
  return set_position_errors(group) <= k_closed;
}

bool JointSolver::is_stiff(const Group& group) const {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    if (bodies_[group_bodies_[group.first_body + i]].least_inertia > 0) return true;
  }
  return false;
}

bool JointSolver::is_pulled(const Group& group) const {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    if (bodies_[group_bodies_[group.first_body + i]].pulled) return true;
  }
  return false;
}

void JointSolver::save(const JointRun& run, const Group& group) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    Body& body = bodies_[group_bodies_[group.first_body + i]];
    body.saved_row = run.rows[body.solver];
  }
  for (const std::uint32_t index : joints_of(group))
    joints_[index].saved = joints_[index].locks;
}

void JointSolver::restore(const JointRun& run, const Group& group) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const Body& body = bodies_[group_bodies_[group.first_body + i]];
    run.rows[body.solver] = body.saved_row;
  }
  for (const std::uint32_t index : joints_of(group))
    joints_[index].locks = joints_[index].saved;
}

// Solves for the errors that stand on the right-hand side, and pushes.
void JointSolver::solve_locks(const JointRun& run, Group& group, bool positions) {
  if (has_solved_loops(group)) return solve_loops(run, group, positions);
  if (!group.is_factored) factor_group(group);
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    for (std::uint32_t r = 0; r < joint.rows.locks; ++r) {
      std::int64_t& rhs = factor_.rhs(columns[k].first_row + r);
      const int shift = 4 + joint.solved[r].exponent - group.exponent;
      rhs = raw::round_shift(-rhs, std::min(shift, 62));
    }
  }
  factor_.solve(group.column, group.count);
  const bool later = group.exact && !positions;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Joint& joint = joints_[joints_of(group)[k]];
    RowImpulses impulses;
    for (std::uint32_t r = 0; r < joint.rows.locks; ++r) {
      const int shift = 4 - joint.solved[r].exponent - group.exponent;
      const std::int64_t solved = factor_.rhs(columns[k].first_row + r);
      impulses[r] = times_mass(solved, joint.inverse_mass, shift);
      const std::uint8_t axis = joint.rows.rows[r].axis;
      std::int64_t& total = later ? joint.relaxed[axis] : joint.locks[axis];
      total = bounded(total + impulses[r], k_product_bound);
    }
    push(run, joint, 0, joint.rows.locks, impulses);
  }
}

}  // namespace lockstone
