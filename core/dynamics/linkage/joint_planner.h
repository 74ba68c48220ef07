// Decides which joints are solved together, and how: `docs/explanation/solver.md`, section Joints.
//
// Joints connected by bodies that impulses move form a group. The first of these that fits takes
// it: the factor of loops (`LoopLocks`), the factor of trees (`TreeLocks`); otherwise ball joints
// that only lock are left to the coloured balls (`ColouredBalls`), and each other joint is a group
// of its own. All that follows from the order in which joints were added.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/linkage/locks/loop_locks.h"
#include "core/dynamics/linkage/locks/tree_locks.h"
#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

class JointPlanner {
 public:
  /// No function but this allocates.
  [[gnu::cold]] JointPlanner(JointSystem& system, TreeLocks& trees, LoopLocks& loops,
                             std::size_t body_capacity, std::size_t joint_capacity);

  /// As a joint is added with its bodies, which count it: reads all that planning asks of its
  /// record.
  void read(AddedJoint& joint);

  /// Once all joints are added: fills the system's groups, clusters and joints. Returns the added
  /// joints that are left to the coloured balls.
  std::span<const std::uint32_t> plan(std::uint32_t first_without_contacts);

 private:
  void link_bodies(std::uint32_t first_without_contacts);
  void find_group(std::uint32_t root);
  void plan_group(JointGroup group);
  void plan_singles(const JointGroup& group);
  void add_cluster(const JointGroup& group, std::uint32_t first_group);
  void make_joint(AddedJoint& added);
  [[nodiscard]] bool has_loops(const JointGroup& group) const;
  [[nodiscard]] bool has_motors(const JointGroup& group) const;
  [[nodiscard]] bool is_pressed(const JointGroup& group) const;

  JointSystem& system_;
  TreeLocks& trees_;
  LoopLocks& loops_;
  std::vector<std::uint8_t> seen_;       // by added joint
  std::vector<std::uint8_t> visited_;    // by body
  std::vector<std::uint32_t> sorted_;    // added joints of the present cluster, by index
  std::vector<std::uint32_t> in_balls_;  // added joints
};

}  // namespace lockstone
