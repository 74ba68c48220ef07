// Ragdolls: bones to bodies and joints, poses that drive them, parts that are limp or kinematic.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
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
  RagdollDef def{.bones = bones, .filter = {.group = -1}, .user_data = 7};
  World world = test::make_world();
  Ragdoll ragdoll = create_ragdoll(world, def, walk(0)).value();
  std::vector<BoneDrive> drives{bone_count, BoneDrive{}};

  Figure() { drives[hips].mode = BoneMode::kinematic; }

  Status drive(const RagdollPose& from, const RagdollPose& to) {
    return drive_ragdoll(world, def, ragdoll, from, to, drives);
  }
  void play(int tick) {
    ASSERT_EQ(drive(walk(tick), walk(tick + 1)), Status::ok);
    (void)world.step();
  }
  [[nodiscard]] MotionType motion(std::size_t bone) const {
    return world.body(ragdoll.bodies[bone]).motion;
  }
};

struct Error {
  double place = 0, turn = 0;  // m, rad

  void add(const Transform& is, const Transform& wanted) {
    const Vec3<Position> d = is.position - wanted.position;
    place = std::max(place, std::hypot(metres(d.x), metres(d.y), metres(d.z)));
    turn = std::max(turn, std::ldexp(angle_between(is.orientation, wanted.orientation).raw, -27));
  }
};

// Of some bones against a pose.
void add_errors(const Figure& figure, const RagdollPose& wanted, std::span<const BoneIndex> bones,
                Error& error) {
  std::array<Transform, bone_count> poses;
  bone_poses(figure.def, wanted, poses);
  for (const BoneIndex i : bones)
    error.add(pose_of(figure.world, figure.ragdoll.bodies[i]), poses[i]);
}

constexpr BoneIndex k_all[] = {hips, chest, head, arm, hand, thigh, shin};

TEST(Ragdolls, FollowAPoseWithinAMillimetre) {
  Figure figure;
  Error worst;
  for (int tick = 0; tick < 300; ++tick) {
    figure.play(tick);
    add_errors(figure, walk(tick + 1), k_all, worst);
  }
  std::printf("driven: within %.3g m, %.3g rad\n", worst.place, worst.turn);
  EXPECT_LT(worst.place, 1e-5);
  EXPECT_LT(worst.turn, 1e-5);
}

// The root is free too: the pose decides the joints alone.
TEST(Ragdolls, FollowAPoseInFreeFall) {
  Figure figure;
  figure.drives[hips].mode = BoneMode::limp;
  Error worst;
  for (int tick = 0; tick < 60; ++tick) {
    figure.play(tick);
    RagdollPose wanted = walk(tick + 1);
    wanted.root = pose_of(figure.world, figure.ragdoll.bodies[hips]);
    add_errors(figure, wanted, k_all, worst);
  }
  EXPECT_LT(metres(figure.world.position(figure.ragdoll.bodies[hips]).y), -1);
  EXPECT_LT(worst.place, 1e-5);
  EXPECT_LT(worst.turn, 1e-5);
}

// A limp figure falls and swings from its hips; another one plays the poses in which it stood.
TEST(Ragdolls, PlayRecordedPosesWithinAMillimetre) {
  Figure limp;
  std::vector<RagdollPose> recorded{pose_of(limp.world, limp.def, limp.ragdoll)};
  std::vector<std::array<Transform, bone_count>> places;
  for (std::size_t i = 1; i < bone_count; ++i)
    limp.drives[i].mode = BoneMode::limp;
  for (int tick = 0; tick < 240; ++tick) {
    limp.play(tick);
    recorded.push_back(pose_of(limp.world, limp.def, limp.ragdoll));
    for (std::size_t i = 0; i < bone_count; ++i)
      places.resize(recorded.size() - 1),
          places.back()[i] = pose_of(limp.world, limp.ragdoll.bodies[i]);
  }
  Figure player;
  Error worst;
  for (std::size_t tick = 0; tick + 1 < recorded.size(); ++tick) {
    ASSERT_EQ(player.drive(recorded[tick], recorded[tick + 1]), Status::ok);
    (void)player.world.step();
    for (std::size_t i = 0; i < bone_count; ++i)
      worst.add(pose_of(player.world, player.ragdoll.bodies[i]), places[tick][i]);
  }
  std::printf("played: within %.3g m, %.3g rad\n", worst.place, worst.turn);
  EXPECT_LT(worst.place, 1e-3);
  EXPECT_LT(worst.turn, 1e-3);
}

