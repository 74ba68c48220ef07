// The locks of a group of joints: positions, then velocities.

#include <algorithm>
#include <array>
#include <cstdlib>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// Of solves for positions in a substep: as many in any case where the opening does not fall; of a
// tree, or with directions after the substep; of loops, as long as locks are open by 1 mm, Q32.
constexpr int k_position_solves = 3;
constexpr int k_most_passes = 8;
constexpr int k_most_solves = 12;
constexpr std::int64_t k_nearly_closed = 1 << 22;

// Of solves for velocities; and of those while a factor of earlier rows leaves more than 60 nm/s,
// of loops 8 µm/s, Q50.
constexpr int k_velocity_solves = 2, k_most_velocity_solves = 5;
constexpr std::int64_t k_slow_tree = std::int64_t{1} << 26, k_slow_loop = std::int64_t{1} << 33;

// Locks that open more slowly stand still, m/s, Q50: a step of Velocity, 0.23 nm/s.
constexpr std::int64_t k_still = std::int64_t{1} << 18;

// A factor of earlier rows serves while each solve leaves less than 2^-this of the error. Factors
// of loops are dear; trees may swing wildly.
constexpr int k_tree_fall_bits = 8, k_loop_fall_bits = 5;

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

// Whether a lock is open by more than a good step leaves.
bool is_open(const JointRows& rows) {
  return std::ranges::any_of(rows.rows.first(rows.locks),
                             [](const JointRow& row) { return std::abs(row.error) > k_lost; });
}

}  // namespace

// Locks as they will be after the substep as it stands; with `turn` also their directions there.
void JointSolver::look_ahead(const JointRun& run, Group& group, bool turn) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    const std::uint32_t index = group_bodies_[group.first_body + i];
    Body& body = bodies_[index];
    const lanes::RowBody& row = run.rows[body.solver];
    if (body.has_looked && is_alike(row, body.looked)) continue;
    after_[index] = pose_after(run, body);
    body.looked = row;
    body.has_looked = body.solver != 0;
  }
  for (const std::uint32_t index : joints_of(group)) {
    Joint& joint = joints_[index];
    const JointPlace place = place_of(joint, after_[joint.a], after_[joint.b]);
    if (!turn && joint.rows.is_point && joint.rows.locks == 3) {
      const RawVec3 gap = point_gap(place);
      for (std::size_t r = 0; r < 3; ++r)
        joint.rows.rows[r].error = gap[r];
      continue;
    }
    if (!turn) {
      const LockErrors ahead = lock_errors(place);
      for (std::size_t r = 0; r < ahead.count && ahead.count == joint.rows.locks; ++r)
        joint.rows.rows[r].error = ahead.errors[r];
      continue;
    }
    std::array<JointRow, k_joint_axes> rows;
    JointRows ahead{rows};
    fill_rows(place, RowParts::locks, ahead);
    if (ahead.locks != joint.rows.locks) continue;
    std::copy_n(ahead.rows.begin(), ahead.locks, joint.rows.rows.begin());
    respond(joint, joint.rows.locks, true);
  }
  if (turn) group.is_fresh = false;
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
// method with the directions after the substep takes its place. Where locks were open already, the
// result counts only if it takes no more energy to close them than it may.
void JointSolver::solve_positions(const JointRun& run, const Cluster& cluster, Group& group) {
  save(run, group);
  const bool was_open = std::ranges::any_of(
      joints_of(group), [this](std::uint32_t index) { return is_open(joints_[index].rows); });
  const bool holds = find_positions(run, group) <= k_lost;
  if (holds && !(was_open && closes_too_fast(run, cluster))) return;
  restore(run, group);
  hold_roughly(run, cluster, group);
  group.is_rough = true;
}

// Returns the widest opening that is left.
std::int64_t JointSolver::find_positions(const JointRun& run, Group& group) {
  if (is_stiff(group)) return close(run, group, true);
  const std::int64_t widest = close(run, group, false);
  if (widest <= k_closed || has_solved_loops(group)) return widest;
  restore(run, group);
  return close(run, group, true);
}

// Where the method does not converge: velocities such that locks do not open, which is a projection
// and gives no energy, and then close by a quarter of their openings, as far as the energy of that
// is small.
void JointSolver::hold_roughly(const JointRun& run, const Cluster& cluster, Group& group) {
  for (const std::uint32_t index : joints_of(group))
    linearize(joints_[index]);
  group.is_factored = group.is_fresh = false;
  set_speed_errors(run, group, false);
  solve_locks(run, group, true);
  save(run, group);
  set_speed_errors(run, group, true);
  solve_locks(run, group, true);
  limit_closing(run, cluster);
}

