// Finds pendulums: bodies that hang on one point of a body at rest (pivot_integrator.h). The solver
// leaves out their joints.

#include "core/world/phases/motion/pendulums.h"

#include <algorithm>

#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/joint/pivot_integrator.h"

namespace lockstone {

Pendulums::Pendulums(WorldData& world, const TickContacts& found)
    : world_(world),
      found_(found),
      place_of_(world.def.body_capacity),
      touches_(world.def.body_capacity) {
  pendulums_.reserve(std::min(world.def.body_capacity, world.def.joint_capacity));
  solved_joints_.reserve(world.def.joint_capacity);
}

void Pendulums::find() {
  for (const Pendulum& pendulum : pendulums_)
    place_of_[pendulum.body] = 0;
  pendulums_.clear();
  has_list_ = false;
  for (const JointLink& link : world_.joint_graph.awake_links()) {
    if (world_.bodies[link.body_a].is_static() != world_.bodies[link.body_b].is_static())
      look_for(link);
  }
  if (pendulums_.empty()) return;
  // Only marks of bodies that may be pendulums are read.
  for (const Pendulum& pendulum : pendulums_)
    touches_[pendulum.body] = 0;
  for (const ContactRecord& record : found_.records) {
    if (!record.is_inert()) touches_[record.body_a] = touches_[record.body_b] = 1;
  }
  std::erase_if(pendulums_, [&](const Pendulum& pendulum) { return touches_[pendulum.body] != 0; });
  for (std::size_t i = 0; i < pendulums_.size(); ++i)
    place_of_[pendulums_[i].body] = static_cast<std::uint32_t>(i + 1);
  keep_joints([this](const JointLink& link) { return !has(link.body_a) && !has(link.body_b); });
}

void Pendulums::look_for(const JointLink& link) {
  const bool is_first = world_.bodies[link.body_b].is_static();
  const std::uint32_t body = is_first ? link.body_a : link.body_b;
  const BodyRecord& record = world_.bodies[body];
  if (!record.is_dynamic() || record.locks != 0 || !is_point(world_.joints[link.joint])) return;
  if (!world_.joint_graph.neighbours(body).has_one()) return;
  const Pendulum pendulum{link.joint, body, is_first};
  if (can_step_about_pivot(record, world_.cache.rotation(body), pivot_of(pendulum),
                           world_.header.gravity, world_.time_step))
    pendulums_.push_back(pendulum);
}

Pivot Pendulums::pivot_of(const Pendulum& pendulum) const {
  const JointRecord& joint = world_.joints[pendulum.joint];
  const std::uint32_t other = pendulum.is_first ? joint.body_b : joint.body_a;
  const Vec3<Length>& anchor = pendulum.is_first ? joint.anchor_b : joint.anchor_a;
  return {world_.bodies[other].position + arm_of(world_.cache.rotation(other), anchor),
          pendulum.is_first ? joint.anchor_a : joint.anchor_b};
}

// The joints that the solver gets.
std::span<const JointLink> Pendulums::joints_to_solve() const {
  return has_list_ ? solved_joints_ : std::span<const JointLink>(world_.joint_graph.awake_links());
}

// Returns the number of turns about an axis.
std::uint32_t Pendulums::run(std::uint32_t body) {
  const Pendulum& pendulum = pendulums_[place_of_[body] - 1];
  const PivotStep step =
      step_about_pivot(world_.bodies[pendulum.body], world_.cache.rotation(pendulum.body),
                       pivot_of(pendulum), world_.header.gravity, world_.time_step);
  JointRecord& joint = world_.joints[pendulum.joint];
  for (std::size_t i = 0; i < k_joint_axes; ++i)
    joint.axes[i].impulse = joint.axes[i].drive_impulse = {};
  for (int i = 0; i < 3; ++i) {
    const std::int64_t part = raw::round_shift(step.impulse[i].raw, 12);
    joint.axes[static_cast<std::size_t>(i)].impulse.raw =
        raw::saturate<std::int32_t>(pendulum.is_first ? -part : part);
  }
  return step.axis_turns;
}

}  // namespace lockstone
