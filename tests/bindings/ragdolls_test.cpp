// Ragdolls and drags do the same through the C interface as in the core.
#include <array>

#include <gtest/gtest.h>

#include <lockstone/drag.h>
#include <lockstone/ragdoll.h>

#include "tests/bindings/twin_worlds.h"

namespace lockstone {
namespace {

using namespace lockstone::literals;

// A trunk with two limbs: one on a ball, one on a hinge.
std::array<Bone, 3> three_bones() {
  std::array<Bone, 3> bones;
  bones[0].shape = Shape::box(0.2_m, 0.3_m, 0.1_m);
  for (std::size_t i = 1; i < 3; ++i) {
    const Position side = i == 1 ? Position::from_ratio(4, 10) : Position::from_ratio(-4, 10);
    bones[i].parent = 0;
    bones[i].pose.position = {side + side, {}, {}};
    bones[i].joint_frame.position = {side, {}, {}};
    bones[i].friction = Torque::from_integer(2);
    bones[i].max_swing = Angle::from_integer(1);
  }
  bones[2].joint = JointKind::hinge;
  bones[2].min_twist = -Angle::from_ratio(1, 2);
  bones[2].max_twist = Angle::from_integer(1);
  bones[2].mass = Mass::from_integer(3);
  return bones;
}

class RagdollsThroughC : public TwinWorlds {
 protected:
  void SetUp() override {
    TwinWorlds::SetUp();
    ground_ = add(MotionType::static_body, Shape::half_space(), 0, 0);
    pose_.root.position = {{}, 3_m, {}};
    ASSERT_EQ(lks_ragdoll_def_init(&raw_def_, sizeof raw_def_), LKS_OK);
    raw_def_.user_data = def_of_ragdoll_.user_data = 77;
    for (std::size_t i = 0; i < 3; ++i) {
      const Bone& bone = bones_[i];
      lks_bone& raw = raw_bones_[i];
      ASSERT_EQ(lks_bone_init(&raw), LKS_OK);
      raw.parent = bone.parent;
      raw.joint = static_cast<std::uint32_t>(bone.joint);
      raw.shape = c::raw_of(bone.shape);
      raw.pose.position = c::raw_of(bone.pose.position);
      raw.joint_frame.position = c::raw_of(bone.joint_frame.position);
      raw.mass = bone.mass.raw;
      raw.friction = bone.friction.raw;
      raw.min_twist = bone.min_twist.raw;
      raw.max_twist = bone.max_twist.raw;
      raw.max_swing = bone.max_swing.raw;
    }
    ASSERT_EQ(lks_ragdoll_pose_init(&raw_pose_), LKS_OK);
    raw_pose_.root.position = c::raw_of(pose_.root.position);
    raw_ragdoll_.size = sizeof raw_ragdoll_;
  }

  void make() {
    ragdoll_ = create_ragdoll(*world_, def_of_ragdoll_, pose_).value();
    ASSERT_EQ(lks_create_ragdoll(twin_, &raw_def_, raw_bones_.data(), 3, &raw_pose_, &raw_ragdoll_),
              LKS_OK)
        << lks_last_error();
    expect_same_state("create");
  }

  lks_status drive(const lks_ragdoll_pose& to, const lks_bone_drive& drive) {
    return lks_drive_ragdoll(twin_, &raw_def_, raw_bones_.data(), 3, &raw_ragdoll_, &raw_pose_, &to,
                             &drive, 1);
  }

