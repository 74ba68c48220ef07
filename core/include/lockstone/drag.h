// Pulls a point of a body to a target in the world by a spring, as a mouse or a tractor beam does.
#pragma once

#include <array>

#include <lockstone/command.h>
#include <lockstone/joint.h>
#include <lockstone/world.h>

namespace lockstone {

/// A joint of the kind `motor` between a body that stays and one that is dragged. The target is
/// part of the joint, and so of the state.
struct Drag {
  BodyHandle ground{};                             ///< a static body, within 2000 m of the targets
  BodyHandle body{};                               ///< a dynamic one
  Vec3<Length> point{};                            ///< that is pulled, in the frame of its shape
  Number hertz = Number::from_integer(5);          ///< of the spring, above 0, to 1000
  Number damping_ratio = Number::from_integer(1);  ///< 0 … 100
  Force max_force{};  ///< N along each axis of the ground's shape, ≥ 0; 0: no bound
};

/// The joint, for `World::create_joint` or `CreateJoint`. Both bodies must exist. They may touch.
/// The body turns freely about the point.
[[nodiscard]] JointDef drag_joint(const World& world, const Drag& drag,
                                  const Vec3<Position>& target);

/// The commands that give the joint a new target, or new numbers. Targets farther from the ground
/// than 2047 m along an axis become the nearest.
[[nodiscard]] std::array<SetLinearAxis, 3> drag_commands(const World& world, JointHandle joint,
                                                         const Drag& drag,
                                                         const Vec3<Position>& target);

}  // namespace lockstone
