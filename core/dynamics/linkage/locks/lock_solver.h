// The locks of joints, solved by group: before positions move, such that they hold afterwards; and
// after it, such that they do not open.
//
// Before positions move this is Newton's method on the true poses after the substep. A direct group
// has a factor of all its locks; it is kept from step to step while it converges, because errors
// are those of the true poses. Other groups have one joint each, and close a quarter of their
// openings in a substep.
#pragma once

#include <cstdint>

#include "core/dynamics/linkage/locks/loop_locks.h"
#include "core/dynamics/linkage/locks/tree_locks.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

class LockSolver {
 public:
  LockSolver(JointSystem& system, TreeLocks& trees, LoopLocks& loops)
      : system_(system), trees_(trees), loops_(loops) {}

  // Before positions move.

  /// One step of Newton's method: enough between drives and limits that push again.
  void step_positions(const JointRun& run, const JointCluster& cluster, JointGroup& group);

  /// Finds velocities such that the locks of a direct group hold after the substep.
  void solve_positions(const JointRun& run, const JointCluster& cluster, JointGroup& group);

  /// Gives the locks the speed that closes a quarter of their openings in a substep.
  void close_a_quarter(const JointRun& run, JointGroup& group);

  // The same in parts, for a cluster that first moves half a substep.

  /// Locks that are open by less, m, Q32, are closed: 1 µm.
  static constexpr std::int64_t k_closed = 1 << 12;

  /// Newton's method with a factor that is kept while it converges, along the rows' directions
  /// where the bodies are, or with `turn` along those after the substep. Returns the widest opening
  /// that is left, m, Q32.
  [[nodiscard]] std::int64_t close(const JointRun& run, JointGroup& group, bool turn);

  /// Notes velocities and impulses, and goes back to them.
  void save(const JointRun& run, const JointGroup& group);
  void restore(const JointRun& run, const JointGroup& group);

  // After positions moved.

  /// Velocities such that locks and limits do not open.
  void lock_speeds(const JointRun& run, const JointCluster& cluster);

 private:
  void look_ahead(const JointRun& run, JointGroup& group, bool turn);
  [[nodiscard]] std::span<std::int64_t> errors_at(const JointGroup& group, std::uint32_t place);
  std::int64_t set_position_errors(const JointGroup& group);
  std::int64_t set_speed_errors(const JointRun& run, const JointGroup& group, bool positions);
  /// Whether any lock was open by more than a good step leaves, as the rows were read.
  [[nodiscard]] bool has_open_locks(const JointGroup& group) const;
  void factor(const JointRun& run, JointGroup& group, bool ahead);
  void solve(const JointRun& run, JointGroup& group, bool positions);
  [[nodiscard]] std::int64_t find_positions(const JointRun& run, JointGroup& group);
  void lock_roughly(const JointRun& run, const JointCluster& cluster, JointGroup& group);
  void lock_speed(const JointRun& run, JointGroup& group, int pass);

  JointSystem& system_;
  TreeLocks& trees_;
  LoopLocks& loops_;
};

}  // namespace lockstone
