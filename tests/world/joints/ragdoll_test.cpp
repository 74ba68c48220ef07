// Ragdolls: bones to bodies and joints, poses that drive them, parts that are limp or kinematic.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/game_math.h>
#include <lockstone/ragdoll.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

constexpr Vec3<Unit> k_x{Unit::from_integer(1), {}, {}}, k_y{{}, Unit::from_integer(1), {}},
    k_z{{}, {}, Unit::from_integer(1)};

enum BoneIndex : std::uint32_t { hips, chest, head, arm, hand, thigh, shin, bone_count };

Bone limb(std::uint32_t parent, Position x, Position y, Position joint_y, Length half,
          JointKind kind) {
  Bone bone{.parent = parent, .pose = {{x, y, {}}, {}}, .shape = Shape::capsule(half, 0.06_m)};
  bone.joint = kind;
  // x of the joint points down the limb; of a hinge it is z of the skeleton.
  const Vec3<Unit> down{{}, -Unit::from_integer(1), {}};
  bone.joint_frame = {{x, joint_y, {}},
                      from_directions(k_x, kind == JointKind::hinge ? k_z : down)};
  return bone;
}

// Half a figure, y up, with the hips at the origin: 7 bones.
std::vector<Bone> half_figure() {
  std::vector<Bone> bones(bone_count);
  bones[hips] = {.shape = Shape::box(0.16_m, 0.1_m, 0.1_m)};
  bones[chest] = limb(hips, {}, 0.35_m, 0.12_m, 0.12_m, JointKind::ball);
  bones[head] = limb(chest, {}, 0.68_m, 0.56_m, 0.04_m, JointKind::ball);
  bones[arm] = limb(chest, 0.25_m, 0.35_m, 0.5_m, 0.1_m, JointKind::ball);
  bones[hand] = limb(arm, 0.25_m, 0.03_m, 0.18_m, 0.1_m, JointKind::hinge);
  bones[thigh] = limb(hips, 0.12_m, -0.35_m, -0.12_m, 0.15_m, JointKind::ball);
  bones[shin] = limb(thigh, 0.12_m, -0.8_m, -0.57_m, 0.15_m, JointKind::hinge);
  for (Bone& bone : bones)
    bone.joint_frame.orientation = normalized(bone.joint_frame.orientation);
  bones[head].mass = Mass::from_integer(5);
  bones[hand].min_twist = -2.5_rad, bones[hand].max_twist = 2.5_rad;
  bones[thigh].max_swing = 2_rad;
  return bones;
}

Unit wave(int tick, int period, int phase) {
  return sin(Angle::from_ratio((tick + phase) % period * 6'283'185LL / period, 1'000'000));
}

Angle scaled(Unit part, Angle most) {
  return rounded<Angle>(part * most);
}
Position sway(Unit part) {
  constexpr Length k_most = 0.1_m;
  return rounded<Position>(part * k_most);
}

// A walk on the spot: hips that sway, limbs that swing by up to 0.6 rad about once a second.
RagdollPose walk(int tick) {
  RagdollPose pose;
  pose.root.position = {sway(wave(tick, 120, 0)), 2_m, sway(wave(tick, 90, 0))};
  pose.root.orientation = from_axis_angle(k_y, scaled(wave(tick, 150, 0), 0.4_rad));
  pose.turns[chest] = from_axis_angle(k_z, scaled(wave(tick, 80, 10), 0.3_rad));
  pose.turns[head] = from_axis_angle(k_x, scaled(wave(tick, 70, 3), 0.5_rad));
  pose.turns[arm] = normalized(multiply(from_axis_angle(k_y, scaled(wave(tick, 60, 0), 0.6_rad)),
                                        from_axis_angle(k_z, scaled(wave(tick, 75, 5), 0.4_rad))));
  pose.turns[hand] = from_axis_angle(k_x, scaled(wave(tick, 60, 7), 0.5_rad) + 0.8_rad);
  pose.turns[thigh] = from_axis_angle(k_z, scaled(wave(tick, 60, 30), 0.6_rad));
  pose.turns[shin] = from_axis_angle(k_x, scaled(wave(tick, 60, 20), 0.5_rad) - 0.6_rad);
  return pose;
}

struct Figure {
  std::vector<Bone> bones = half_figure();
  RagdollDef def{.bones = bones, .filter = {.group = -1}};
  World world = test::make_world();
  Ragdoll ragdoll = create_ragdoll(world, def, walk(0)).value();
  std::vector<BoneDrive> drives{bone_count, BoneDrive{}};

  Figure() { drives[hips].mode = BoneMode::kinematic; }

  void play(int tick) {
    ASSERT_EQ(drive_ragdoll(world, def, ragdoll, walk(tick), walk(tick + 1), drives), Status::ok);
    (void)world.step();
  }
};

double distance(const Transform& a, const Transform& b) {
  return std::hypot(metres(a.position.x - b.position.x), metres(a.position.y - b.position.y),
                    metres(a.position.z - b.position.z));
}

struct Error {
  double place = 0, turn = 0;
};

Error error_of(const Figure& figure, const RagdollPose& wanted) {
  std::array<Transform, bone_count> poses;
  bone_poses(figure.def, wanted, poses);
  Error worst;
  for (std::size_t i = 0; i < bone_count; ++i) {
    const Transform at = pose_of(figure.world, figure.ragdoll.bodies[i]);
    worst.place = std::max(worst.place, distance(at, poses[i]));
    worst.turn = std::max(worst.turn,
                          std::ldexp(angle_between(at.orientation, poses[i].orientation).raw, -27));
  }
  return worst;
}

TEST(Ragdolls, FollowAPoseWithinAMillimetre) {
  Figure figure;
  Error worst;
  for (int tick = 0; tick < 300; ++tick) {
    figure.play(tick);
    const Error now = error_of(figure, walk(tick + 1));
    if (tick % 20 == 0) std::printf("%d: %.6f m %.6f rad\n", tick, now.place, now.turn);
    if (tick < 30) continue;
    worst = {std::max(worst.place, now.place), std::max(worst.turn, now.turn)};
  }
  std::printf("follows within %.6f m, %.6f rad\n", worst.place, worst.turn);
  EXPECT_LT(worst.place, 1e-3);
}

}  // namespace
}  // namespace lockstone
