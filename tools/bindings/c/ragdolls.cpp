// Ragdolls and drags.
#include <algorithm>
#include <vector>

#include <lockstone/drag.h>
#include <lockstone/ragdoll.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

static_assert(LKS_MAX_BONES == k_max_bones && LKS_NO_BONE == k_no_bone);

Quat rotation_of(const lks_quat& raw, const char* field) {
  if ((raw.x | raw.y | raw.z | raw.w) == 0) throw_invalid(field, "a rotation must not be all 0");
  return quat_of(raw);
}

Transform transform_of(const lks_pose& pose, const char* field) {
  return {place_of(&pose.position, field), rotation_of(pose.orientation, field)};
}

lks_bone raw_of(const Bone& bone) {
  lks_bone raw{};
  raw.parent = bone.parent;
  raw.joint = static_cast<std::uint32_t>(bone.joint);
  raw.shape = c::raw_of(bone.shape);
  raw.pose = c::raw_of(bone.pose);
  raw.joint_frame = c::raw_of(bone.joint_frame);
  raw.mass = bone.mass.raw;
  raw.friction = bone.friction.raw;
  raw.surface = c::raw_of(bone.material.surface());
  raw.density = bone.material.density.raw;
  raw.min_twist = bone.min_twist.raw;
  raw.max_twist = bone.max_twist.raw;
  raw.max_swing = bone.max_swing.raw;
  return raw;
}

Bone bone_of(const lks_bone& raw) {
  if (raw.reserved != 0) throw_invalid("bone", "reserved must be 0");
  Bone bone;
  bone.parent = raw.parent;
  bone.joint = enumerator(raw.joint, JointKind::distance, k_last_joint_kind, "bone.joint");
  bone.shape = shape_of(raw.shape, "bone.shape.kind");
  bone.pose = transform_of(raw.pose, "bone.pose");
  bone.joint_frame = transform_of(raw.joint_frame, "bone.joint_frame");
  bone.mass = Mass::from_raw(raw.mass);
  bone.friction = Torque::from_raw(raw.friction);
  bone.material = material_of(surface_of(raw.surface, "bone.surface"), raw.density);
  bone.min_twist = Angle::from_raw(raw.min_twist);
  bone.max_twist = Angle::from_raw(raw.max_twist);
  bone.max_swing = Angle::from_raw(raw.max_swing);
  return bone;
}

// A definition with its bones, which it refers to.
class Skeleton {
 public:
  Skeleton(const lks_bone* bones, std::size_t count, const lks_ragdoll_def* def = nullptr) {
    if (count < 1 || count > k_max_bones) throw_invalid("bone_count", "must be 1 … 64");
    (void)array(bones, count, "bones");
    for (std::size_t i = 0; i < count; ++i)
      bones_.push_back(bone_of(bones[i]));
    for (std::size_t i = 0; i < count; ++i)
      if (i == 0 ? bones_[i].parent != k_no_bone : bones_[i].parent >= i)
        throw_invalid("bone.parent", "must be a bone before, of the first LKS_NO_BONE");
    def_.bones = bones_;
    if (def == nullptr) return;
    const lks_ragdoll_def raw = take(def, defaults(), "def");
    def_.filter = filter_of(raw.filter);
    def_.user_data = raw.user_data;
  }
  Skeleton(const Skeleton&) = delete;
  Skeleton& operator=(const Skeleton&) = delete;

  static lks_ragdoll_def defaults() {
    return {sizeof(lks_ragdoll_def), c::raw_of(CollisionFilter{}), 0};
  }

  [[nodiscard]] const RagdollDef& def() const { return def_; }
  [[nodiscard]] std::size_t size() const { return bones_.size(); }

 private:
  std::vector<Bone> bones_;
  RagdollDef def_;
};

lks_ragdoll_pose raw_of(const RagdollPose& pose) {
  lks_ragdoll_pose raw{};
  raw.root = c::raw_of(pose.root);
  for (std::size_t i = 0; i < k_max_bones; ++i)
    raw.turns[i] = c::raw_of(pose.turns[i]);
  return raw;
}

