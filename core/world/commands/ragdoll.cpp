// Ragdolls: their bodies and joints, and the poses in which they stand.

#include <lockstone/assert.h>
#include <lockstone/ragdoll.h>

#include "core/math/divide.h"
#include "core/math/rotation_log.h"
#include "core/world/commands/joint_checks.h"
#include "core/world/commands/ragdoll_bones.h"
#include "core/world/commands/refusal_finder.h"

namespace lockstone {
namespace {

constexpr Position k_most_place = Position::from_integer(500);

JointFrame on_body(const Transform& body, const Transform& joint) {
  const Transform frame = compose(inverse(body), joint);
  return {saturated<Length>(frame.position), frame.orientation};
}

Transform transform_of(const JointFrame& frame) {
  return {rounded<Position>(frame.position), frame.orientation};
}

Transform normal(const Transform& t) {
  return {t.position, normalized(t.orientation)};
}

bool has_joint(JointKind kind) {
  return kind == JointKind::ball || kind == JointKind::hinge || kind == JointKind::weld;
}

void check_place(RefusalFinder& find, std::string_view name, const Transform& place) {
  find.within(joined({name, ".position"}), place.position, k_most_place, "m");
  find.direction(joined({name, ".orientation"}), place.orientation);
}

void check_joint(RefusalFinder& find, const Bone& bone) {
  find.require(has_joint(bone.joint), "joint", to_string(bone.joint), "ball, hinge or weld");
  check_place(find, "joint_frame", bone.joint_frame);
  find.within("min_twist", bone.min_twist, -k_half_turn, Angle{}, "rad");
  find.within("max_twist", bone.max_twist, Angle{}, k_half_turn, "rad");
  find.within("max_swing", bone.max_swing, Angle{}, k_half_turn, "rad");
  find.within("friction", bone.friction, Torque{}, Torque::from_raw(k_effort_limit), "N·m");
}

Refusal check_bone(const RagdollDef& def, std::size_t i) {
  const Bone& bone = def.bones[i];
  RefusalFinder find(joined({"bones[", std::to_string(i), "]."}));
  const bool is_root = i == 0;
  find.require(is_root ? bone.parent == k_no_bone : bone.parent < i, "parent",
               bone.parent == k_no_bone ? "k_no_bone" : std::to_string(bone.parent),
               is_root ? "k_no_bone for the first bone" : "the index of a bone before this one");
  check_place(find, "pose", bone.pose);
  if (!is_root) check_joint(find, bone);
  return find.take();
}

BodyDef body_of(const RagdollDef& def, std::size_t bone, const Transform& pose) {
  const Bone& from = def.bones[bone];
  BodyDef body{.shape = from.shape,
               .position = pose.position,
               .orientation = pose.orientation,
               .material = from.material,
               .filter = def.filter,
               .user_data = def.user_data};
  body.mass.mass = from.mass;
  return body;
}

Status make_bodies(World& world, const RagdollDef& def, const RagdollPose& pose, Ragdoll& made) {
  std::array<Transform, k_max_bones> poses;
  bone_poses(def, pose, std::span(poses).first(def.bones.size()));
  for (std::size_t i = 0; i < def.bones.size(); ++i) {
    const Result<BodyHandle> body = world.create_body(body_of(def, i, poses[i]));
    if (!body.ok()) return body.status();
    made.bodies[i] = body.value();
    made.masses[i] = world.mass(body.value());
    ++made.bone_count;
  }
  return Status::ok;
}

Status make_joints(World& world, const RagdollDef& def, Ragdoll& made) {
  for (std::size_t i = 1; i < def.bones.size(); ++i) {
    const Result<JointHandle> joint = world.create_joint(joint_of(def, made, i));
    if (!joint.ok()) return joint.status();
    made.joints[i] = joint.value();
  }
  return Status::ok;
}

}  // namespace

BoneFrames frames_of(const RagdollDef& def, std::size_t bone) {
  const Bone& child = def.bones[bone];
  LKS_ASSERT(child.parent < bone);
  const Transform joint = normal(child.joint_frame);
  return {on_body(normal(def.bones[child.parent].pose), joint), on_body(normal(child.pose), joint)};
}

JointDef joint_of(const RagdollDef& def, const Ragdoll& ragdoll, std::size_t bone) {
  const Bone& child = def.bones[bone];
  JointDef joint = JointDef::of(child.joint, ragdoll.bodies[child.parent], ragdoll.bodies[bone]);
  const BoneFrames frames = frames_of(def, bone);
  joint.frame_a = frames.a;
  joint.frame_b = frames.b;
  joint.user_data = def.user_data;
  joint.angular = limp_axes(child);
  return joint;
}

std::array<AngularAxis, 3> limp_axes(const Bone& bone) {
  std::array<AngularAxis, 3> axes = JointDef::of(bone.joint, {}, {}).angular;
  for (AngularAxis& axis : axes)
    if (axis.mode == AxisMode::free) axis.max_effort = bone.friction;
  if (bone.joint == JointKind::weld) return axes;
  if (bone.max_twist < k_half_turn || bone.min_twist > -k_half_turn) {
    axes[0].mode = AxisMode::limited;
    axes[0].lower = bone.min_twist;
    axes[0].upper = bone.max_twist;
  }
  if (bone.joint == JointKind::ball && bone.max_swing < k_half_turn) {
    axes[1].mode = AxisMode::limited;
    axes[1].upper = bone.max_swing;
  }
  return axes;
}

Refusal check_bones(const RagdollDef& def) {
  RefusalFinder find("ragdoll.");
  find.within("bones.size", def.bones.size(), std::size_t{1}, k_max_bones);
  for (std::size_t i = 0; i < def.bones.size() && !find.done(); ++i)
    find.adopt(check_bone(def, i));
  return find.take();
}

Refusal explain(const World& world, const RagdollDef& def) {
  if (Refusal found = check_bones(def)) return found;
  for (std::size_t i = 0; i < def.bones.size(); ++i) {
    Refusal found = world.explain(body_of(def, i, {}));
    if (!found || found.field == "body.count") continue;
    found.field = "bones[" + std::to_string(i) + "]." + found.field;
    return found;
  }
  return {};
}

Result<Ragdoll> create_ragdoll(World& world, const RagdollDef& def, const RagdollPose& pose) {
  if (check_bones(def)) return Status::invalid_argument;
  Ragdoll made;
  Status status = make_bodies(world, def, pose, made);
  if (status == Status::ok) status = make_joints(world, def, made);
  if (status == Status::ok) return made;
  destroy_ragdoll(world, made);
  return status;
}

void destroy_ragdoll(World& world, const Ragdoll& ragdoll) {
  for (const BodyHandle body : std::span(ragdoll.bodies).first(ragdoll.bone_count))
    if (world.exists(body)) (void)world.apply(DestroyBody{body});
}

void bone_poses(const RagdollDef& def, const RagdollPose& pose, std::span<Transform> out) {
  if (out.size() != def.bones.size()) misused("bone_poses: `out` must be as long as `def.bones`");
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (i == 0) {
      out[i] = normal(pose.root);
      continue;
    }
    const BoneFrames frames = frames_of(def, i);
    const Transform turned = compose(transform_of(frames.a), {{}, normalized(pose.turns[i])});
    out[i] = compose(compose(out[def.bones[i].parent], turned), inverse(transform_of(frames.b)));
  }
}

RagdollPose pose_of(const World& world, const RagdollDef& def, const Ragdoll& ragdoll) {
  RagdollPose pose;
  pose.root = pose_of(world, ragdoll.bodies[0]);
  for (std::size_t i = 1; i < ragdoll.bone_count; ++i) {
    const BoneFrames frames = frames_of(def, i);
    const auto frame = [&](std::size_t bone, const JointFrame& at) {
      return multiply(pose_of(world, ragdoll.bodies[bone]).orientation, at.orientation);
    };
    pose.turns[i] =
        normalized(multiply(conjugate(frame(def.bones[i].parent, frames.a)), frame(i, frames.b)));
  }
  return pose;
}

std::string_view to_string(BoneMode mode) {
  constexpr std::string_view k_names[] = {"limp", "sprung", "driven", "kinematic"};
  const auto index = static_cast<std::size_t>(mode);
  return index < std::size(k_names) ? k_names[index] : "unknown";
}

}  // namespace lockstone
