// The number of bodies and joints, the kinds of the joints and their limits are those of the figure
// in Box3D's benchmarks (Erin Catto, shared/human.c); sizes are rounded, both sides alike, the arms
// down, and no spring or friction acts at the joints.
#include "tools/bench/speed/figure.h"

#include <vector>

#include <lockstone/ragdoll.h>

#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using scenes::millimetres;
using scenes::millimetres_long;

// A capsule, upright or along x, and its joint to the parent: millimetres and degrees.
struct Part {
  std::uint32_t parent;
  int x, y, z;
  int half, radius;
  bool is_level;
  JointKind joint;
  int joint_x, joint_y;
  int min_twist, max_twist, swing;
};

constexpr JointKind k_ball = JointKind::ball, k_hinge = JointKind::hinge;

constexpr Part k_parts[] = {
    {k_no_bone, 0, 930, -50, 70, 120, true, k_ball, 0, 0, 0, 0, 0},        // pelvis
    {0, 0, 1100, -35, 60, 110, true, k_ball, 0, 1015, -15, 15, 25},        // spine
    {1, 0, 1220, -27, 80, 100, true, k_ball, 0, 1160, -15, 15, 25},        // spine
    {2, 0, 1360, -28, 110, 130, true, k_ball, 0, 1290, -10, 10, 15},       // spine
    {3, 0, 1550, -56, 30, 60, false, k_ball, 0, 1500, -15, 15, 45},        // neck
    {4, 0, 1690, -3, 30, 97, false, k_ball, 0, 1600, -15, 15, 15},         // head
    {0, 100, 720, -35, 170, 90, false, k_ball, 100, 890, -60, 40, 10},     // thigh
    {6, 100, 280, -37, 160, 75, false, k_hinge, 100, 500, -5, 45, 0},      // calf
    {0, -100, 720, -35, 170, 90, false, k_ball, -100, 890, -30, 60, 10},   // thigh
    {8, -100, 280, -37, 160, 75, false, k_hinge, -100, 500, -45, 5, 0},    // calf
    {3, 270, 1300, -80, 100, 60, false, k_ball, 260, 1430, -5, 5, 60},     // upper arm
    {10, 270, 980, -90, 120, 50, false, k_hinge, 270, 1150, -5, 60, 0},    // lower arm
    {3, -270, 1300, -80, 100, 60, false, k_ball, -260, 1430, -5, 5, 60},   // upper arm
    {12, -270, 980, -90, 120, 50, false, k_hinge, -270, 1150, -60, 5, 0},  // lower arm
};

Angle degrees(int angle) {
  return Angle::from_ratio(angle * 17'453LL, 1'000'000);
}

// Turns x to y.
Quat quarter_turn() {
  return from_axis_angle(scenes::k_z_axis, Angle::from_ratio(1'570'796, 1'000'000));
}

Bone bone_of(const Part& part) {
  Bone bone;
  bone.parent = part.parent;
  bone.shape = Shape::capsule(millimetres_long(part.half), millimetres_long(part.radius));
  bone.pose.position = {millimetres(part.x), millimetres(part.y), millimetres(part.z)};
  if (part.is_level) bone.pose.orientation = quarter_turn();
  bone.joint = part.joint;
  bone.joint_frame.position = {millimetres(part.joint_x), millimetres(part.joint_y),
                               millimetres(part.z)};
  if (part.joint == k_ball) bone.joint_frame.orientation = quarter_turn();
  bone.min_twist = degrees(part.min_twist);
  bone.max_twist = degrees(part.max_twist);
  bone.max_swing = degrees(part.swing);
  return bone;
}

}  // namespace

void add_figure(World& world, const Vec3<Position>& at, std::uint64_t user_data) {
  std::vector<Bone> bones;
  for (const Part& part : k_parts)
    bones.push_back(bone_of(part));
  RagdollPose pose;
  pose.root.position = at + bones.front().pose.position;
  pose.root.orientation = bones.front().pose.orientation;
  LKS_CHECK(create_ragdoll(world, {bones, {}, user_data}, pose).ok());
}

}  // namespace lockstone::bench
