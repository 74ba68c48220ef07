// Position Verlet, half a move, a push, half a move: a body by itself, without contacts, on joints
// that only lock.
//
// Positions first go half a substep, then gravity pushes, and so on, with half a substep at the
// end: one move more in a tick than where half a push comes first. With E = p²/2 + V the energy
// that the step keeps differs from that of the body by h²·(p⁴/24 − p²V″/24 + V′²/12), p⁴ by the
// chord of a move: for a pendulum from 90° a constant. With half a push first it is h²·(p⁴/24 +
// p²V″/12 − V′²/24). Modified equations: E. Hairer, C. Lubich, G. Wanner, "Geometric Numerical
// Integration", IX. Chains of such bodies fly apart where they are pulled hard.

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/cluster/cluster_stages.h"

namespace lockstone {

bool ClusterStages::can_move_first(const JointCluster& cluster) {
  LKS_ASSERT(!system_.groups_of(cluster).empty());
  const JointGroup& group = system_.groups_of(cluster)[0];
  if (cluster.body_count != 1 || !group.is_direct || !group.only_locks || system_.is_stiff(group))
    return false;
  const auto stands = [&](std::uint32_t body) {
    return system_.bodies[body].pushed || system_.bodies[body].solver == 0;
  };
  const auto hangs = [&](const LinkedJoint& joint) { return stands(joint.a) && stands(joint.b); };
  return system_.bodies[system_.bodies_of(cluster)[0]].centred &&
         std::ranges::all_of(system_.joints_of(cluster), hangs);
}

void ClusterStages::set_rate(const JointCluster& cluster, std::int64_t rate) {
  LKS_ASSERT(rate > 0);
  const RoundDivisor divisor(rate);
  for (const std::uint32_t index : system_.bodies_of(cluster)) {
    LinkedBody& body = system_.bodies[index];
    body.rate = divisor;
    body.has_looked = false;
  }
  for (JointGroup& group : system_.groups_of(cluster))
    group.rate = rate;
}

// Half a push first after all.
void ClusterStages::stay(JointCluster& cluster) {
  cluster.moves_first = false;
  set_rate(cluster, system_.step.substep_rate());
  for (const std::uint32_t body : system_.bodies_of(cluster))
    system_.bodies[body].moves_first = false;
  for (LinkedJoint& joint : system_.joints_of(cluster))
    load_impulses(joint, 29);
}

// Nothing of this is replayed.
void ClusterStages::move_first(JointRun run, JointCluster& cluster) {
  LKS_ASSERT(cluster.group_count == 1 && cluster.body_count == 1);
  run.before = {};
  set_rate(cluster, std::int64_t{2} * system_.step.substep_rate());
  for (LinkedJoint& joint : system_.joints_of(cluster))
    joint.locks = joint.carried = {};
  JointGroup& group = system_.groups_of(cluster)[0];
  locks_.save(run, group);
  if (locks_.close(run, group, false) > LockSolver::k_closed) {
    locks_.restore(run, group);
    return stay(cluster);
  }
  for (const std::uint32_t body : system_.bodies_of(cluster))
    move_body(run, system_.bodies[body]);
  relax(run, cluster);
  for (LinkedJoint& joint : system_.joints_of(cluster)) {
    const AxisImpulses locks = joint.locks, relaxed = joint.relaxed;
    load_impulses(joint, 30);
    for (std::size_t i = 0; i < k_joint_axes; ++i)
      joint.relaxed[i] = bounded(locks[i] + relaxed[i], k_product_bound);
  }
}

}  // namespace lockstone
