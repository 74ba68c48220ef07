// Solves for all locks and motors of a group with loops at once (`ProximalLocks`).
//
// A motor that pushes as hard as it may, a limit and a spring are *left out* of the factor: limits
// and springs are solved one by one, and a motor at its bound is a known impulse.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"
#include "core/dynamics/problem/proximal_locks.h"

namespace lockstone {

class LoopLocks {
 public:
  /// Plans no group unless it is `enabled`. No function but this allocates.
  [[gnu::cold]] LoopLocks(JointSystem& system, std::size_t body_capacity,
                          std::size_t joint_capacity, bool enabled);

  void clear();

  /// Of all groups planned since `clear`.
  [[nodiscard]] PoolUse pool_use() const {
    return loops_ == nullptr ? PoolUse{} : loops_->pool_use();
  }

  /// Plans the factor of a group whose joints are not made yet. False if it is too large.
  [[nodiscard]] bool plan(JointGroup& group);
  /// Otherwise `plan` refuses it.
  [[nodiscard]] bool may_fit(const JointGroup& group) const {
    return loops_ != nullptr && ProximalLocks::may_fit(group.body_count, group.count);
  }

  /// At the beginning of a substep: locks and motors begin with no impulses. Those of the last one
  /// that rows of loops hold against each other would turn with the bodies, and grow.
  static void forget_impulses(const JointGroup& group, std::span<LinkedJoint> joints);

  /// Factors the matrix of the group's present rows; `ahead`: with the bodies' inertia half a
  /// substep on.
  void factor(const JointRun& run, JointGroup& group, bool ahead);

  /// The speeds of the locks of a joint, by its place in the group, that `solve` is to take away:
  /// m/s, Q50.
  [[nodiscard]] std::span<std::int64_t> errors(const JointGroup& group, std::uint32_t place) {
    return loops_->errors(group.loops, place);
  }

  /// Solves for the impulses of all locks and motors, and applies them. `positions`: before
  /// positions move.
  void solve(const JointRun& run, JointGroup& group, bool positions);

  /// The greatest error of the speed of a motor that does not push as hard as it may, Q50.
  [[nodiscard]] std::int64_t motor_error(const JointRun& run, const JointGroup& group) const;

 private:
  [[nodiscard]] bool mark_left_out(const JointRun& run, const JointGroup& group);
  void make_factor(const JointGroup& group, bool ahead);
  void complete_errors(const JointRun& run, const JointGroup& group, bool positions);
  void add_speeds(const JointRun& run, const JointGroup& group, int sign);
  [[nodiscard]] std::int64_t motor_impulse(const JointGroup& group, std::uint32_t place,
                                           std::size_t row, bool positions);
  [[nodiscard]] bool bound_motors(const JointRun& run, const JointGroup& group, bool positions);
  void apply(const JointRun& run, const JointGroup& group, bool positions);

  JointSystem& system_;
  std::unique_ptr<ProximalLocks> loops_;  // null unless it is enabled
};

}  // namespace lockstone
