// Shared by the tests of joints.
#pragma once

#include <cmath>

#include "tests/world/world_fixture.h"

namespace lockstone::test {

inline double number(std::int64_t raw, int bits) {
  return std::ldexp(static_cast<double>(raw), -bits);
}

inline BodyHandle add_fixed(World& world) {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = Shape::sphere(Length::from_ratio(1, 20));
  return add(world, def);
}

inline JointHandle join(World& world, const JointDef& def) {
  return world.create_joint(def).value();
}

/// A ball joint midway between two bodies; `half_way`: from the first one's centre.
inline void hold(World& world, BodyHandle one, BodyHandle other, const Vec3<Length>& half_way) {
  JointDef joint = JointDef::of(JointKind::ball, one, other);
  joint.frame_a.position = half_way;
  joint.frame_b.position = -half_way;
  join(world, joint);
}

inline double gap(const JointView& joint) {
  return std::hypot(number(joint.offset.x.raw, 20), number(joint.offset.y.raw, 20),
                    number(joint.offset.z.raw, 20));
}

}  // namespace lockstone::test
