// The joints of one tick, inside the substeps of the contact solver.
//
// The parts, in the order in which a tick needs them:
//
// | part | job |
// |---|---|
// | `LinkedBodies` | finds the bodies that joints connect |
// | `JointPlanner` | decides which joints are solved together, and how |
// | `JointSystem` | the data that all parts share: joints, bodies, groups, clusters |
// | `ClusterStages` | the stages of a substep for one cluster |
// | `row_responses`, `row_motion` | rows, responses; how rows read and push velocities |
// | `joint_drives` | springs, motors, limits |
// | `LockSolver` | locks: Newton's method before positions move, speeds after it |
// | `TreeLocks`, `LoopLocks` | all locks of a group at once |
// | `pulled_links` | inertia that keeps hard pulled links stable |
// | `EnergyAccount` | keeps clusters from gaining energy |
// | `WholeClusters` | the stages of single clusters |
// | `IslandJoints` | joints in the problem of an island's contacts |
//
// docs/explanation/solver.md says how accurate this is.
#pragma once

#include <cstdint>
#include <span>

#include "core/dynamics/linkage/cluster/cluster_stages.h"
#include "core/dynamics/linkage/cluster/energy_account.h"
#include "core/dynamics/linkage/cluster/whole_clusters.h"
#include "core/dynamics/linkage/island_joints.h"
#include "core/dynamics/linkage/joint_planner.h"
#include "core/dynamics/linkage/locks/lock_solver.h"
#include "core/dynamics/linkage/locks/loop_locks.h"
#include "core/dynamics/linkage/locks/tree_locks.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"
#include "core/dynamics/linkage/system/linked_bodies.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/time_step.h"

namespace lockstone {

class JointSolver {
 public:
  /// For a world of this many bodies and joints. Groups with loops are solved directly only if
  /// `solves_loops`. No function but this allocates.
  [[gnu::cold]] JointSolver(const TimeStep& step, std::size_t world_capacity,
                            std::size_t joint_capacity, bool solves_loops);

  // The parts refer to each other.
  JointSolver(const JointSolver&) = delete;
  JointSolver& operator=(const JointSolver&) = delete;

  /// Begins a tick with as many joints as are added; the assets have the paths of joints.
  void clear(const AssetSet* assets);

  /// One end of a joint.
  struct Side {
    std::uint32_t body = 0;    // index in the world
    std::uint32_t solver = 0;  // in the solver, 0 for a body that does not move
    const BodyRecord& record;
    const Mat3& rotation;
  };
  /// A joint, in the order of their indices. Its references must stay valid for the tick.
  void add(const JointRecord& joint, const Side& a, const Side& b);

  [[nodiscard]] bool empty() const { return system_.added.empty(); }

  /// Whether any joints are solved here.
  [[nodiscard]] bool has_own() const { return !system_.joints.empty(); }

  /// Once all are added: forms groups. Returns the joints, in the order of adding, that are left to
  /// a net.
  std::span<const std::uint32_t> plan(std::uint32_t first_without_contacts) {
    return planner_.plan(first_without_contacts);
  }

  /// Then, before contacts are prepared: bodies as heavy to turn as the step needs.
  void begin(const JointRun& run);

  /// After the last substep, before bounces: spins as they are kept.
  void end(const JointRun& run);

  /// Number of clusters, without joints that are left to the coloured balls. No two share a body
  /// that is pushed: the functions below take a range of clusters, and ranges may be worked at side
  /// by side.
  [[nodiscard]] std::uint32_t cluster_count() const {
    return static_cast<std::uint32_t>(system_.clusters.size());
  }

  // The stages of `ClusterStages`; after `prepare` without clusters of whole islands.
  void prepare(const JointRun& run, std::size_t first, std::size_t end);
  void warm_start(const JointRun& run, std::size_t first, std::size_t end);
  void solve(const JointRun& run, std::size_t first, std::size_t end);
  void relax(const JointRun& run, std::size_t first, std::size_t end);

  /// Writes where bodies of coloured balls are to `places`, each by itself.
  void place(const JointRun& run, std::size_t first, std::size_t end) const;

  /// Moves the jointed bodies, as the contact solver moves those without joints: each by itself, in
  /// the order in which joints first named them.
  void move(const JointRun& run, std::size_t first, std::size_t end);
  [[nodiscard]] std::uint32_t body_count() const {
    return static_cast<std::uint32_t>(system_.bodies.size());
  }

  /// Impulses back to a record, in the order of adding; not of those among the coloured balls.
  void store(std::size_t added, JointRecord& joint) const;

  /// The joint that was added so, once planned: `joint` is k_in_balls of one that is left to the
  /// coloured balls.
  static constexpr std::uint32_t k_in_balls = AddedJoint::k_in_balls;
  [[nodiscard]] const AddedJoint& added(std::size_t number) const { return system_.added[number]; }

  /// The clusters one by one, for islands that are solved whole.
  [[nodiscard]] WholeClusters& whole_clusters() { return whole_clusters_; }

  /// For the problems of islands with contacts.
  [[nodiscard]] IslandJoints& island_joints() { return island_joints_; }

  /// The spin that a body of the world with this surface velocity has by its own inertia, which
  /// `spin` need not be: a body may be taken to be heavier to turn.
  [[nodiscard]] Vec3<Velocity> own_spin(std::uint32_t body, const Vec3<Velocity>& spin,
                                        const Vec3<Velocity>& surface) const;

  /// Where a body of the world is now; null when no joint holds it.
  [[nodiscard]] const JointPose* find(std::uint32_t body) const;

  /// Of the factors of the tick.
  [[nodiscard]] PoolUse pool_use() const {
    PoolUse use = trees_.pool_use();
    use.add(loops_.pool_use());
    return use;
  }

  /// Times that a cluster returned energy.
  [[nodiscard]] std::uint32_t energy_limits() const { return account_.returns(); }

 private:
  struct Capacities {
    std::size_t world, bodies, joints;
  };
  [[gnu::cold]] JointSolver(const TimeStep& step, const Capacities& most, bool solves_loops);

  JointSystem system_;
  LinkedBodies bodies_;
  TreeLocks trees_;
  LoopLocks loops_;
  JointPlanner planner_;
  LockSolver locks_;
  EnergyAccount account_;
  ClusterStages stages_;
  WholeClusters whole_clusters_;
  IslandJoints island_joints_;
};

}  // namespace lockstone
