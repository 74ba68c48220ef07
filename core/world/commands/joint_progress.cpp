#include "core/world/commands/joint_progress.h"

#include <algorithm>

#include <lockstone/path.h>

#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_path.h"
#include "core/math/roots.h"
#include "core/math/trig.h"
#include "core/world/commands/joint_checks.h"

namespace lockstone {
namespace {

Position length_of(const Vec3<Position>& v) {
  return Position::from_raw(static_cast<std::int64_t>(norm(v.x.raw, v.y.raw, v.z.raw)));
}

// At most 1000 m each and together.
bool set_rope(const WorldData& world, JointRecord& joint) {
  const Vec3<Position> end_a = world.bodies[joint.body_a].position +
                               arm_of(world.cache.rotation(joint.body_a), joint.anchor_a);
  const Vec3<Position> end_b = world.bodies[joint.body_b].position +
                               arm_of(world.cache.rotation(joint.body_b), joint.anchor_b);
  const Position first = length_of(end_a - joint.ground_a);
  const Position second = length_of(end_b - joint.ground_b);
  constexpr Position k_most = Position::from_integer(1000);
  if (first > k_most || second > k_most) return false;
  const Position total = first + multiply<Position>(second, joint.ratio);
  if (total > k_most) return false;
  joint.total_length = rounded<Length>(total);
  return true;
}

// Whether a turn is 0 … 3π/2 beyond a tooth, not 0 … π/2 before it: as limits of ratchets have it.
bool is_beyond(Angle twist, std::int32_t tooth) {
  const std::int64_t turn = 2 * (std::int64_t{twist.raw} - tooth);
  const std::int64_t rest = ((turn % k_two_pi_q28) + k_two_pi_q28) % k_two_pi_q28;
  return rest > 0 && 4 * rest < 3 * k_two_pi_q28;
}

// The tooth at or below an angle: Q27, −π … π.
std::int32_t tooth_below(Angle angle, const JointRecord& joint) {
  const std::int64_t teeth = joint.ratio.raw >> Number::frac_bits;
  const std::int64_t turns = std::int64_t{angle.raw} * 2 * teeth;
  const std::int64_t tooth = turns / k_two_pi_q28 - (turns % k_two_pi_q28 < 0 ? 1 : 0);
  const std::int64_t place = raw::round_divide(tooth * k_two_pi_q28, 2 * teeth);
  return static_cast<std::int32_t>(place < -k_pi ? place + 2 * std::int64_t{k_pi} : place);
}

Angle twist_now(const WorldData& world, const JointRecord& joint) {
  return twist_of(frame_of(world.cache.rotation(joint.body_a), joint.orientation_a),
                  frame_of(world.cache.rotation(joint.body_b), joint.orientation_b));
}

// Anchor b in the frame of the path.
Vec3<Position> point_on(const WorldData& world, const JointRecord& joint) {
  const Mat3 &turn_a = world.cache.rotation(joint.body_a),
             &turn_b = world.cache.rotation(joint.body_b);
  const Vec3<Position> from = world.bodies[joint.body_a].position + arm_of(turn_a, joint.anchor_a);
  const Vec3<Position> to = world.bodies[joint.body_b].position + arm_of(turn_b, joint.anchor_b);
  return rotate_inverse(frame_of(turn_a, joint.orientation_a), to - from);
}

// Limits beyond a path's ends become those; a closed path has none.
void fit_limits(const geometry::Curve& curve, JointRecord& joint) {
  if (joint.mode(0) != AxisMode::limited) return;
  const std::int32_t length = rounded<Length>(curve.length()).raw;
  JointAxisRecord& axis = joint.axes[0];
  axis.lower = std::clamp(axis.lower, 0, length);
  axis.upper = std::clamp(axis.upper, axis.lower, length);
  if (curve.is_closed() && axis.lower == 0 && axis.upper == length)
    joint.modes[0] = static_cast<std::uint8_t>(AxisMode::free);
}

void set_tooth(JointRecord& joint, std::int32_t tooth) {
  joint.axes[3].lower = tooth;
  joint.axes[3].upper = k_pi;
}

}  // namespace

bool begin_joint(const WorldData& world, JointRecord& joint) {
  if (joint.is(JointKind::pulley)) return set_rope(world, joint);
  if (joint.is(JointKind::ratchet)) set_tooth(joint, tooth_below(twist_now(world, joint), joint));
  if (!joint.is(JointKind::path)) return true;
  const geometry::Curve* curve = curve_of(joint, world.assets.get());
  if (curve == nullptr) return false;
  fit_limits(*curve, joint);
  joint.ground_a.x = curve->find(point_on(world, joint));
  return true;
}

void keep_progress(const WorldData& world, const JointRecord& joint, JointRecord& changed) {
  if (joint.is(JointKind::ratchet)) set_tooth(changed, joint.axes[3].lower);
  if (const geometry::Curve* curve = curve_of(joint, world.assets.get()))
    fit_limits(*curve, changed);
}

// A pawl that is lifted follows both ways.
void advance_joint(const WorldData& world, JointRecord& joint) {
  if (joint.is(JointKind::ratchet)) {
    const Angle twist = twist_now(world, joint);
    const bool is_held =
        joint.mode(3) == AxisMode::limited && !is_beyond(twist, joint.axes[3].lower);
    if (!is_held) set_tooth(joint, tooth_below(twist, joint));
    return;
  }
  const geometry::Curve* curve = curve_of(joint, world.assets.get());
  if (curve == nullptr) return;
  const Vec3<Position> point = point_on(world, joint);
  const geometry::CurvePlace place = curve->nearest(point, path_parameter(joint));
  joint.ground_a.x = place.parameter;
}

}  // namespace lockstone
