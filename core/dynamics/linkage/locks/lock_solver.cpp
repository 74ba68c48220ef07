#include "core/dynamics/linkage/locks/lock_solver.h"

#include <algorithm>
#include <array>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/cluster_energy.h"
#include "core/dynamics/linkage/rows/joint_drives.h"
#include "core/dynamics/linkage/rows/row_motion.h"
#include "core/dynamics/linkage/rows/row_responses.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// Of solves for positions in a substep: as many in any case where the opening does not fall; of a
// tree, or with directions after the substep; of loops, as long as locks are open by 1 mm, Q32.
constexpr int k_position_solves = 3;
constexpr int k_most_passes = 8;
constexpr int k_most_solves = 12;
constexpr std::int64_t k_nearly_closed = 1 << 22;

// Of loops whose locks are closed: a third solve leaves as much, because of the compliance.
constexpr int k_loop_solves = 2;

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

// Of loops: 60 nm. Their compliance leaves about half of that.
constexpr std::int64_t k_loop_rounding = 256;

// Openings that ropes and chains may leave: 30 nm, as much as rounding of spin does at an arm of 1
// m.
constexpr std::int64_t k_noise = 128;

// Openings whose squares fit, 0.25 m.
constexpr std::int64_t k_wide = std::int64_t{1} << 30;

// Before the first solve a factor of earlier rows is not used for errors above this, m/s, Q50: a
// link turned far in the substep, and the factor could add to its speed.
constexpr std::int64_t k_far_speed = std::int64_t{4} << 50;

// Joints of groups without a direct solve close this part of an opening in a substep.
constexpr int k_close_shift = 2;

// Whether a lock is open by more than a good step leaves.
bool is_open(const JointRows& rows) {
  return std::ranges::any_of(rows.rows.first(rows.locks),
                             [](const JointRow& row) { return std::abs(row.error) > k_lost; });
}

// Finds the errors of a joint's locks at these poses, and keeps their directions.
void find_errors(const JointPlace& place, JointRows& rows) {
  if (rows.is_point && rows.locks == 3) {
    const RawVec3 gap = point_gap(place);
    for (std::size_t r = 0; r < 3; ++r)
      rows.rows[r].error = gap[r];
    return;
  }
  LKS_ASSERT(rows.locks <= rows.count);
  const LockErrors ahead = lock_errors(place);
  for (std::size_t r = 0; r < ahead.count && ahead.count == rows.locks; ++r)
    rows.rows[r].error = ahead.errors[r];
}

}  // namespace

// Finds the locks as they will be after the substep as it stands; with `turn` also their directions
// there.
void LockSolver::look_ahead(const JointRun& run, JointGroup& group, bool turn) {
  for (const std::uint32_t index : system_.bodies_of(group))
    lockstone::look_ahead(run, system_.bodies[index]);
  for (const std::uint32_t index : system_.joints_of(group)) {
    LinkedJoint& joint = system_.joints[index];
    JointFrames frames;
    const JointPlace place = place_ahead(system_, joint, frames);
    if (!turn) {
      find_errors(place, joint.rows);
      continue;
    }
    std::array<JointRow, k_joint_axes> rows;
    JointRows ahead{rows};
    fill_rows(place, RowParts::locks, ahead);
    if (ahead.locks != joint.rows.locks) continue;
    std::copy_n(ahead.rows.begin(), ahead.locks, joint.rows.rows.begin());
    find_responses(system_, joint, joint.rows.locks, true);
  }
  if (turn) group.is_fresh = false;
}

// The errors of a joint's locks that `solve` takes away, by its place in the group.
std::span<std::int64_t> LockSolver::errors_at(const JointGroup& group, std::uint32_t place) {
  return group.has_solved_loops() ? loops_.errors(group, place) : trees_.errors(group, place);
}

// Sets the errors to the speeds that close the openings left after the substep as it stands.
// Returns the widest opening, Q32.
std::int64_t LockSolver::set_position_errors(const JointGroup& group) {
  LKS_ASSERT(group.rate > 0);
  std::int64_t widest = 0;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    const std::span<std::int64_t> errors = errors_at(group, k);
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      const std::int64_t error = joint.rows.rows[r].error - joint.left_open[r];
      widest = std::max(widest, std::abs(error));
      errors[r] = closing_speed(error, group.rate);
    }
  }
  return widest;
}

