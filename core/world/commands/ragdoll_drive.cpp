// Poses that drive the joints of a ragdoll.

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/ragdoll.h>

#include "core/math/rotation_log.h"
#include "core/world/commands/joint_checks.h"
#include "core/world/commands/ragdoll_bones.h"

namespace lockstone {
namespace {

bool is_drive(const BoneDrive& drive) {
  return drive.mode <= BoneMode::kinematic && drive.hertz >= Number::from_ratio(1, 100) &&
         drive.hertz <= Number::from_integer(1000) && drive.damping_ratio >= Number{} &&
         drive.damping_ratio <= Number::from_integer(100) && drive.max_torque >= Torque{} &&
         drive.max_torque.raw <= k_effort_limit;
}

bool has_valid_turns(const RagdollPose& pose, std::size_t bones) {
  return has_direction(pose.root.orientation) &&
         std::ranges::all_of(std::span(pose.turns).first(bones), has_direction);
}

struct JointTarget {
  Vec3<Angle> angle{};
  Vec3<Rate> speed{};
};

// The speed is that of the target in its own axes, as the springs of several axes count it.
JointTarget target_of(const Quat& from, const Quat& to, std::int64_t tick_rate) {
  const Quat start = normalized(from), end = normalized(to);
  const RotationVector turn = rotation_between({}, end);
  const RotationVector step = rotation_between({}, normalized(multiply(conjugate(start), end)));
  JointTarget target;
  for (int i = 0; i < 3; ++i) {
    const auto angle = static_cast<std::int32_t>(raw::round_shift(turn[i].raw, 5));
    target.angle[i] = std::clamp(Angle::from_raw(angle), -k_half_turn, k_half_turn);
    target.speed[i] =
        Rate::from_raw(raw::saturate<std::int32_t>(raw::round_shift(step[i].raw * tick_rate, 12)));
  }
  return target;
}

AngularAxis settings_of(const BoneDrive& drive, const AngularAxis& limp, Angle target, Rate speed) {
  AngularAxis axis = limp;
  if (limp.mode == AxisMode::locked || drive.mode == BoneMode::limp ||
      drive.mode == BoneMode::kinematic)
    return axis;
  axis.target = target;
  axis.speed = speed;
  axis.max_effort = {};
  if (drive.mode == BoneMode::driven) {
    axis.mode = AxisMode::locked;
    return axis;
  }
  axis.hertz = drive.hertz;
  axis.damping_ratio = drive.damping_ratio;
  axis.max_effort = drive.max_torque;
  return axis;
}

class RagdollDriver {
 public:
  RagdollDriver(World& world, const RagdollDef& def, Ragdoll& ragdoll,
                std::span<const BoneDrive> drives)
      : world_(world), def_(def), ragdoll_(ragdoll), drives_(drives) {}

  // In such an order that every joint always has a dynamic body.
  void change_modes() {
    for (std::size_t i = 0; i < count(); ++i)
      if (!is_kinematic(i) && stands_as(i, MotionType::kinematic))
        note(world_.apply(
            SetMotionType{ragdoll_.bodies[i], MotionType::dynamic, ragdoll_.masses[i]}));
    for (std::size_t i = 1; i < count(); ++i)
      if (is_rigid(i)) take_out_joint(i);
    for (std::size_t i = 0; i < count(); ++i)
      if (is_kinematic(i) && stands_as(i, MotionType::dynamic))
        note(world_.apply(SetMotionType{ragdoll_.bodies[i], MotionType::kinematic, {}}));
    for (std::size_t i = 1; i < count(); ++i)
      if (!is_rigid(i) && ragdoll_.joints[i].is_null()) put_in_joint(i);
  }

  void drive(const RagdollPose& from, const RagdollPose& to) {
    std::array<Transform, k_max_bones> poses;
    bone_poses(def_, to, std::span(poses).first(count()));
    for (std::size_t i = 0; i < count(); ++i) {
      if (is_kinematic(i))
        note(world_.apply(
            MoveKinematic{ragdoll_.bodies[i], poses[i].position, poses[i].orientation}));
      if (i > 0 && world_.exists(ragdoll_.joints[i])) set_targets(i, from.turns[i], to.turns[i]);
    }
  }

  [[nodiscard]] Status status() const { return status_; }

 private:
  [[nodiscard]] std::size_t count() const { return def_.bones.size(); }
  [[nodiscard]] const BoneDrive& drive_of(std::size_t bone) const {
    return drives_[drives_.size() == 1 ? 0 : bone];
  }
  [[nodiscard]] bool is_kinematic(std::size_t bone) const {
    return drive_of(bone).mode == BoneMode::kinematic;
  }
  [[nodiscard]] bool is_rigid(std::size_t bone) const {
    return is_kinematic(bone) && is_kinematic(def_.bones[bone].parent);
  }
  [[nodiscard]] bool stands_as(std::size_t bone, MotionType motion) const {
    return world_.body(ragdoll_.bodies[bone]).motion == motion;
  }
  void note(Status status) {
    if (status_ == Status::ok) status_ = status;
  }

  void take_out_joint(std::size_t bone) {
    JointHandle& joint = ragdoll_.joints[bone];
    if (!world_.exists(joint)) return;
    note(world_.apply(DestroyJoint{joint}));
    joint = {};
  }

  void put_in_joint(std::size_t bone) {
    const Result<JointHandle> joint = world_.create_joint(joint_of(def_, ragdoll_, bone));
    note(joint.status());
    if (joint.ok()) ragdoll_.joints[bone] = joint.value();
  }

  // The drive of a bone's joint.
  [[nodiscard]] const BoneDrive& joint_drive(std::size_t bone) const {
    return is_kinematic(bone) ? drive_of(def_.bones[bone].parent) : drive_of(bone);
  }

  void set_targets(std::size_t bone, const Quat& from, const Quat& to) {
    const std::array<AngularAxis, 3> axes = limp_axes(def_.bones[bone]);
    const BoneDrive& drive = joint_drive(bone);
    const JointTarget target = target_of(from, to, world_.def().tick_rate);
    for (int i = 0; i < 3; ++i) {
      const AngularAxis& limp = axes[static_cast<std::size_t>(i)];
      const AngularAxis axis = settings_of(drive, limp, target.angle[i], target.speed[i]);
      note(world_.apply(SetAngularAxis{ragdoll_.joints[bone], static_cast<std::uint8_t>(i), axis}));
    }
  }

  World& world_;
  const RagdollDef& def_;
  Ragdoll& ragdoll_;
  std::span<const BoneDrive> drives_;
  Status status_ = Status::ok;
};

}  // namespace

Status drive_ragdoll(World& world, const RagdollDef& def, Ragdoll& ragdoll, const RagdollPose& from,
                     const RagdollPose& to, std::span<const BoneDrive> drives) {
  const std::size_t bones = def.bones.size();
  const bool fits = bones == ragdoll.bone_count && bones > 0 && bones <= k_max_bones &&
                    (drives.size() == 1 || drives.size() == bones);
  if (!fits || !std::ranges::all_of(drives, is_drive) || !has_valid_turns(from, bones) ||
      !has_valid_turns(to, bones)) {
    return Status::invalid_argument;
  }
  const auto exists = [&](BodyHandle body) { return world.exists(body); };
  if (!std::ranges::all_of(std::span(ragdoll.bodies).first(bones), exists))
    return Status::stale_handle;
  RagdollDriver driver(world, def, ragdoll, drives);
  driver.change_modes();
  driver.drive(from, to);
  return driver.status();
}

}  // namespace lockstone
