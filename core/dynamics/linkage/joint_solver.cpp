#include "core/dynamics/linkage/joint_solver.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/linkage/rows/pulled_links.h"

namespace lockstone {
namespace {

// In a substep: loads the next cluster while the work for one is done. Skips those of whole
// islands.
template <class Work>
void for_each_cluster(JointSystem& system, std::size_t first, std::size_t end, const Work& work) {
  LKS_ASSERT(end <= system.clusters.size());
  for (std::size_t i = first; i < end; ++i) {
    if (i + 1 < end) system.prefetch(system.clusters[i + 1]);
    if (!system.clusters[i].is_whole) work(system.clusters[i]);
  }
}

}  // namespace

JointSolver::JointSolver(const TimeStep& step, std::size_t world_capacity,
                         std::size_t joint_capacity, bool solves_loops)
    : JointSolver(step,
                  {world_capacity, std::min(world_capacity, 2 * joint_capacity), joint_capacity},
                  solves_loops) {}

JointSolver::JointSolver(const TimeStep& step, const Capacities& most, bool solves_loops)
    : system_(step, most.bodies, most.joints),
      bodies_(system_.bodies, most.bodies, most.world),
      trees_(system_, most.joints),
      loops_(system_, most.bodies, most.joints, solves_loops),
      planner_(system_, trees_, loops_, most.bodies, most.joints),
      locks_(system_, trees_, loops_),
      account_(system_, locks_),
      stages_(system_, locks_, account_),
      whole_clusters_(system_, stages_, account_),
      island_joints_(system_) {}

void JointSolver::clear(const AssetSet* assets) {
  bodies_.clear();
  system_.clear();
  system_.assets = assets;
  account_.clear();
}

void JointSolver::add(const JointRecord& record, const Side& a, const Side& b) {
  const auto gather = [&](const Side& side) {
    return bodies_.gather(side.body, side.solver, side.record, side.rotation);
  };
  LKS_ASSERT(a.body != b.body);
  AddedJoint& added = system_.added.emplace_back();
  added.record = &record;
  added.a = gather(a);
  added.b = gather(b);
  planner_.read(added);
}

void JointSolver::begin(const JointRun& run) {
  LKS_ASSERT(system_.joints.size() <= system_.added.size());
  const RoundDivisor rate(system_.step.substep_rate());
  for (LinkedBody& body : system_.bodies) {
    body.centred = body.pushed && !body.in_balls && !body.touches && !body.is_among_contacts;
    body.rate = rate;
    if (body.pushed) body.inverse_inertia = run.bodies[body.solver].inverse_inertia;
    // Bodies that nothing pushes have a known motion.
    if (!body.pushed) body.after = pose_after(run, body);
  }
  for (JointGroup& group : system_.groups)
    group.rate = system_.step.substep_rate();
  // Where gravity acts half before and half after positions move, so do locks.
  const auto is_centred = [this](std::uint32_t body) {
    return !system_.bodies[body].pushed || system_.bodies[body].centred;
  };
  for (LinkedJoint& joint : system_.joints)
    load_impulses(joint, is_centred(joint.a) && is_centred(joint.b) ? 29 : 30);
  resist_pulls(run, system_);
  for (JointCluster& cluster : system_.clusters)
    stages_.begin(cluster);
}

void JointSolver::end(const JointRun& run) {
  for (LinkedBody& body : system_.bodies) {
    if (!body.pushed || body.least_inertia == 0) continue;
    set_least_inertia(run, body, 0);
    run.inertias[body.solver] = body_inertia(body.inverse_inertia);  // bounces follow
  }
  for (const JointCluster& cluster : system_.clusters)
    system_.joints_of(cluster)[0].energy_gained = EnergyAccount::stored_gain(cluster);
}

void JointSolver::prepare(const JointRun& run, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i)
    stages_.prepare(run, system_.clusters[i]);
}

void JointSolver::warm_start(const JointRun& run, std::size_t first, std::size_t end) {
  for_each_cluster(system_, first, end,
                   [&](JointCluster& cluster) { stages_.warm_start(run, cluster); });
}

void JointSolver::solve(const JointRun& run, std::size_t first, std::size_t end) {
  for_each_cluster(system_, first, end,
                   [&](JointCluster& cluster) { stages_.solve(run, cluster); });
}

void JointSolver::relax(const JointRun& run, std::size_t first, std::size_t end) {
  for_each_cluster(system_, first, end, [&](JointCluster& cluster) {
    stages_.relax(run, cluster);
    account_.settle(run, cluster);
  });
}

void JointSolver::place(const JointRun& run, std::size_t first, std::size_t end) const {
  for (std::size_t i = first; i < end; ++i) {
    const LinkedBody& body = system_.bodies[i];
    if (body.solver == 0 || !body.in_balls) continue;
    run.places[body.solver] = body_place(body.pose.position, body.pose.rotation);
  }
}

void JointSolver::move(const JointRun& run, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    LinkedBody& body = system_.bodies[i];
    if (body.solver == 0 || body.is_whole) continue;
    move_body(run, body);
    if (!body.pushed) body.after = pose_after(run, body);
  }
}

void JointSolver::store(std::size_t added, JointRecord& record) const {
  const std::uint32_t index = system_.added[added].joint;
  if (index == k_in_balls) return;
  const LinkedJoint& joint = system_.joints[index];
  const bool moves_first =
      system_.bodies[joint.a].moves_first || system_.bodies[joint.b].moves_first;
  store_impulses(joint, moves_first, record);
}

Vec3<Velocity> JointSolver::own_spin(std::uint32_t index, const Vec3<Velocity>& spin,
                                     const Vec3<Velocity>& surface) const {
  const LinkedBody* body = bodies_.find(index);
  if (body == nullptr || body->least_inertia == 0) return spin;
  return spin_of(*body->record, body->pose.rotation, surface);
}

const JointPose* JointSolver::find(std::uint32_t index) const {
  const LinkedBody* body = bodies_.find(index);
  return body == nullptr ? nullptr : &body->pose;
}

}  // namespace lockstone