RagdollPose pose_of(const lks_ragdoll_pose* from, std::size_t bones) {
  const lks_ragdoll_pose& raw = required(from, "pose");
  RagdollPose pose;
  pose.root = transform_of(raw.root, "pose.root");
  for (std::size_t i = 1; i < bones; ++i)
    pose.turns[i] = rotation_of(raw.turns[i], "pose.turns");
  return pose;
}

lks_ragdoll raw_of(const Ragdoll& ragdoll) {
  lks_ragdoll raw{};
  raw.size = sizeof raw;
  raw.bone_count = ragdoll.bone_count;
  for (std::size_t i = 0; i < ragdoll.bone_count; ++i) {
    raw.bodies[i] = id_of(ragdoll.bodies[i]);
    raw.joints[i] = id_of(ragdoll.joints[i]);
    raw.masses[i] = ragdoll.masses[i].raw;
  }
  return raw;
}

Ragdoll ragdoll_of(const lks_ragdoll* from) {
  const lks_ragdoll raw = take(from, lks_ragdoll{}, "ragdoll");
  if (raw.bone_count > k_max_bones) throw_invalid("ragdoll.bone_count", "must be 1 … 64");
  Ragdoll ragdoll;
  ragdoll.bone_count = raw.bone_count;
  for (std::size_t i = 0; i < raw.bone_count; ++i) {
    ragdoll.bodies[i] = handle_of<BodyHandle>(raw.bodies[i]);
    ragdoll.joints[i] = handle_of<JointHandle>(raw.joints[i]);
    ragdoll.masses[i] = Mass::from_raw(raw.masses[i]);
  }
  return ragdoll;
}

// Of as many bones as the skeleton has.
Ragdoll ragdoll_of(const lks_ragdoll* from, const Skeleton& skeleton) {
  const Ragdoll ragdoll = ragdoll_of(from);
  if (ragdoll.bone_count != skeleton.size())
    throw_invalid("ragdoll.bone_count", "must be the number of bones");
  return ragdoll;
}

lks_bone_drive raw_of(const BoneDrive& drive) {
  return {static_cast<std::uint32_t>(drive.mode), drive.hertz.raw, drive.damping_ratio.raw, 0,
          drive.max_torque.raw};
}

BoneDrive drive_of(const lks_bone_drive& raw) {
  if (raw.reserved != 0) throw_invalid("drive", "reserved must be 0");
  return {enumerator(raw.mode, BoneMode::limp, BoneMode::kinematic, "drive.mode"),
          Number::from_raw(raw.hertz), Number::from_raw(raw.damping_ratio),
          Torque::from_raw(raw.max_torque)};
}

lks_drag raw_of(const Drag& drag) {
  return {sizeof(lks_drag), c::raw_of(drag.point),  id_of(drag.ground), id_of(drag.body),
          drag.hertz.raw,   drag.damping_ratio.raw, drag.max_force.raw};
}

Drag drag_of(const World& world, const lks_drag* from) {
  const lks_drag raw = take(from, raw_of(Drag{}), "drag");
  return {existing_body(world, raw.ground),
          existing_body(world, raw.body),
          vec<Length>(raw.point),
          Number::from_raw(raw.hertz),
          Number::from_raw(raw.damping_ratio),
          Force::from_raw(raw.max_force)};
}

}  // namespace

lks_status lks_bone_init(lks_bone* bone) {
  return call([&] { required(bone, "bone") = raw_of(Bone{}); });
}

lks_status lks_ragdoll_def_init(lks_ragdoll_def* def, size_t size) {
  return call([&] { give(Skeleton::defaults(), def, size, "def"); });
}

lks_status lks_ragdoll_pose_init(lks_ragdoll_pose* pose) {
  return call([&] { required(pose, "pose") = raw_of(RagdollPose{}); });
}

lks_status lks_bone_drive_init(lks_bone_drive* drive) {
  return call([&] { required(drive, "drive") = raw_of(BoneDrive{}); });
}

