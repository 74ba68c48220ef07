// Figures that follow a walk: wholly, with a limp arm, by springs, until they fall, hung by a hand.
#include <array>

#include <lockstone/game_math.h>
#include <lockstone/ragdoll.h>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint32_t k_pelvis = 0, k_chest = 1, k_head = 2, k_right = 3, k_left = 8;
enum Limb : std::uint32_t { arm, forearm, thigh, shin, foot, limb_count };  // from a side
constexpr std::uint32_t k_bones = k_left + limb_count;
using Bones = std::array<Bone, k_bones>;
using Drives = std::array<BoneDrive, k_bones>;

enum Figure : std::uint32_t { walker, limp_armed, sprung, falling, hanging, figure_count };
constexpr std::uint32_t k_first_body = 1;  // after the ground
constexpr std::uint64_t k_fall_tick = 90;
constexpr Length k_hip_height = 1.06_m;

struct Place {
  std::int32_t x, y, joint_y;  // mm
};

// Of a limb the x axis of the joint points down; of a hinge it is the x axis of the figure.
Bone bone(std::uint32_t parent, const Shape& shape, const Place& at, JointKind joint) {
  const Vec3<Unit> axis =
      joint == JointKind::hinge ? k_x_axis : Vec3<Unit>{{}, -Unit::from_integer(1), {}};
  Bone made;
  made.parent = parent;
  made.pose.position = {millimetres(at.x), millimetres(at.y), {}};
  made.shape = shape;
  made.joint = joint;
  made.joint_frame = {{millimetres(at.x), millimetres(at.joint_y), {}},
                      from_directions(k_x_axis, axis)};
  made.friction = Torque::from_integer(2);
  return made;
}

void limit(Bone& bone, Angle min_twist, Angle max_twist, Angle max_swing = k_half_turn) {
  bone.min_twist = min_twist;
  bone.max_twist = max_twist;
  bone.max_swing = max_swing;
}

void add_side(Bones& bones, std::uint32_t first, std::int32_t side) {
  Bone* const made = &bones[first];
  made[arm] = bone(k_chest, Shape::capsule(0.1_m, 0.05_m), {side * 260, 360, 500}, JointKind::ball);
  limit(made[arm], -0.8_rad, 0.8_rad, 2.4_rad);
  made[forearm] =
      bone(first + arm, Shape::capsule(0.1_m, 0.045_m), {side * 260, 50, 200}, JointKind::hinge);
  limit(made[forearm], -2.4_rad, 0_rad);
  made[thigh] =
      bone(k_pelvis, Shape::capsule(0.14_m, 0.07_m), {side * 100, -330, -100}, JointKind::ball);
  limit(made[thigh], -0.5_rad, 0.5_rad, 1.6_rad);
  made[shin] = bone(first + thigh, Shape::capsule(0.14_m, 0.055_m), {side * 100, -750, -540},
                    JointKind::hinge);
  limit(made[shin], 0_rad, 2.4_rad);
  made[foot] = bone(first + shin, Shape::box(0.05_m, 0.03_m, 0.12_m), {side * 100, -990, -950},
                    JointKind::hinge);
  made[foot].pose.position.z = 0.06_m;
  limit(made[foot], -0.6_rad, 0.6_rad);
}

Bones make_bones() {
  Bones bones;
  bones[k_pelvis].shape = Shape::box(0.15_m, 0.1_m, 0.1_m);
  bones[k_chest] =
      bone(k_pelvis, Shape::box(0.18_m, 0.2_m, 0.11_m), {0, 340, 120}, JointKind::ball);
  limit(bones[k_chest], -0.5_rad, 0.5_rad, 0.6_rad);
  bones[k_head] = bone(k_chest, Shape::sphere(0.12_m), {0, 700, 570}, JointKind::ball);
  limit(bones[k_head], -1_rad, 1_rad, 0.7_rad);
  add_side(bones, k_right, 1);
  add_side(bones, k_left, -1);
  return bones;
}

Unit wave(std::uint64_t tick, std::int64_t period) {
  const auto in_period = static_cast<std::int64_t>(tick % static_cast<std::uint64_t>(period));
  return sin(Angle::from_ratio(in_period * 6'283'185 / period, 1'000'000));
}

Quat about(const Vec3<Unit>& axis, Angle middle, Angle most, Unit part) {
  return from_axis_angle(axis, middle + rounded<Angle>(most * part));
}

constexpr std::int64_t k_stride = 60;