// Joints turn by random steps of up to 0.7 rad a tick: nothing comes apart.
TEST(Ragdolls, HoldTogetherWhenTheyAreShaken) {
  std::mt19937 random(20261126);
  const auto part = [&] { return static_cast<std::int32_t>(random() % 2001) - 1000; };
  Figure figure;
  RagdollPose from = walk(0);
  Error worst;
  for (int tick = 0; tick < 600; ++tick) {
    RagdollPose to = from;
    for (std::size_t i = 1; i < bone_count; ++i) {
      const bool turns_about_x = figure.bones[i].joint == JointKind::hinge;
      const Vec3<Length> any{Length::from_ratio(part(), 1000), Length::from_ratio(part(), 1000),
                             Length::from_ratio(part(), 999)};
      const Quat turn = from_axis_angle(turns_about_x ? k_x : normalized(any),
                                        Angle::from_ratio(part() * 7, 10'000));
      to.turns[i] = normalized(multiply(from.turns[i], turn));
    }
    ASSERT_EQ(figure.drive(from, to), Status::ok);
    (void)figure.world.step();
    add_errors(figure, to, k_all, worst);
    from = to;
  }
  std::printf("shaken: within %.3g m, %.3g rad\n", worst.place, worst.turn);
  EXPECT_LT(worst.place, 1e-3);
}

TEST(Ragdolls, AreLimpInPart) {
  Figure figure;
  figure.drives[arm].mode = figure.drives[hand].mode = BoneMode::limp;
  constexpr BoneIndex k_driven[] = {hips, chest, head, thigh, shin};
  constexpr BoneIndex k_limp[] = {hand};
  Error driven, limp;
  for (int tick = 0; tick < 120; ++tick) {
    figure.play(tick);
    add_errors(figure, walk(tick + 1), k_driven, driven);
    add_errors(figure, walk(tick + 1), k_limp, limp);
  }
  EXPECT_LT(driven.place, 1e-5);
  EXPECT_GT(limp.place, 0.1);
}

TEST(Ragdolls, SpringsYieldToWeightAndComeBack) {
  Figure figure;
  for (std::size_t i = 1; i < bone_count; ++i)
    figure.drives[i] = {.mode = BoneMode::sprung, .hertz = 30_r};
  const RagdollPose still = walk(0);
  const auto error = [&](int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      EXPECT_EQ(figure.drive(still, still), Status::ok);
      (void)figure.world.step();
    }
    Error now;
    add_errors(figure, still, k_all, now);
    return now.place;
  };
  EXPECT_LT(error(120), 0.02);
  const Vec3<Impulse> blow{{}, {}, 3_Ns};
  ASSERT_EQ(figure.world.apply(ApplyImpulse{figure.ragdoll.bodies[hand], blow, Frame::world}),
            Status::ok);
  EXPECT_GT(error(4), 0.03);
  EXPECT_LT(error(300), 0.02);
}

TEST(Ragdolls, HoldTheLastPoseUntilTheNextCall) {
  Figure figure;
  for (int tick = 0; tick < 20; ++tick)
    figure.play(tick);
  ASSERT_EQ(figure.drive(walk(20), walk(20)), Status::ok);
  test::step(figure.world, 60);
  Error error;
  add_errors(figure, walk(20), k_all, error);
  EXPECT_LT(error.place, 1e-5);
}

// All bones are kinematic, then limp, then driven.
TEST(Ragdolls, ChangeTheirModes) {
  Figure figure;
  const auto set = [&](BoneMode mode) {
    for (BoneDrive& drive : figure.drives)
      drive.mode = mode;
  };
  set(BoneMode::kinematic);
  for (int tick = 0; tick < 10; ++tick)
    figure.play(tick);
  EXPECT_EQ(figure.motion(hand), MotionType::kinematic);
  EXPECT_EQ(figure.world.joint_count(), 0U);
  Error error;
  add_errors(figure, walk(10), k_all, error);
  EXPECT_LT(error.place, 1e-6);
  set(BoneMode::limp);
  figure.play(10);
  EXPECT_EQ(figure.world.joint_count(), 6U);
  EXPECT_EQ(figure.motion(hips), MotionType::dynamic);
  EXPECT_EQ(figure.world.mass(figure.ragdoll.bodies[head]), figure.ragdoll.masses[head]);
  set(BoneMode::driven);
  figure.drives[hips].mode = figure.drives[chest].mode = BoneMode::kinematic;
  for (int tick = 11; tick < 80; ++tick)
    figure.play(tick);
  EXPECT_EQ(figure.world.joint_count(), 5U);
  Error again;
  add_errors(figure, walk(80), k_all, again);
  EXPECT_LT(again.place, 1e-3);
}

TEST(Ragdolls, LeaveATornOffLimbAlone) {
  Figure figure;
  figure.play(0);
  ASSERT_EQ(figure.world.apply(DestroyJoint{figure.ragdoll.joints[arm]}), Status::ok);
  for (int tick = 1; tick < 60; ++tick)
    figure.play(tick);
  EXPECT_EQ(figure.world.joint_count(), 5U);
  EXPECT_LT(metres(figure.world.position(figure.ragdoll.bodies[arm]).y), -1);
}

TEST(Ragdolls, ReadBackThePoseTheyWereMadeIn) {
  const Figure figure;
  const RagdollPose read = pose_of(figure.world, figure.def, figure.ragdoll), made = walk(0);
  for (std::size_t i = 1; i < bone_count; ++i)
    EXPECT_LT(angle_between(read.turns[i], made.turns[i]), 0.0000001_rad) << i;
  EXPECT_EQ(read.root.position, made.root.position);
  EXPECT_EQ(figure.world.body(figure.ragdoll.bodies[hand]).user_data, 7U);
}

TEST(Ragdolls, SayWhyTheyAreRefused) {
  const auto refused = [](auto change) {
    Figure figure;
    const std::uint32_t before = figure.world.body_count();
    change(figure.bones);
    const RagdollDef def{.bones = figure.bones};
    EXPECT_FALSE(create_ragdoll(figure.world, def, {}).ok());
    EXPECT_EQ(figure.world.body_count(), before);
    return explain(figure.world, def).to_line();
  };
  EXPECT_EQ(refused([](auto& bones) { bones.clear(); }), "ragdoll.bones.size: 0, must be 1 … 64");
  EXPECT_EQ(refused([](auto& bones) { bones[hand].parent = shin; }),
            "bones[4].parent: 6, must be the index of a bone before this one");
  EXPECT_EQ(refused([](auto& bones) { bones[hips].parent = 0; }),
            "bones[0].parent: 0, must be k_no_bone for the first bone");
  EXPECT_EQ(refused([](auto& bones) { bones[arm].joint = JointKind::wheel; }),
            "bones[3].joint: wheel, must be ball, hinge or weld");
  EXPECT_EQ(refused([](auto& bones) { bones[arm].max_swing = -0.5_rad; }),
            "bones[3].max_swing: -0.5 rad, must be 0 … 3.14159265 rad");
  EXPECT_EQ(refused([](auto& bones) { bones[head].shape = Shape::sphere({}); }),
            "bones[2].body.shape.radius: 0 m, must be 0.000977 … 512 m");
}

TEST(Ragdolls, LeaveNothingBehindWhereThereIsNoRoom) {
  World world = test::make_world({.body_capacity = 64, .joint_capacity = 3});
  const std::vector<Bone> bones = half_figure();
  EXPECT_EQ(create_ragdoll(world, {.bones = bones}, {}).status(), Status::capacity_exhausted);
  EXPECT_EQ(world.body_count(), 0U);
  EXPECT_EQ(world.joint_count(), 0U);
}

TEST(Ragdolls, ChangeNothingWhereADriveIsRefused) {
  Figure figure;
  const std::uint64_t before = figure.world.hash().total;
  const auto refuses = [&](auto change, Status status) {
    Figure bad;
    change(bad);
    EXPECT_EQ(bad.drive(walk(0), walk(1)), status);
    EXPECT_EQ(bad.world.hash().total, before);
  };
  const auto set = [](auto field, auto value) {
    return [=](Figure& bad) { bad.drives[arm].*field = value; };
  };
  refuses(set(&BoneDrive::hertz, Number{}), Status::invalid_argument);
  refuses(set(&BoneDrive::hertz, 1001_r), Status::invalid_argument);
  refuses(set(&BoneDrive::damping_ratio, -1_r), Status::invalid_argument);
  refuses(set(&BoneDrive::max_torque, Torque::from_integer(-1)), Status::invalid_argument);
  refuses(set(&BoneDrive::mode, BoneMode{9}), Status::invalid_argument);
  refuses([](Figure& bad) { bad.drives.resize(2); }, Status::invalid_argument);
  refuses([](Figure& bad) { bad.ragdoll.bodies[hand].generation = 9; }, Status::stale_handle);
  RagdollPose flat = walk(1);
  flat.turns[arm] = {{}, {}, {}, {}};
  EXPECT_EQ(figure.drive(walk(0), flat), Status::invalid_argument);
  EXPECT_EQ(figure.world.hash().total, before);
}

// Saved between the commands of a tick and its step, and loaded into another world.
TEST(Ragdolls, GoOnFromASnapshotTakenInTheMiddleOfATick) {
  for (const SnapshotKind kind : {SnapshotKind::native, SnapshotKind::canonical}) {
    Figure figure, other;
    for (int tick = 0; tick < 30; ++tick)
      figure.play(tick);
    ASSERT_EQ(figure.drive(walk(30), walk(31)), Status::ok);
    std::vector<std::byte> bytes(figure.world.snapshot_bytes_max(kind));
    bytes.resize(figure.world.save(kind, bytes));
    World& loaded = kind == SnapshotKind::native ? figure.world : other.world;
    (void)figure.world.step();
    const std::uint64_t after = figure.world.hash().total;
    ASSERT_EQ(loaded.load(kind, bytes), Status::ok);
    (void)loaded.step();
    EXPECT_EQ(loaded.hash().total, after);
  }
}

// A lock turns once, at the speed that the command gave: then its speed is 0.
TEST(TurningLocks, ArriveAndStay) {
  Figure figure;
  JointDef weld = JointDef::of(JointKind::weld, figure.ragdoll.bodies[hips], {});
  BodyDef body = test::dynamic_body(Shape::box(0.1_m, 0.3_m, 0.2_m), 1_m, 2_m, {});
  body.filter.group = -1;
  weld.body_b = test::add(figure.world, body);
  weld.frame_a.position = {1_m, {}, {}};
  const JointHandle joint = figure.world.create_joint(weld).value();
  figure.play(0);
  const AngularAxis turn{.mode = AxisMode::locked, .target = 0.05_rad, .speed = 3_rps};
  ASSERT_EQ(figure.world.apply(SetAngularAxis{joint, 1, turn}), Status::ok);
  figure.play(1);
  const auto angle = [&] { return std::ldexp(figure.world.joint(joint).angle.y.raw, -27); };
  EXPECT_NEAR(angle(), 0.05, 1e-7);
  for (int tick = 2; tick < 30; ++tick) {
    figure.play(tick);
    ASSERT_NEAR(angle(), 0.05, 1e-6) << tick;
  }
}

}  // namespace
}  // namespace lockstone