// Sets the errors to the present speeds of the locks; with `positions` and that which closes a
// quarter of their openings. Returns the greatest of them, Q50.
std::int64_t LockSolver::set_speed_errors(const JointRun& run, const JointGroup& group,
                                          bool positions) {
  std::int64_t greatest = 0;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    const std::span<std::int64_t> errors = errors_at(group, k);
    LKS_ASSERT(errors.size() >= joint.rows.locks);
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      const JointRow& row = joint.rows.rows[r];
      std::int64_t error = row_speed(run, joint, row);
      if (positions) {
        error += bounded(closing_speed(row.error, system_.step.substep_rate(), k_close_shift),
                         k_close_speed / 2);
      }
      greatest = std::max(greatest, std::abs(error));
      errors[r] = error;
    }
  }
  return greatest;
}

bool LockSolver::has_open_locks(const JointGroup& group) const {
  return std::ranges::any_of(system_.joints_of(group), [this](std::uint32_t index) {
    return is_open(system_.joints[index].rows);
  });
}

void LockSolver::factor(const JointRun& run, JointGroup& group, bool ahead) {
  if (group.has_solved_loops()) return loops_.factor(run, group, ahead);
  trees_.factor(group);
}

void LockSolver::solve(const JointRun& run, JointGroup& group, bool positions) {
  if (group.has_solved_loops()) return loops_.solve(run, group, positions);
  trees_.solve(run, group, positions);
}

// Where locks were open already, the step counts only if it takes no more energy than it may.
void LockSolver::step_positions(const JointRun& run, const JointCluster& cluster,
                                JointGroup& group) {
  LKS_ASSERT(group.is_direct);
  const bool was_open = has_open_locks(group);
  if (was_open) save(run, group);
  look_ahead(run, group, false);
  if (set_position_errors(group) > 0) solve(run, group, true);
  if (was_open && closes_too_fast(run, system_, cluster)) restore(run, group);
}

void LockSolver::close_a_quarter(const JointRun& run, JointGroup& group) {
  set_speed_errors(run, group, true);
  solve(run, group, true);
}

// Impulses go along the directions that locks have now, as RATTLE wants them, while that converges.
// Where links swing fast it does not, and Newton's method with the directions after the substep
// takes its place. Where locks were open already, the result counts only if it takes no more energy
// to close them than it may.
void LockSolver::solve_positions(const JointRun& run, const JointCluster& cluster,
                                 JointGroup& group) {
  LKS_ASSERT(group.is_direct);
  save(run, group);
  const bool was_open = has_open_locks(group);
  const bool holds = find_positions(run, group) <= k_lost;
  const bool must_be_passive = was_open || cluster.is_passive || cluster.moves_first;
  if (holds && !(must_be_passive && closes_too_fast(run, system_, cluster))) return;
  restore(run, group);
  lock_roughly(run, cluster, group);
}

// Returns the widest opening that is left.
std::int64_t LockSolver::find_positions(const JointRun& run, JointGroup& group) {
  if (system_.is_stiff(group)) return close(run, group, true);
  const std::int64_t widest = close(run, group, false);
  if (widest <= k_closed || group.has_solved_loops()) return widest;
  restore(run, group);
  return close(run, group, true);
}

// Where the method does not converge: velocities such that locks do not open, which is a projection
// and gives no energy, and then close by a quarter of their openings, as far as the energy of that
// is small.
void LockSolver::lock_roughly(const JointRun& run, const JointCluster& cluster, JointGroup& group) {
  for (const std::uint32_t index : system_.joints_of(group))
    linearize(system_, system_.joints[index]);
  group.is_factored = group.is_fresh = false;
  set_speed_errors(run, group, false);
  solve(run, group, true);
  limit_projection(run, system_, cluster);
  save(run, group);
  close_a_quarter(run, group);
  limit_closing(run, system_, cluster);
}

