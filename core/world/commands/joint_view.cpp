// A joint as a game sees it.

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_path.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/joint/turn_springs.h"
#include "core/math/product_sum.h"
#include "core/math/roots.h"
#include "core/world/commands/joint_registry.h"
#include "core/world/derived/quantities.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// A force or torque as a vector; at the type's limit along all axes it is, rotated, longer than
// along one.
template <class T>
Vec3<Position> as_vector(const Vec3<T>& v) {
  constexpr std::int64_t k_most = std::int64_t{1} << 61;
  const auto within = [=](T x) {
    return Position::from_raw(x.raw > k_most ? k_most : x.raw < -k_most ? -k_most : x.raw);
  };
  return {within(v.x), within(v.y), within(v.z)};
}

// The torque of springs that act together, given by their rows, in the axes of the world.
Vec3<Position> sum_of_rows(const SpringTurnRows& rows, const Vec3<Position>& efforts) {
  Vec3<Position> sum;
  for (std::size_t i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j)
      sum[j].raw += product_rounded(efforts[static_cast<int>(i)].raw,
                                    rows.axes[i][static_cast<std::size_t>(j)], 30);
  }
  return as_vector(sum);
}

Length distance_of(const Vec3<Position>& v) {
  return saturated<Length>(
      Position::from_raw(static_cast<std::int64_t>(norm(v.x.raw, v.y.raw, v.z.raw))));
}

}  // namespace

JointView view_of(const WorldData& world, const JointRecord& joint) {
  const BodyRecord& a = world.bodies[joint.body_a];
  const BodyRecord& b = world.bodies[joint.body_b];
  const Mat3& turn_a = world.cache.rotation(joint.body_a);
  const Mat3& turn_b = world.cache.rotation(joint.body_b);
  const Vec3<Position> gap =
      (b.position + arm_of(turn_b, joint.anchor_b)) - (a.position + arm_of(turn_a, joint.anchor_a));
  PathFrame place{frame_of(turn_a, joint.orientation_a), gap, {}, {}};
  if (const geometry::Curve* curve = curve_of(joint, world.assets.get()))
    place = path_frame(*curve, place.axes, gap, path_parameter(joint));
  const Mat3& frame_a = place.axes;
  JointView view{.kind = static_cast<JointKind>(joint.kind),
                 .body_a = world.handle_of(joint.body_a),
                 .body_b = world.handle_of(joint.body_b),
                 .user_data = joint.user_data,
                 .offset = saturated<Length>(rotate_inverse(frame_a, place.gap)),
                 .angle = swing_twist(frame_a, frame_of(turn_b, joint.orientation_b))};
  if (joint.is(JointKind::path)) view.offset.x = saturated<Length>(place.distance);
  if (joint.is(JointKind::distance)) view.offset = {distance_of(gap), {}, {}};
  const BlockFloat inverse_mass = add(a.inverse_mass_value(), b.inverse_mass_value());
  const int exponent = angular_exponent(a, b);
  const SpringTurn turn = spring_turn(joint);
  Vec3<Torque> springs;  // of those that act together, along their rows
  for (int i = 0; i < 3; ++i) {
    const std::int32_t rate = world.time_step.substep_rate();
    const auto effort = [&](std::int64_t impulse, int scale) {
      return effort_of(impulse, rate, inverse_mass, scale);
    };
    const auto axis = static_cast<std::size_t>(i);
    const JointAxisRecord &linear = joint.axes[axis], &angular = joint.axes[axis + 3];
    const bool together = acts_together(joint, turn, axis + 3);
    const std::int64_t alone = together ? 0 : angular.drive_impulse.raw;
    view.force[i].raw = effort(std::int64_t{linear.impulse.raw} + linear.drive_impulse.raw, 0);
    view.torque[i].raw = effort(angular.impulse.raw + alone, exponent);
    if (together) springs[i].raw = effort(angular.drive_impulse.raw, exponent);
  }
  if (turn != SpringTurn::apart) {
    const SpringTurnRows rows = spring_turn_rows(joint, turn, a.orientation, b.orientation);
    const Vec3<Position> torque = rotate_inverse(frame_a, sum_of_rows(rows, as_vector(springs)));
    for (int i = 0; i < 3; ++i)
      view.torque[i].raw += torque[i].raw;
  }
  if (has_world_axes(joint)) {
    const Vec3<Position> along = rotate_inverse(frame_a, as_vector(view.force));
    view.force = {Force::from_raw(along.x.raw), Force::from_raw(along.y.raw),
                  Force::from_raw(along.z.raw)};
  }
  return view;
}

}  // namespace lockstone
