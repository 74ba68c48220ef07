// Building blocks for scenes of joints.
#pragma once

#include <lockstone/world.h>

#include "tools/bench/accuracy/scene_run.h"
#include "tools/fuzz/real.h"

namespace lockstone::bench {

[[nodiscard]] inline WorldDef joint_world() {
  WorldDef def;
  def.body_capacity = def.joint_capacity = 64;
  def.pair_capacity = def.contact_capacity = 256;
  return def;
}

/// A static body at the origin.
[[nodiscard]] inline BodyDef fixed_point() {
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = Shape::sphere(Length::from_ratio(1, 100));
  def.filter.mask = 0;
  return def;
}

/// A scene's joint fits its world.
inline JointHandle join(World& world, const JointDef& def) {
  return world.create_joint(def).value();
}

/// How far apart the worst of all joints' anchors are, m.
[[nodiscard]] double worst_gap(const World& world);

}  // namespace lockstone::bench
