// Ragdolls: the bodies and joints of a skeleton, and poses that drive its joints.
//
// A ragdoll is no object of the world: it is bodies and joints, made and changed by commands alone.
// The handles are the game's own state; a game that rolls back saves them with the rest.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <lockstone/body.h>
#include <lockstone/joint.h>
#include <lockstone/refusal.h>
#include <lockstone/status.h>
#include <lockstone/transform.h>
#include <lockstone/world.h>

namespace lockstone {

/// The most bones of a ragdoll.
inline constexpr std::size_t k_max_bones = 64;
/// The parent of the root.
inline constexpr std::uint32_t k_no_bone = 0xffffffff;
/// π, rounded down: limits as wide as this are none.
inline constexpr Angle k_half_turn = Angle::from_raw(421657428);

/// A bone of a skeleton. Both poses are those of the bind pose, in the axes of the skeleton. There
/// every joint stands at 0. Positions within 500 m.
struct Bone {
  std::uint32_t parent = k_no_bone;  ///< a bone before this one; k_no_bone of the first alone
  Transform pose{};                  ///< of the shape's frame
  Shape shape = Shape::capsule(Length::from_ratio(1, 10), Length::from_ratio(1, 20));
  Mass mass{};                        ///< kg, 0: by the density of `material`
  Material material{};                ///< of the body
  JointKind joint = JointKind::ball;  ///< to the parent: ball, hinge or weld
  Transform joint_frame{};            ///< x: the axis of the twist, of a hinge its axis
  Angle min_twist = -k_half_turn;     ///< −π … 0
  Angle max_twist = k_half_turn;      ///< 0 … π; no limit where the two span a whole turn
  Angle max_swing = k_half_turn;      ///< of a ball, half the angle of its cone, 0 … π; π: none
  Torque friction{};                  ///< N·m, ≥ 0: about each axis of a limp joint
};

struct RagdollDef {
  std::span<const Bone> bones{};  ///< 1 … k_max_bones, the root first
  CollisionFilter filter{};       ///< of all bodies; bones that a joint ties never touch
  std::uint64_t user_data = 0;    ///< of all bodies and joints
};

/// The place of a ragdoll, and how far each joint has turned from the bind pose.
struct RagdollPose {
  Transform root{};                       ///< of the root's shape, in the world
  std::array<Quat, k_max_bones> turns{};  ///< of a joint's frame on the bone against that on the
                                          ///< parent; of a hinge about x; the root's is not read
};

/// The bodies and joints of a ragdoll, by bone.
struct Ragdoll {
  std::uint32_t bone_count = 0;
  std::array<BodyHandle, k_max_bones> bodies{};
  std::array<JointHandle, k_max_bones> joints{};  ///< to the parent; null of the root, and between
                                                  ///< two kinematic bones
  std::array<Mass, k_max_bones> masses{};         ///< of a bone when it is dynamic
};

/// Why `create_ragdoll` would refuse the definition: the bone's field, its value and its range.
/// Capacities of the world are not looked at. Allocates text.
Refusal explain(const World& world, const RagdollDef& def);

/// Makes the bodies, all dynamic and limp, in the order of the bones, then the joints. The bodies
/// are at rest. invalid_argument, not_found or capacity_exhausted as of `World::create_body` and
/// `create_joint`; no body is left then.
Result<Ragdoll> create_ragdoll(World& world, const RagdollDef& def, const RagdollPose& pose);

/// Destroys the bodies that still exist, and so the joints.
void destroy_ragdoll(World& world, const Ragdoll& ragdoll);

/// Fills `out`, as long as `def.bones`, with the poses of the bones' shapes in the world: forward
/// kinematics. Each joint adds at most 1 um and 2^-27 rad.
void bone_poses(const RagdollDef& def, const RagdollPose& pose, std::span<Transform> out);

/// The pose in which a ragdoll stands: to record it. All of its bodies must exist.
[[nodiscard]] RagdollPose pose_of(const World& world, const RagdollDef& def,
                                  const Ragdoll& ragdoll);

/// How a bone follows a pose. Of the root, which has no joint, all but `kinematic` are limp.
enum class BoneMode : std::uint8_t {
  limp = 0,       ///< not at all: contacts, limits and friction move it
  sprung = 1,     ///< by a spring at its joint, which contacts and weights overcome
  driven = 2,     ///< exactly: its joint locks and turns, as strong as need be, beyond limits too
  kinematic = 3,  ///< as a kinematic body, which nothing can stop
};
[[nodiscard]] std::string_view to_string(BoneMode mode);

/// How one bone is driven. The spring has the frequency that the bone and its parent alone would
/// have: bones beyond it make it slower.
struct BoneDrive {
  BoneMode mode = BoneMode::driven;
  Number hertz = Number::from_integer(15);         ///< of a sprung bone, 0.01 … 1000 Hz
  Number damping_ratio = Number::from_integer(1);  ///< of a sprung bone, 0 … 100
  Torque max_torque{};  ///< of a sprung bone, N·m about each axis, ≥ 0; 0: no bound

  friend bool operator==(const BoneDrive&, const BoneDrive&) = default;
};

/// Drives all joints at once through the coming tick: from one pose at its beginning to another at
/// its end. The same pose twice holds it. `drives`: one for each bone, or a single one for all.
/// Locked joints stay at their last pose until the next call. Springs keep their targets and the
/// speeds that they are damped against: end a motion with the same pose twice.
///
/// Applies SetAngularAxis for each joint, MoveKinematic for each kinematic bone, and SetMotionType,
/// DestroyJoint and `create_joint` for bones whose mode changes: a joint needs a dynamic body, so
/// that between two kinematic bones there is none. A joint that broke or that the game destroyed
/// stays away, and its bone is limp. Between a kinematic bone and a parent that is none, the joint
/// follows the mode of the parent.
///
/// stale_handle if a body is gone, invalid_argument for numbers out of range: nothing has changed.
/// Else the status of the first command that failed, say a MoveKinematic faster than a body may be;
/// the others were applied.
Status drive_ragdoll(World& world, const RagdollDef& def, Ragdoll& ragdoll, const RagdollPose& from,
                     const RagdollPose& to, std::span<const BoneDrive> drives);

}  // namespace lockstone
