// Finds pendulums: bodies that hang on one point of a body at rest (swing.h). The solver leaves out
// their joints.

#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/joint/pivot_integrator.h"
#include "core/world/world_impl.h"

namespace lockstone {

void World::Impl::find_swings() {
  for (const Swing& swing : swings)
    swing_of[swing.body] = 0;
  swings.clear();
  for (const JointLink& link : joint_graph.awake_links()) {
    if (bodies[link.body_a].is_static() != bodies[link.body_b].is_static()) look_for_swing(link);
  }
  if (swings.empty()) return;
  // Only marks of bodies that may swing are read.
  for (const Swing& swing : swings)
    bounce_marks[swing.body] = 0;
  for (const ContactRecord& record : new_contacts) {
    if (!record.is_trigger()) bounce_marks[record.body_a] = bounce_marks[record.body_b] = 1;
  }
  std::erase_if(swings, [&](const Swing& swing) { return bounce_marks[swing.body] != 0; });
  for (std::size_t i = 0; i < swings.size(); ++i)
    swing_of[swings[i].body] = static_cast<std::uint32_t>(i + 1);
  solved_joints.clear();
  for (const JointLink& link : joint_graph.awake_links()) {
    if (swing_of[link.body_a] == 0 && swing_of[link.body_b] == 0) solved_joints.push_back(link);
  }
}

void World::Impl::look_for_swing(const JointLink& link) {
  const bool is_first = bodies[link.body_b].is_static();
  const std::uint32_t body = is_first ? link.body_a : link.body_b;
  const BodyRecord& record = bodies[body];
  if (!record.is_dynamic() || record.locks != 0 || !is_point(joints[link.joint])) return;
  if (joint_graph.neighbours(body).size() != 1) return;
  const Swing swing{link.joint, body, is_first};
  if (can_swing(record, cache.rotation(body), pivot_of(swing), header.gravity, time_step))
    swings.push_back(swing);
}

SwingPivot World::Impl::pivot_of(const Swing& swing) const {
  const JointRecord& joint = joints[swing.joint];
  const std::uint32_t other = swing.is_first ? joint.body_b : joint.body_a;
  const Vec3<Length>& held = swing.is_first ? joint.anchor_b : joint.anchor_a;
  return {bodies[other].position + arm_of(cache.rotation(other), held),
          swing.is_first ? joint.anchor_a : joint.anchor_b};
}

// The joints that the solver gets.
std::span<const JointLink> World::Impl::joints_to_solve() const {
  return swings.empty() ? std::span<const JointLink>(joint_graph.awake_links()) : solved_joints;
}

// Returns the number of turns about an axis.
std::uint32_t World::Impl::run_swing(const Swing& swing) {
  const SwingStep step = lockstone::swing(bodies[swing.body], cache.rotation(swing.body),
                                          pivot_of(swing), header.gravity, time_step);
  JointRecord& joint = joints[swing.joint];
  for (std::size_t i = 0; i < k_joint_axes; ++i)
    joint.axes[i].impulse = joint.axes[i].drive_impulse = {};
  for (int i = 0; i < 3; ++i) {
    const std::int64_t part = raw::round_shift(step.impulse[i].raw, 12);
    joint.axes[static_cast<std::size_t>(i)].impulse.raw =
        raw::saturate<std::int32_t>(swing.is_first ? -part : part);
  }
  return step.axis_turns;
}

}  // namespace lockstone
