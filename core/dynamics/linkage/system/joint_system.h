// The joints of one tick, the bodies that they connect, and the groups in which they are solved:
// the data that all parts of the joint solver share.
//
// A *cluster* is all joints connected by bodies that impulses move, without those left to the
// coloured balls. No two clusters share such a body, so that they can be solved side by side. A
// *group* is the joints whose locks are solved together: all of a cluster at once, by a factor
// (a *direct* group), or each joint by itself.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/asset.h>

#include "core/dynamics/linkage/system/linked_body.h"
#include "core/dynamics/linkage/system/linked_joint.h"
#include "core/dynamics/problem/proximal_locks.h"
#include "core/dynamics/state/time_step.h"

namespace lockstone {

/// A joint as it was added, before groups are found.
struct AddedJoint {
  static constexpr std::uint32_t k_in_balls = 0xffffffff;

  static constexpr std::uint32_t k_most_place = (1U << 28) - 1;

  const JointRecord* record = nullptr;
  std::uint32_t a = 0, b = 0;  // in JointSystem::bodies
  std::uint32_t joint = 0;     // in JointSystem::joints; k_in_balls if the coloured balls have it

  // With bits for all else that planning asks of the record, which is large.
  std::uint32_t place : 28 = 0;  // within its group, in the order of elimination
  bool fits_balls : 1 = false;   // the coloured balls can have it
  bool has_motor : 1 = false;
  bool is_driven : 1 = false;           // `lockstone::is_driven`
  bool has_other_impulses : 1 = false;  // than those along the first three axes

  std::int64_t last_pull = 0;  // how hard it pulled as the last tick ended, Q30
};

struct JointGroup {
  std::uint32_t first = 0;  // in JointSystem::order
  std::uint32_t count = 0;
  std::uint32_t first_body = 0;  // in JointSystem::group_bodies
  std::uint32_t body_count = 0;
  std::uint32_t column = 0;                          // its first one in the factor of trees
  std::uint32_t loops = ProximalLocks::k_too_large;  // its number there, if it is solved there
  bool is_direct : 1 = false;                        // a factor has all of its locks
  bool only_locks : 1 = false;                       // neither limits nor drives

  // Its factor and its solves.
  bool is_factored : 1 = false;
  bool is_fresh : 1 = false;      // and so for the present rows
  bool turns_fast : 1 = false;    // in this tick a factor of earlier rows did not serve
  std::int16_t fresh_solves = 0;  // for velocities, with a factor of the present rows
  int exponent = 0;               // least of its rows
  std::int64_t speed = 0;         // greatest of its locks, as last found, Q50
  std::int64_t rate = 0;          // 1 / the time that its bodies move for

  /// Whether `ProximalLocks` solves it, with its motors.
  [[nodiscard]] bool has_solved_loops() const { return loops != ProximalLocks::k_too_large; }
};

struct JointCluster {
  std::uint32_t first_joint = 0;  // in JointSystem::joints
  std::uint32_t joint_count = 0;
  std::uint32_t first_group = 0;
  std::uint32_t group_count = 0;
  std::uint32_t first_body = 0;  // in JointSystem::group_bodies
  std::uint32_t body_count = 0;
  std::int32_t substep = 0;  // number of the present one, from 1
  bool moves_first = false;  // positions go half a substep first
  bool is_whole = false;     // its stages run with the rest of its island

  // Its account of energy.
  bool is_driven = false;   // by springs or motors
  bool is_passive = false;  // only gravity and forces give it energy
  bool knows_energy = false;
  BlockFloat unit{};  // inverse mass of its heaviest body
  // Twice an energy by that mass, (m/s)², Q32:
  std::int64_t gained = 0;        // besides, at any time
  std::int64_t first_gained = 0;  // as the tick began
  std::int64_t energy = 0;        // as the last substep ended, if that is known
};

struct JointSystem {
  /// No function but this allocates.
  [[gnu::cold]] JointSystem(const TimeStep& step, std::size_t body_capacity,
                            std::size_t joint_capacity);

  void clear();

  /// Takes room for as many rows.
  [[nodiscard]] std::span<JointRow> take_rows(std::size_t count);

  [[nodiscard]] std::span<LinkedJoint> joints_of(const JointCluster& cluster) {
    return std::span(joints).subspan(cluster.first_joint, cluster.joint_count);
  }
  [[nodiscard]] std::span<JointGroup> groups_of(const JointCluster& cluster) {
    return std::span(groups).subspan(cluster.first_group, cluster.group_count);
  }
  [[nodiscard]] std::span<const std::uint32_t> bodies_of(const JointCluster& cluster) const {
    return std::span(group_bodies).subspan(cluster.first_body, cluster.body_count);
  }
  [[nodiscard]] std::span<const std::uint32_t> bodies_of(const JointGroup& group) const {
    return std::span(group_bodies).subspan(group.first_body, group.body_count);
  }
  /// In the order of elimination; of `added` until the group's joints are made, then of `joints`.
  [[nodiscard]] std::span<const std::uint32_t> joints_of(const JointGroup& group) const {
    return std::span(order).subspan(group.first, group.count);
  }
  /// Of `added`.
  [[nodiscard]] std::span<const std::uint32_t> joints_at(const LinkedBody& body) const {
    return std::span(by_body).subspan(body.first_joint, body.joint_count);
  }

  /// Whether the group has a factor for the rows that it has now, as they were at some time.
  [[nodiscard]] bool has_factor(const JointGroup& group) const;
  /// Notes that it has one of the present rows.
  void note_factor(JointGroup& group);

  /// Asks the processor for the data of a cluster, which a stage will read soon. Changes nothing.
  void prefetch(const JointCluster& cluster) const;

  /// Whether a body of the group is taken to be heavier to turn.
  [[nodiscard]] bool is_stiff(const JointGroup& group) const;

  TimeStep step;
  const AssetSet* assets = nullptr;  // of the tick: it has the paths of joints
  std::vector<LinkedBody> bodies;    // in the order in which joints first name them
  std::vector<AddedJoint> added;
  std::vector<LinkedJoint> joints;          // cluster by cluster
  std::vector<std::uint32_t> by_body;       // in `added`: joints of each pushed body
  std::vector<std::uint32_t> order;         // joints, group by group, as they are eliminated
  std::vector<std::uint32_t> group_bodies;  // pushed bodies, group by group
  std::vector<JointGroup> groups;
  std::vector<JointCluster> clusters;
  std::vector<JointRow> rows;  // of joints, as many as each can have; never shrinks
  std::size_t row_count = 0;   // of them taken
};

}  // namespace lockstone
