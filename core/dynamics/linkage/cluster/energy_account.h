// Keeps a cluster of joints from gaining energy.
//
// Locks and limits do no work, so a cluster that nothing else drives has no more energy than
// gravity and forces give it. Where links turn faster than the substep resolves, a step may still
// give it some. Each cluster has an account of that, in the record of its first joint: once the
// gain exceeds a part of its energy, the velocities go towards those of a step without positional
// correction, which is a projection in the metric of the masses and so gains nothing, as far as it
// takes to return the gain. Losses count as well, up to a part of the energy, so that errors that
// come and go cost nothing.
#pragma once

#include <atomic>
#include <cstdint>

#include "core/dynamics/linkage/locks/lock_solver.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

class EnergyAccount {
 public:
  EnergyAccount(JointSystem& system, LockSolver& locks) : system_(system), locks_(locks) {}

  /// At a tick's beginning.
  void clear() { returns_ = 0; }

  /// When a cluster's joints are prepared for a tick: finds its heaviest body, and whether anything
  /// but gravity and forces drives it.
  void open(JointCluster& cluster);

  /// At the beginning of a substep.
  void begin(const JointRun& run, JointCluster& cluster);

  /// After the impulses of the last substep: if they give much energy, less of them is repeated.
  void limit_warm_start(const JointRun& run, const JointCluster& cluster);

  /// After a substep: the cluster returns its gain, if that is more than it may keep.
  void settle(const JointRun& run, JointCluster& cluster);

  /// After the last substep: its gain for `JointRecord::energy_gained`.
  [[nodiscard]] static std::int32_t stored_gain(const JointCluster& cluster);

  /// Times that a cluster returned energy in this tick.
  [[nodiscard]] std::uint32_t returns() const { return returns_; }

 private:
  void find_heaviest_body(JointCluster& cluster);
  void project_start(const JointRun& run, const JointCluster& cluster);
  void return_gain(const JointRun& run, const JointCluster& cluster);

  JointSystem& system_;
  LockSolver& locks_;
  std::atomic<std::uint32_t> returns_{0};
};

}  // namespace lockstone
