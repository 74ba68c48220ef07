// Joints of a body that changes: whether they still fit, and their frames on it.

#include <algorithm>

#include "core/world/commands/joint_progress.h"
#include "core/world/commands/joint_registry.h"
#include "core/world/state/record_checks.h"

namespace lockstone {
namespace {

struct FramePlace {
  Vec3<Length> anchor;
  Quat orientation;
};

// A frame of one body frame in another, both in the frame of the shape.
FramePlace moved_place(const FramePlace& place, const Transform& from, const Transform& to) {
  if (from == to) return place;
  const Quat turn = multiply(conjugate(to.orientation), from.orientation);
  return {saturated<Length>(apply_inverse(to, apply(from, place.anchor))),
          normalized(multiply(turn, place.orientation))};
}

}  // namespace

bool JointRegistry::hold_dynamic(std::uint32_t body, const BodyRecord& changed) const {
  return std::ranges::all_of(world_.joint_graph.links(), [&](const JointLink& link) {
    if (link.body_a == body) return can_join(changed, world_.bodies[link.body_b]);
    return link.body_b != body || can_join(world_.bodies[link.body_a], changed);
  });
}

bool JointRegistry::fit_moved(std::uint32_t body, const BodyRecord& changed, const Transform& from,
                              const Transform& to) const {
  return std::ranges::all_of(world_.joint_graph.links(), [&](const JointLink& link) {
    const JointRecord& joint = world_.joints[link.joint];
    const auto fits = [&](std::uint32_t end, const Vec3<Length>& anchor) {
      return end != body || is_anchor(changed, moved_place({anchor, {}}, from, to).anchor);
    };
    return fits(link.body_a, joint.anchor_a) && fits(link.body_b, joint.anchor_b);
  });
}

void JointRegistry::move_frames(std::uint32_t body, const Transform& from, const Transform& to) {
  if (from == to) return;
  for (const JointLink& link : world_.joint_graph.links()) {
    JointRecord& joint = world_.joints[link.joint];
    const auto move = [&](Vec3<Length>& anchor, Quat& orientation) {
      const FramePlace place = moved_place({anchor, orientation}, from, to);
      anchor = place.anchor;
      orientation = place.orientation;
    };
    if (link.body_a == body) move(joint.anchor_a, joint.orientation_a);
    if (link.body_b == body) move(joint.anchor_b, joint.orientation_b);
    if (link.body_a == body || link.body_b == body) world_.hashes.joints.mark(link.joint);
  }
}

void JointRegistry::restart_joints_of(std::uint32_t body) {
  for (const JointLink& link : world_.joint_graph.links()) {
    if (link.body_a != body && link.body_b != body) continue;
    JointRecord& joint = world_.joints[link.joint];
    if (!joint.is(JointKind::ratchet) && !joint.is(JointKind::path)) continue;
    (void)begin_joint(world_, joint);
    world_.hashes.joints.mark(link.joint);
  }
}

void JointRegistry::forget_impulses_of(std::uint32_t body) {
  for (const JointLink& link : world_.joint_graph.links()) {
    if (link.body_a != body && link.body_b != body) continue;
    JointRecord& joint = world_.joints[link.joint];
    for (JointAxisRecord& axis : joint.axes)
      axis.impulse = axis.drive_impulse = {};
    joint.energy_gained = 0;
    world_.hashes.joints.mark(link.joint);
  }
}

}  // namespace lockstone