lks_status lks_create_ragdoll(lks_world* world, const lks_ragdoll_def* def, const lks_bone* bones,
                              size_t bone_count, const lks_ragdoll_pose* pose, lks_ragdoll* out) {
  return call([&] {
    World& to = write(world);
    const Skeleton skeleton(bones, bone_count, &required(def, "def"));
    const RagdollPose stands = pose_of(pose, bone_count);
    const std::uint32_t size = required(out, "out").size;
    check_size<lks_ragdoll>(size, "out");
    const Result<Ragdoll> made = create_ragdoll(to, skeleton.def(), stands);
    if (!made.ok()) throw_failure(made.status(), explain(to, skeleton.def()));
    give(raw_of(made.value()), out, size, "out");
  });
}

lks_status lks_destroy_ragdoll(lks_world* world, const lks_ragdoll* ragdoll) {
  return call([&] { destroy_ragdoll(write(world), ragdoll_of(ragdoll)); });
}

lks_status lks_drive_ragdoll(lks_world* world, const lks_ragdoll_def* def, const lks_bone* bones,
                             size_t bone_count, lks_ragdoll* ragdoll, const lks_ragdoll_pose* from,
                             const lks_ragdoll_pose* to, const lks_bone_drive* drives,
                             size_t drive_count) {
  return call([&] {
    World& target = write(world);
    const Skeleton skeleton(bones, bone_count, &required(def, "def"));
    Ragdoll driven = ragdoll_of(ragdoll, skeleton);
    if (drive_count != 1 && drive_count != bone_count)
      throw_invalid("drive_count", "must be 1 or the number of bones");
    (void)array(drives, drive_count, "drives");
    std::vector<BoneDrive> list;
    for (std::size_t i = 0; i < drive_count; ++i)
      list.push_back(drive_of(drives[i]));
    const Status status = drive_ragdoll(target, skeleton.def(), driven, pose_of(from, bone_count),
                                        pose_of(to, bone_count), list);
    give(raw_of(driven), ragdoll, ragdoll->size, "ragdoll");
    if (status != Status::ok) throw_failure(status);
  });
}

lks_status lks_ragdoll_pose_get(const lks_world* world, const lks_bone* bones, size_t bone_count,
                                const lks_ragdoll* ragdoll, lks_ragdoll_pose* out) {
  return call([&] {
    const World& from = read(world);
    const Skeleton skeleton(bones, bone_count);
    const Ragdoll stands = ragdoll_of(ragdoll, skeleton);
    for (std::size_t i = 0; i < stands.bone_count; ++i)
      (void)existing_body(from, id_of(stands.bodies[i]));
    required(out, "out") = raw_of(lockstone::pose_of(from, skeleton.def(), stands));
  });
}

lks_status lks_bone_poses(const lks_bone* bones, size_t bone_count, const lks_ragdoll_pose* pose,
                          lks_pose* out) {
  return call([&] {
    const Skeleton skeleton(bones, bone_count);
    const RagdollPose stands = pose_of(pose, bone_count);
    std::vector<Transform> poses(bone_count);
    bone_poses(skeleton.def(), stands, poses);
    std::transform(poses.begin(), poses.end(), array(out, bone_count, "out"),
                   [](const Transform& place) { return c::raw_of(place); });
  });
}

lks_status lks_drag_init(lks_drag* drag, size_t size, lks_body ground, lks_body body) {
  return call([&] {
    const Drag made{.ground = handle_of<BodyHandle>(ground), .body = handle_of<BodyHandle>(body)};
    give(raw_of(made), drag, size, "drag");
  });
}

lks_status lks_create_drag(lks_world* world, const lks_drag* drag, const lks_position3* target,
                           lks_joint* out) {
  return call([&] {
    World& to = write(world);
    lks_joint& joint = required(out, "out");
    const JointDef def = drag_joint(to, drag_of(to, drag), place_of(target, "target"));
    const Result<JointHandle> made = to.create_joint(def);
    if (!made.ok()) throw_failure(made.status(), to.explain(def));
    joint = id_of(made.value());
  });
}

lks_status lks_move_drag(lks_world* world, lks_joint joint, const lks_drag* drag,
                         const lks_position3* target) {
  return call([&] {
    const World& to = write(world);
    for (const SetLinearAxis& command : drag_commands(
             to, handle_of<JointHandle>(joint), drag_of(to, drag), place_of(target, "target")))
      order(world, command);
  });
}
