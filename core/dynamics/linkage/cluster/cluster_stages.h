// The stages of a tick and of its substeps, for one cluster of joints.
//
// The scheme is RATTLE: impulses at the beginning of the substep such that locks hold at its end,
// and at the end such that they do not open (H. C. Andersen, "Rattle: a velocity version of the
// Shake algorithm", 1983). A body by itself that only locks fasten moves half a substep first
// (cluster_moves_first.cpp).
#pragma once

#include <cstdint>

#include "core/dynamics/linkage/cluster/energy_account.h"
#include "core/dynamics/linkage/locks/lock_solver.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

class ClusterStages {
 public:
  ClusterStages(JointSystem& system, LockSolver& locks, EnergyAccount& account)
      : system_(system), locks_(locks), account_(account) {}

  /// At a tick's beginning: decides whether positions go half a substep first.
  void begin(JointCluster& cluster);

  /// Once contacts are prepared: rows; a body that moves first goes half a substep.
  void prepare(const JointRun& run, JointCluster& cluster);

  /// At the beginning of a substep, after forces: the impulses of the last one again.
  void warm_start(const JointRun& run, JointCluster& cluster);

  /// Before positions move: drives, limits, and locks such that they hold afterwards.
  void solve(const JointRun& run, const JointCluster& cluster);

  /// After positions moved: the rest of springs, and locks and limits such that they do not open.
  void relax(const JointRun& run, const JointCluster& cluster);

 private:
  [[nodiscard]] bool push_drives(const JointRun& run, const JointCluster& cluster);
  [[nodiscard]] bool solve_locks(const JointRun& run, const JointCluster& cluster, bool again);
  [[nodiscard]] bool can_move_first(const JointCluster& cluster);
  void move_first(JointRun run, JointCluster& cluster);
  void stay(JointCluster& cluster);
  void set_rate(const JointCluster& cluster, std::int64_t rate);

  JointSystem& system_;
  LockSolver& locks_;
  EnergyAccount& account_;
};

}  // namespace lockstone
