// Half a drift, a push, half a drift: a body by itself, without contacts, on joints that only lock.
//
// Positions first go half a substep, then gravity pushes, and so on, with half a substep at the
// end: one drift more in a tick than where half a push comes first. With E = p²/2 + V the energy
// that the step keeps differs from that of the body by h²·(p⁴/24 − p²V″/24 + V′²/12), p⁴ by the
// chord of a drift: for a pendulum from 90° a constant. With half a push first it is h²·(p⁴/24 +
// p²V″/12 − V′²/24). Modified equations: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical
// Integration", IX. Chains of such bodies fly apart where they are pulled hard.

#include <algorithm>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"

namespace lockstone {

bool JointSolver::is_plain(const Joint& joint) {
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    const JointAxisRecord& axis = joint.record->axes[i];
    if (axis.is_driven()) return false;
    if (joint.record->mode(i) == AxisMode::limited && axis.lower != axis.upper) return false;
  }
  return true;
}

bool JointSolver::can_drift(const Cluster& cluster) {
  const Group& group = groups_of(cluster)[0];
  if (cluster.body_count != 1 || !group.exact || !group.is_plain || is_stiff(group)) return false;
  const auto stands = [&](std::uint32_t body) {
    return bodies_[body].pushed || bodies_[body].solver == 0;
  };
  const auto hangs = [&](const Joint& joint) { return stands(joint.a) && stands(joint.b); };
  return bodies_[bodies_of(cluster)[0]].centred && std::ranges::all_of(joints_of(cluster), hangs);
}

void JointSolver::set_rate(const Cluster& cluster, std::int64_t rate) {
  const RoundDivisor divisor(rate);
  for (const std::uint32_t body : bodies_of(cluster))
    bodies_[body].rate = divisor, bodies_[body].has_looked = false;
  for (Group& group : groups_of(cluster))
    group.rate = rate;
}

// Half a push first after all.
void JointSolver::stay(Cluster& cluster) {
  cluster.free = groups_of(cluster)[0].drifts = false;
  set_rate(cluster, step_.substep_rate());
  for (const std::uint32_t body : bodies_of(cluster))
    bodies_[body].free = false;
  for (Joint& joint : joints_of(cluster))
    load_impulses(joint, 29);
}

// Nothing of this is replayed.
void JointSolver::drift(JointRun run, Cluster& cluster) {
  run.before = {};
  set_rate(cluster, std::int64_t{2} * step_.substep_rate());
  for (Joint& joint : joints_of(cluster))
    joint.locks = joint.carried = {};
  Group& group = groups_of(cluster)[0];
  save(run, group);
  if (close(run, group, false) > k_closed) {
    restore(run, group);
    return stay(cluster);
  }
  for (const std::uint32_t body : bodies_of(cluster))
    move(run, body);
  relax(run, cluster);
  for (Joint& joint : joints_of(cluster)) {
    const std::array<std::int64_t, k_joint_axes> locks = joint.locks, relaxed = joint.relaxed;
    load_impulses(joint, 30);
    for (std::size_t i = 0; i < k_joint_axes; ++i)
      joint.relaxed[i] = bounded(locks[i] + relaxed[i], k_product_bound);
  }
}

}  // namespace lockstone
