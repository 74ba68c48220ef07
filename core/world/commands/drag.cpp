#include <lockstone/drag.h>
#include <lockstone/transform.h>

#include "core/math/divide.h"

namespace lockstone {
namespace {

// Along the axes of the ground's shape.
std::array<LinearAxis, 3> springs_of(const World& world, const Drag& drag,
                                     const Vec3<Position>& target) {
  const Vec3<Length> place = saturated<Length>(apply_inverse(pose_of(world, drag.ground), target));
  std::array<LinearAxis, 3> axes;
  for (int i = 0; i < 3; ++i)
    axes[static_cast<std::size_t>(i)] = {.target = place[i],
                                         .hertz = drag.hertz,
                                         .damping_ratio = drag.damping_ratio,
                                         .max_effort = drag.max_force};
  return axes;
}

}  // namespace

JointDef drag_joint(const World& world, const Drag& drag, const Vec3<Position>& target) {
  JointDef joint = JointDef::of(JointKind::motor, drag.ground, drag.body);
  joint.frame_b.position = drag.point;
  joint.linear = springs_of(world, drag, target);
  joint.collide = true;
  return joint;
}

std::array<SetLinearAxis, 3> drag_commands(const World& world, JointHandle joint, const Drag& drag,
                                           const Vec3<Position>& target) {
  const std::array<LinearAxis, 3> axes = springs_of(world, drag, target);
  return {{{joint, 0, axes[0]}, {joint, 1, axes[1]}, {joint, 2, axes[2]}}};
}

}  // namespace lockstone
