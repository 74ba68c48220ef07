// Groups of joints with loops, as `ProximalLocks` solves them.

#include <algorithm>

#include "core/dynamics/joint_numbers.h"
#include "core/dynamics/joint_solver.h"

namespace lockstone {
namespace {

// Of solves for positions in a substep, as long as locks are open by more than 1 mm, Q32.
constexpr int k_least_solves = 3, k_most_solves = 8;
constexpr std::int64_t k_nearly_closed = 1 << 22;

}  // namespace

// Its joints are links yet. A tree has as many joints as bodies that are pushed, or one less if it
// hangs on nothing else; loops may go through what it hangs on.
bool JointSolver::has_loops(const Group& group) const {
  const auto hangs = [this](std::uint32_t link) {
    return !bodies_[links_[link].a].pushed || !bodies_[links_[link].b].pushed;
  };
  const bool is_hung = std::ranges::any_of(joints_of(group), hangs);
  return group.count >= group.body_count + (is_hung ? 1 : 0);
}

bool JointSolver::plan_loops(Group& group) {
  if constexpr (k_converges_islands) {
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
  }
  return group.exact;
}

// At the beginning of a substep. Impulses of the last one that locks of loops hold against each
// other would turn with the bodies, and grow. Where there are drives, locks bear what those do.
void JointSolver::forget_locks(const Cluster& cluster) {
  const Group& group = groups_of(cluster)[0];
  if (!has_solved_loops(group) || !group.is_plain) return;
  for (Joint& joint : joints_of(cluster))
    joint.locks = {};
}

void JointSolver::factor_loops(Group& group, bool ahead) {
  if constexpr (k_converges_islands) {
    for (std::uint32_t i = 0; i < group.body_count; ++i) {
      const Body& body = bodies_[group_bodies_[group.first_body + i]];
      loops_->set_inertia(group.loops, i, ahead ? body.inertia_ahead : body.inverse_inertia);
    }
    for (std::uint32_t k = 0; k < group.count; ++k) {
      const JointRows& rows = joints_[joints_of(group)[k]].rows;
      loops_->set_rows(group.loops, k, rows.rows.first(rows.locks));
    }
    loops_->factor(group.loops);
    group.is_factored = true;
  }
}

// Velocities such that locks hold after the substep. Where links swing faster than the substep
// resolves, by their directions after it.
void JointSolver::close_loops(const JointRun& run, Group& group) {
  const bool turn = is_stiff(group);
  for (int i = 0; i < k_most_solves; ++i) {
    const std::int64_t widest = approach(run, group, 0, turn);
    if (i + 1 >= k_least_solves && widest <= k_nearly_closed) return;
  }
}

void JointSolver::solve_loops(const JointRun& run, Group& group, bool positions) {
  if constexpr (k_converges_islands) {
    if (!group.is_factored) factor_loops(group, false);
    const auto total = [&](Joint& joint, std::size_t lock) -> std::int64_t& {
      const std::uint8_t axis = joint.rows.rows[lock].axis;
      return positions ? joint.locks[axis] : joint.relaxed[axis];
    };
    for (std::uint32_t k = 0; k < group.count; ++k) {
      Joint& joint = joints_[joints_of(group)[k]];
      for (std::size_t r = 0; r < joint.rows.locks; ++r)
        loops_->give(group.loops, k, r, total(joint, r));
    }
    loops_->solve(group.loops);
    for (std::uint32_t k = 0; k < group.count; ++k) {
      Joint& joint = joints_[joints_of(group)[k]];
      RowImpulses impulses;
      for (std::size_t r = 0; r < joint.rows.locks; ++r) {
        impulses[r] = loops_->impulse(group.loops, k, r);
        total(joint, r) = bounded(total(joint, r) + impulses[r], k_product_bound);
      }
      push(run, joint, 0, joint.rows.locks, impulses);
    }
  }
}

}  // namespace lockstone