// Of a limb frame y is the x axis of the figure: to swing forward is below 0.
void step_side(RagdollPose& pose, std::uint32_t first, std::uint64_t tick) {
  Quat* const turns = &pose.turns[first];
  const Unit swing = wave(tick, k_stride), lift = wave(tick + k_stride / 4, k_stride);
  turns[arm] = about(k_y_axis, 0_rad, 0.5_rad, -swing);
  turns[forearm] = about(k_x_axis, -0.6_rad, 0.3_rad, swing);
  turns[thigh] = about(k_y_axis, -0.1_rad, 0.5_rad, swing);
  turns[shin] = about(k_x_axis, 0.5_rad, 0.4_rad, -lift);
  turns[foot] = about(k_x_axis, 0_rad, 0.2_rad, lift);
}

RagdollPose walk(std::uint32_t figure, std::uint64_t tick) {
  RagdollPose pose;
  constexpr Length k_bob = 0.02_m;
  pose.root.position = {
      millimetres(static_cast<int>(figure) * 1400 - 2800),
      rounded<Position>(k_hip_height) + rounded<Position>(k_bob * wave(2 * tick, k_stride)),
      {}};
  pose.root.orientation = about(k_y_axis, 0_rad, 0.1_rad, wave(tick, k_stride));
  pose.turns[k_chest] = about(k_x_axis, 0_rad, 0.2_rad, wave(tick, k_stride));
  step_side(pose, k_right, tick);
  step_side(pose, k_left, tick + k_stride / 2);
  return pose;
}

Drives drives_of(std::uint32_t figure, std::uint64_t tick) {
  Drives drives{};
  drives[k_pelvis].mode = BoneMode::kinematic;
  if (figure == limp_armed)
    drives[k_right + arm].mode = drives[k_right + forearm].mode = BoneMode::limp;
  if (figure == sprung)
    for (BoneDrive& drive : std::span(drives).subspan(1))
      drive = {.mode = BoneMode::sprung, .hertz = 20_r, .max_torque = Torque::from_integer(200)};
  if (figure == hanging || (figure == falling && tick >= k_fall_tick))
    drives.fill({.mode = BoneMode::limp});
  if (figure == hanging) drives[k_right + forearm].mode = BoneMode::kinematic;
  return drives;
}

void build_ragdolls(World& world, std::uint64_t) {
  add_ground(world, 8_m);
  const Bones bones = make_bones();
  for (std::uint32_t i = 0; i < figure_count; ++i) {
    RagdollPose pose = walk(i, 0);
    if (i == hanging) pose.root.position.y = 2.2_m;
    LKS_CHECK(
        create_ragdoll(world, {bones, {.group = -1 - static_cast<std::int32_t>(i)}}, pose).ok());
  }
  for (int i = 0; i < 4; ++i) {
    BodyDef ball = loose(Shape::sphere(0.15_m),
                         {0.1_m, millimetres(1300 + 10 * i), millimetres(3000 + 2500 * i)});
    ball.velocity = {{}, 3_mps, -4_mps};
    add(world, ball);
  }
}

// The scene's handles are those of its beginning: no mode of it destroys a joint.
Ragdoll ragdoll_of(std::uint32_t figure) {
  Ragdoll ragdoll;
  ragdoll.bone_count = k_bones;
  for (std::uint32_t i = 0; i < k_bones; ++i) {
    ragdoll.bodies[i] = {k_first_body + figure * k_bones + i, 1};
    if (i > 0) ragdoll.joints[i] = {figure * (k_bones - 1) + i - 1, 1};
  }
  return ragdoll;
}

// The hand of the hanging figure stays where it is: its own pose tells where.
void hold_hand(World& world, const RagdollDef& def, Ragdoll& ragdoll, const Drives& drives) {
  const RagdollPose pose = pose_of(world, def, ragdoll);
  LKS_CHECK(drive_ragdoll(world, def, ragdoll, pose, pose, drives) == Status::ok);
}

void drive_ragdolls(World& world, std::uint64_t) {
  const Bones bones = make_bones();
  const RagdollDef def{.bones = bones};
  for (std::uint32_t i = 0; i < figure_count; ++i) {
    Ragdoll ragdoll = ragdoll_of(i);
    const std::uint64_t tick = world.tick();
    const Drives drives = drives_of(i, tick);
    if (i == hanging) {
      hold_hand(world, def, ragdoll, drives);
      continue;
    }
    LKS_CHECK(drive_ragdoll(world, def, ragdoll, walk(i, tick), walk(i, tick + 1), drives) ==
              Status::ok);
  }
}

}  // namespace

constinit const Scene k_ragdoll_drive{
    .name = "ragdoll-drive",
    .description =
        "figures walk as they are driven: exactly, with a limp arm, by springs; one "
        "falls and one hangs by a hand",
    .golden_ticks = 240,
    .define = small_world,
    .builder = build_ragdolls,
    .drive = drive_ragdolls};

}  // namespace lockstone::scenes