// Each step leaves about the same part of an opening, so once the next step would leave less than
// rounding does, the check after it is skipped.
std::int64_t LockSolver::close(const JointRun& run, JointGroup& group, bool turn) {
  const bool loops = group.has_solved_loops();
  LKS_ASSERT(group.is_direct && group.count > 0);
  const std::int64_t rounding = group.only_locks ? k_rounding : k_pushed_rounding;
  const std::int64_t enough = loops ? k_loop_rounding : rounding;
  const std::int64_t expected = group.only_locks ? k_noise : k_pushed_rounding;
  const int fall_bits = loops ? k_loop_fall_bits : k_tree_fall_bits;
  const int most = turn && !loops ? k_most_solves : k_most_passes;
  std::int64_t before = 0;
  for (int i = 0; i < most; ++i) {
    look_ahead(run, group, turn && i == 0);
    const std::int64_t widest = set_position_errors(group);
    const bool drives =
        loops && !group.only_locks && (i == 0 || loops_.motor_error(run, group) > k_slow_loop);
    if (widest <= enough && !drives) return 0;
    if (i >= k_loop_solves && loops && widest <= k_closed) return widest;
    if (i >= k_position_solves && loops && widest <= k_nearly_closed) return widest;
    const bool slow = i > 0 && widest > before >> fall_bits;
    const bool wide = turn && widest > (loops ? k_nearly_closed : k_closed);
    const bool at_once = i == 0 && turn && !loops && group.turns_fast;
    const bool renews = at_once || (slow && (wide || !group.is_fresh));
    if (renews) {
      if (turn && !at_once) look_ahead(run, group, true);
      factor(run, group, turn);
      group.turns_fast = true;
      set_position_errors(group);
    }
    solve(run, group, true);
    const bool falls = 2 * widest <= before;
    if (falls && !drives && widest <= k_wide && widest * widest <= expected * before) return 0;
    const bool may_give_up = i + 1 >= k_position_solves && !loops && !renews;
    if (may_give_up && !falls && (!turn || widest <= k_closed)) break;
    before = widest;
  }
  look_ahead(run, group, false);
  return set_position_errors(group);
}

void LockSolver::lock_speeds(const JointRun& run, const JointCluster& cluster) {
  for (int i = 0; i < k_most_velocity_solves; ++i) {
    if (i < k_velocity_solves) {
      for (LinkedJoint& joint : system_.joints_of(cluster))
        solve_limits(run, system_.step, joint, false);
    }
    for (JointGroup& group : system_.groups_of(cluster))
      lock_speed(run, group, i);
  }
}

// The locks of a group. A factor of earlier rows is kept while it converges.
void LockSolver::lock_speed(const JointRun& run, JointGroup& group, int pass) {
  LKS_ASSERT(pass >= 0 && pass < k_most_velocity_solves);
  if (pass == 0) group.fresh_solves = 0;
  const bool loops = group.has_solved_loops();
  const std::int64_t slow = loops ? k_slow_loop : k_slow_tree;
  if (pass >= k_velocity_solves && (!group.is_direct || group.speed <= slow)) return;
  if (group.fresh_solves >= k_velocity_solves) return;
  const std::int64_t before = group.speed;
  group.speed = set_speed_errors(run, group, false);
  const bool is_driven = pass == 0 && loops && !group.only_locks;
  if (pass > 0 && loops) group.speed = std::max(group.speed, loops_.motor_error(run, group));
  const auto is_pulled = [this](std::uint32_t body) { return system_.bodies[body].pulled; };
  const bool always =
      pass == 0 &&
      (is_driven || (group.only_locks && std::ranges::any_of(system_.bodies_of(group), is_pulled)));
  if (!always && group.speed <= (pass == 0 ? k_still : slow)) return;
  const int fall_bits = loops ? k_loop_fall_bits : k_tree_fall_bits;
  const bool is_slow =
      pass == 0 ? group.turns_fast || group.speed > k_far_speed : group.speed > before >> fall_bits;
  if (is_slow && !group.is_fresh && group.is_direct) {
    factor(run, group, false);
    group.turns_fast = true;
  }
  solve(run, group, false);
  if (group.is_fresh) ++group.fresh_solves;
}

void LockSolver::save(const JointRun& run, const JointGroup& group) {
  for (const std::uint32_t index : system_.bodies_of(group)) {
    LinkedBody& body = system_.bodies[index];
    body.saved_row = run.rows[body.solver];
  }
  for (const std::uint32_t index : system_.joints_of(group))
    system_.joints[index].saved = system_.joints[index].locks;
}

void LockSolver::restore(const JointRun& run, const JointGroup& group) {
  for (const std::uint32_t index : system_.bodies_of(group)) {
    LinkedBody& body = system_.bodies[index];
    run.rows[body.solver] = body.saved_row;
    body.has_looked = false;
  }
  for (const std::uint32_t index : system_.joints_of(group))
    system_.joints[index].locks = system_.joints[index].saved;
}

}  // namespace lockstone
