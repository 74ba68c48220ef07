// A few bodies and joints for tests of the parts of the joint solver, without a world around them.
#pragma once

#include <deque>
#include <vector>

#include <lockstone/body.h>
#include <lockstone/joint.h>

#include "core/dynamics/linkage/joint_planner.h"
#include "core/dynamics/linkage/locks/loop_locks.h"
#include "core/dynamics/linkage/locks/tree_locks.h"
#include "core/dynamics/linkage/rows/row_responses.h"
#include "core/dynamics/linkage/system/joint_system.h"
#include "core/dynamics/linkage/system/linked_bodies.h"

namespace lockstone::test {

/// Bodies are 1 kg, with a radius of gyration of about 0.6 m, unless a test changes their records
/// before it adds joints.
class JointScene {
 public:
  explicit JointScene(bool solves_loops = true, std::size_t capacity = 64)
      : system(TimeStep::of(60, 4), capacity, capacity),
        bodies(system.bodies, capacity, capacity),
        trees(system, capacity),
        loops(system, capacity, capacity, solves_loops),
        planner(system, trees, loops, capacity, capacity) {}

  JointScene(const JointScene&) = delete;
  JointScene& operator=(const JointScene&) = delete;

  /// A body at x, y, z in m. Returns its number.
  std::uint32_t body(double x, double y, double z, MotionType motion = MotionType::dynamic) {
    BodyRecord& record = records.emplace_back();
    record.motion = static_cast<std::uint8_t>(motion);
    record.position = {position(x), position(y), position(z)};
    record.orientation = {};
    record.inertia = {Unit::from_ratio(3, 8), Unit::from_ratio(3, 8), Unit::from_ratio(3, 8)};
    if (motion == MotionType::dynamic) {
      const BlockFloat inverse = inverse_of(Mass::from_integer(1));
      record.inverse_mass = inverse.mantissa;
      record.inverse_mass_exponent = inverse.exponent;
    }
    return static_cast<std::uint32_t>(records.size() - 1);
  }

  /// A ball joint in the middle between two bodies. Further settings may be made until `add`.
  JointRecord& ball(std::uint32_t a, std::uint32_t b) {
    JointRecord& joint = joints.emplace_back();
    joint.kind = static_cast<std::uint8_t>(JointKind::ball);
    joint.orientation_a = joint.orientation_b = {};
    joint.body_a = a;
    joint.body_b = b;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t way = records[b].position[i].raw - records[a].position[i].raw;
      joint.anchor_a[i].raw = static_cast<std::int32_t>(way >> 13);  // half of it, from Q32 to Q20
      joint.anchor_b[i].raw = -joint.anchor_a[i].raw;
      joint.modes[static_cast<std::size_t>(i)] = static_cast<std::uint8_t>(AxisMode::locked);
      joint.modes[static_cast<std::size_t>(3 + i)] = static_cast<std::uint8_t>(AxisMode::free);
    }
    return joint;
  }

  /// Adds all joints, plans their groups and makes their rows.
  void plan(std::uint32_t first_without_contacts = 0) {
    system.clear();
    bodies.clear();
    for (const JointRecord& joint : joints) {
      AddedJoint& added = system.added.emplace_back();
      added.record = &joint;
      added.a = gather(joint.body_a);
      added.b = gather(joint.body_b);
      planner.read(added);
    }
    in_balls = planner.plan(first_without_contacts);
    solver_bodies.resize(records.size() + 1);
    rows.resize(records.size() + 1);
    before.resize(records.size() + 1);
    inertias.resize(records.size() + 1);
    places.resize(records.size() + 1);
    for (LinkedBody& body : system.bodies) {
      body.rate = RoundDivisor(system.step.substep_rate());
      body.inverse_inertia = inverse_inertia(*body.record, rotation_);
      body.after = body.pose;
    }
    for (JointGroup& group : system.groups) {
      group.rate = system.step.substep_rate();
      group.only_locks = true;
    }
    for (const JointCluster& cluster : system.clusters)
      linearize(system, cluster);
  }

  [[nodiscard]] JointRun run() { return {solver_bodies, rows, before, inertias, places}; }

  /// The velocity of a body, m/s, Q50.
  [[nodiscard]] lanes::BodyVelocity& row(std::uint32_t body) { return rows[body + 1]; }

  JointSystem system;
  LinkedBodies bodies;
  TreeLocks trees;
  LoopLocks loops;
  JointPlanner planner;
  std::deque<BodyRecord> records;
  std::deque<JointRecord> joints;
  std::span<const std::uint32_t> in_balls;
  std::vector<SolverBody> solver_bodies;
  std::vector<lanes::BodyVelocity> rows, before;
  std::vector<lanes::BodyInertia> inertias;
  std::vector<lanes::BodyPlace> places;

 private:
  [[nodiscard]] static Position position(double x) {
    return Position::from_raw(static_cast<std::int64_t>(x * 4294967296.0));
  }

  // Bodies that move are numbered from 1 by the contact solver.
  std::uint32_t gather(std::uint32_t body) {
    const BodyRecord& record = records[body];
    return bodies.gather(body, record.moves() ? body + 1 : 0, record, rotation_);
  }

  Mat3 rotation_{};
};

}  // namespace lockstone::test