// Newton's method with a factor that is kept while it converges: errors are those of the true
// poses. Each step leaves about the same part of an opening, so once the next step would leave less
// than rounding does, the check after it is skipped. With `turn` along the directions after the
// substep. Returns the widest opening that is left.
std::int64_t JointSolver::close(const JointRun& run, Group& group, bool turn) {
  const bool loops = has_solved_loops(group);
  const std::int64_t enough = group.is_plain ? k_rounding : k_pushed_rounding;
  const std::int64_t expected = group.is_plain ? k_noise : k_pushed_rounding;
  const int fall_bits = loops ? k_loop_fall_bits : k_tree_fall_bits;
  const int most = turn && !loops ? k_most_solves : k_most_passes;
  std::int64_t before = 0;
  for (int i = 0; i < most; ++i) {
    look_ahead(run, group, turn && i == 0);
    const std::int64_t widest = set_position_errors(group);
    const bool drives =
        loops && !group.is_plain && (i == 0 || motor_error(run, group) > k_slow_loop);
    if (widest <= enough && !drives) return 0;
    if (i >= k_position_solves && loops && widest <= k_nearly_closed) return widest;
    const bool slow = i > 0 && widest > before >> fall_bits;
    const bool wide = turn && widest > (loops ? k_nearly_closed : k_closed);
    const bool renews = slow && (wide || !group.is_fresh);
    if (renews) {
      if (turn) look_ahead(run, group, true);
      factor(run, group, turn);
      group.turns_fast = true;
      set_position_errors(group);
    }
    solve_locks(run, group, true);
    const bool falls = 2 * widest <= before;
    if (falls && !drives && widest <= k_far && widest * widest <= expected * before) return 0;
    const bool may_give_up = i + 1 >= k_position_solves && !loops && !renews;
    if (may_give_up && !falls && (!turn || widest <= k_closed)) break;
    before = widest;
  }
  look_ahead(run, group, false);
  return set_position_errors(group);
}

// Locks and limits such that they do not open.
void JointSolver::hold_speeds(const JointRun& run, const Cluster& cluster) {
  for (int i = 0; i < k_most_velocity_solves; ++i) {
    for (Joint& joint : joints_of(cluster))
      if (i < k_velocity_solves) solve_limits(run, joint, false);
    for (Group& group : groups_of(cluster))
      hold_speed(run, group, i);
  }
}

// The locks of a group: solve number i. A factor of earlier rows is kept while it converges.
void JointSolver::hold_speed(const JointRun& run, Group& group, int i) {
  if (i == 0) group.fresh_solves = 0;
  const bool loops = has_solved_loops(group);
  const std::int64_t slow = loops ? k_slow_loop : k_slow_tree;
  if (i >= k_velocity_solves && (!group.exact || group.speed <= slow)) return;
  if (group.fresh_solves >= k_velocity_solves) return;
  const std::int64_t before = group.speed;
  group.speed = set_speed_errors(run, group, false);
  const bool is_driven = i == 0 && loops && !group.is_plain;
  if (i > 0 && loops) group.speed = std::max(group.speed, motor_error(run, group));
  const auto bodies = std::span(group_bodies_).subspan(group.first_body, group.body_count);
  const auto is_pulled = [this](std::uint32_t body) { return bodies_[body].pulled; };
  const bool always = i < k_velocity_solves &&
                      (is_driven || (group.is_plain && std::ranges::any_of(bodies, is_pulled)));
  const bool is_exact = i < k_velocity_solves && !(i > 0 && loops);
  if (!always && group.speed <= (is_exact ? k_still : slow)) return;
  const int fall_bits = loops ? k_loop_fall_bits : k_tree_fall_bits;
  const bool is_slow = i == 0 ? group.turns_fast : group.speed > before >> fall_bits;
  if (is_slow && !group.is_fresh && group.exact) {
    factor(run, group, false);
    group.turns_fast = true;
  }
  solve_locks(run, group, false);
  if (group.is_fresh) ++group.fresh_solves;
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
  }
  for (const std::uint32_t index : joints_of(group))
    joints_[index].saved = joints_[index].locks;
}

void JointSolver::restore(const JointRun& run, const Group& group) {
  for (std::uint32_t i = 0; i < group.body_count; ++i) {
    Body& body = bodies_[group_bodies_[group.first_body + i]];
    run.rows[body.solver] = body.saved_row;
    body.has_looked = false;
  }
  for (const std::uint32_t index : joints_of(group))
    joints_[index].locks = joints_[index].saved;
}

// Solves for the errors that stand on the right-hand side, and pushes.
void JointSolver::solve_locks(const JointRun& run, Group& group, bool positions) {
  if (has_solved_loops(group)) return solve_loops(run, group, positions);
  if (!has_factor(group)) factor(run, group, false);
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const Joint& joint = joints_[joints_of(group)[k]];
    for (std::uint32_t r = 0; r < joint.rows.locks; ++r) {
      std::int64_t& rhs = factor_.rhs(columns[k].first_row + r);
      const int shift = 4 + joint.scales[r] - group.exponent;
      rhs = raw::round_shift(-rhs, std::min(shift, 62));
    }
  }
  factor_.solve(group.column, group.count);
  const bool later = group.exact && !positions;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    Joint& joint = joints_[joints_of(group)[k]];
    RowImpulses impulses;
    for (std::uint32_t r = 0; r < joint.rows.locks; ++r) {
      const int shift = 4 - joint.scales[r] - group.exponent;
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
