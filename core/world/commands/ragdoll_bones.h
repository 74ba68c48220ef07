// The parts of a ragdoll that its bones decide.
#pragma once

#include <array>

#include <lockstone/ragdoll.h>

namespace lockstone {

/// A joint's frames on the parent (a) and on the bone (b), where it is fastened.
struct BoneFrames {
  JointFrame a{}, b{};
};
/// Of a bone that has a parent.
[[nodiscard]] BoneFrames frames_of(const RagdollDef& def, std::size_t bone);

/// Of a bone that has a parent, limp.
[[nodiscard]] JointDef joint_of(const RagdollDef& def, const Ragdoll& ragdoll, std::size_t bone);

/// The angular axes of that joint.
[[nodiscard]] std::array<AngularAxis, 3> limp_axes(const Bone& bone);

/// Whether the bones are a tree of valid numbers; bodies and anchors are not looked at.
[[nodiscard]] Refusal check_bones(const RagdollDef& def);

}  // namespace lockstone