  BodyHandle ground_;
  std::array<Bone, 3> bones_ = three_bones();
  RagdollDef def_of_ragdoll_{.bones = bones_};
  RagdollPose pose_;
  Ragdoll ragdoll_;
  std::array<lks_bone, 3> raw_bones_{};
  lks_ragdoll_def raw_def_{};
  lks_ragdoll_pose raw_pose_{};
  lks_ragdoll raw_ragdoll_{};
};

TEST_F(RagdollsThroughC, GiveTheSameStateInEachModeOfTheirBones) {
  make();
  EXPECT_EQ(raw_ragdoll_.bone_count, 3U);
  RagdollPose bent = pose_;
  bent.turns[1] = from_axis_angle({{}, {}, Unit::from_integer(1)}, Angle::from_ratio(1, 2));
  lks_ragdoll_pose raw_bent = raw_pose_;
  raw_bent.turns[1] = c::raw_of(bent.turns[1]);
  lks_bone_drive raw_drive;
  ASSERT_EQ(lks_bone_drive_init(&raw_drive), LKS_OK);
  for (const BoneMode mode :
       {BoneMode::driven, BoneMode::sprung, BoneMode::kinematic, BoneMode::limp}) {
    const BoneDrive bone_drive{.mode = mode, .max_torque = Torque::from_integer(50)};
    raw_drive.mode = static_cast<std::uint32_t>(mode);
    raw_drive.max_torque = bone_drive.max_torque.raw;
    expect_same(
        drive_ragdoll(*world_, def_of_ragdoll_, ragdoll_, pose_, bent, std::span(&bone_drive, 1)),
        drive(raw_bent, raw_drive), "drive");
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(raw_ragdoll_.joints[i], c::id_of(ragdoll_.joints[i]));
    step(20);
  }
  const RagdollPose stands = pose_of(*world_, def_of_ragdoll_, ragdoll_);
  lks_ragdoll_pose raw_stands{};
  ASSERT_EQ(lks_ragdoll_pose_get(twin_, raw_bones_.data(), 3, &raw_ragdoll_, &raw_stands), LKS_OK);
  EXPECT_EQ(c::vec<Position>(raw_stands.root.position), stands.root.position);
  EXPECT_EQ(c::quat_of(raw_stands.turns[2]), stands.turns[2]);
  destroy_ragdoll(*world_, ragdoll_);
  ASSERT_EQ(lks_destroy_ragdoll(twin_, &raw_ragdoll_), LKS_OK);
  expect_same_state("destroy");
}

TEST_F(RagdollsThroughC, HaveThePosesOfTheirBones) {
  std::array<Transform, 3> poses;
  bone_poses(def_of_ragdoll_, pose_, poses);
  std::array<lks_pose, 3> raw_poses{};
  ASSERT_EQ(lks_bone_poses(raw_bones_.data(), 3, &raw_pose_, raw_poses.data()), LKS_OK);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(c::vec<Position>(raw_poses[i].position), poses[i].position);
}

TEST_F(RagdollsThroughC, RefuseWrongBonesAndChangeNothing) {
  const auto create = [&] {
    return lks_create_ragdoll(twin_, &raw_def_, raw_bones_.data(), 3, &raw_pose_, &raw_ragdoll_);
  };
  const auto expect_refused = [&](auto& field, auto wrong) {
    const auto right = field;
    field = wrong;
    EXPECT_EQ(create(), LKS_INVALID_ARGUMENT) << lks_last_error();
    expect_same_state("refused");
    field = right;
  };
  expect_refused(raw_bones_[0].parent, 0U);
  expect_refused(raw_bones_[2].parent, 2U);
  expect_refused(raw_bones_[1].joint, 99U);
  expect_refused(raw_bones_[1].reserved, 1U);
  expect_refused(raw_bones_[2].min_twist, 1);
  expect_refused(raw_bones_[1].joint_frame.position.x, Position::from_integer(501).raw);
  expect_refused(raw_bones_[0].pose.orientation, lks_quat{});
  expect_refused(raw_pose_.turns[1], lks_quat{});
  EXPECT_EQ(lks_create_ragdoll(twin_, &raw_def_, raw_bones_.data(), 0, &raw_pose_, &raw_ragdoll_),
            LKS_INVALID_ARGUMENT);
  raw_ragdoll_.size = 8;
  EXPECT_EQ(create(), LKS_WRONG_SIZE);
}

TEST_F(RagdollsThroughC, AreStaleOnceABoneIsGone) {
  make();
  ASSERT_EQ(lks_destroy_body(twin_, raw_ragdoll_.bodies[1]), LKS_OK);
  lks_bone_drive raw_drive;
  ASSERT_EQ(lks_bone_drive_init(&raw_drive), LKS_OK);
  EXPECT_EQ(drive(raw_pose_, raw_drive), LKS_STALE_HANDLE);
  lks_ragdoll_pose out{};
  EXPECT_EQ(lks_ragdoll_pose_get(twin_, raw_bones_.data(), 3, &raw_ragdoll_, &out),
            LKS_STALE_HANDLE);
}

TEST_F(RagdollsThroughC, ADragGivesTheSameState) {
  const BodyHandle box = add(MotionType::dynamic, Shape::box(0.5_m, 0.5_m, 0.5_m), 2, 2);
  const Drag drag{.ground = ground_, .body = box, .point = {0.5_m, 0_m, 0_m}};
  lks_drag raw;
  ASSERT_EQ(lks_drag_init(&raw, sizeof raw, c::id_of(ground_), c::id_of(box)), LKS_OK);
  raw.point = c::raw_of(drag.point);
  Vec3<Position> target{2_m, 5_m, 1_m};
  lks_position3 raw_target = c::raw_of(target);
  const JointHandle joint = world_->create_joint(drag_joint(*world_, drag, target)).value();
  lks_joint raw_joint = 0;
  ASSERT_EQ(lks_create_drag(twin_, &raw, &raw_target, &raw_joint), LKS_OK) << lks_last_error();
  EXPECT_EQ(raw_joint, c::id_of(joint));
  step(10);
  target.x = -Position::from_integer(3);
  raw_target = c::raw_of(target);
  for (const SetLinearAxis& command : drag_commands(*world_, joint, drag, target))
    ASSERT_EQ(world_->apply(command), Status::ok);
  ASSERT_EQ(lks_move_drag(twin_, raw_joint, &raw, &raw_target), LKS_OK);
  step(40);
  raw.body = 12345;
  EXPECT_EQ(lks_move_drag(twin_, raw_joint, &raw, &raw_target), LKS_STALE_HANDLE);
}

}  // namespace
}  // namespace lockstone
