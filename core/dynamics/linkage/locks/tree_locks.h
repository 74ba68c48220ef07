// Solves for all locks of a group at once, by a block-sparse factor with one column a joint.
//
// The matrix A = J·M⁻¹·Jᵀ holds the responses of locks to impulses of locks. Joints that share no
// body have no block in it; eliminated from the leaves, a tree of joints fills none in. The rows
// are scaled by powers of two (`LinkedJoint::scales`) such that the diagonal lies in (2^-4, 1].
#pragma once

#include <cstdint>
#include <span>

#include "core/dynamics/linkage/system/joint_factor.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

class TreeLocks {
 public:
  /// No function but this allocates.
  [[gnu::cold]] TreeLocks(JointSystem& system, std::size_t joint_capacity);

  void clear() { factor_.clear(); }

  /// Of all groups planned since `clear`.
  [[nodiscard]] PoolUse pool_use() const { return factor_.pool_use(); }

  /// Plans the factor of a group whose joints are not made yet. False if it would fill in too much,
  /// or there is no room; then nothing has been planned.
  [[nodiscard]] bool plan(JointGroup& group);
  /// Alike, for a group of one joint, which always has room.
  void plan_single(JointGroup& group);

  /// Factors the matrix of the group's present rows.
  void factor(JointGroup& group);

  /// The speeds of the locks of a joint, by its place in the group, that `solve` is to take away:
  /// m/s, Q50.
  [[nodiscard]] std::span<std::int64_t> errors(const JointGroup& group, std::uint32_t place) {
    return factor_.rhs_of(factor_.columns(group.column, group.count)[place]);
  }

  /// Solves for the impulses of all locks, and applies them. `positions`: before positions move.
  void solve(const JointRun& run, JointGroup& group, bool positions);

 private:
  void scale_errors(const JointGroup& group);
  void apply(const JointRun& run, const JointGroup& group, bool positions, int shift);
  void fill_block(const LinkedJoint& p, const LinkedJoint& q, std::int64_t* block) const;

  JointSystem& system_;
  JointFactor factor_;
};

}  // namespace lockstone
