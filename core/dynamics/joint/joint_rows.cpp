#include "core/dynamics/joint/joint_rows.h"

#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "core/dynamics/joint/geared_rows.h"
#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/joint/joint_path.h"
#include "core/dynamics/joint/joint_row_writer.h"
#include "core/dynamics/joint/joint_vectors.h"
#include "core/dynamics/joint/turn_springs.h"
#include "core/dynamics/state/time_step.h"
#include "core/math/product_sum.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

// The rows of a joint that is settings of six axes: three lengths along the axes of frame a, the
// twist about the x axes, and the tilts of frame b's x axis about y and z of frame a.
class SixAxisRows {
 public:
  SixAxisRows(RowWriter& rows, const JointArms& arms) : rows_(rows), arms_(arms) {}

  void fill() {
    const bool world_axes = has_world_axes(place().joint);
    const bool turns = rows_.is_wanted(3) || rows_.is_wanted(4) || rows_.is_wanted(5);
    if (!world_axes || turns) set_frames();
    if (world_axes)
      rows_.lock_point(arms_);
    else
      fill_linear();
    if (turns) fill_angular();
  }

 private:
  [[nodiscard]] const JointPlace& place() const { return rows_.place(); }

  void set_frames() {
    frame_a_ = frame_of(place().a.rotation, place().frames.a);
    frame_b_ = frame_of(place().b.rotation, place().frames.b);
    if (place().curve != nullptr) follow_path();
  }

  [[gnu::noinline, gnu::cold]] void follow_path() {
    LKS_ASSERT(place().joint.is(JointKind::path) && !has_world_axes(place().joint));
    path_ = path_frame(*place().curve, frame_a_, arms_.gap, path_parameter(place().joint));
    frame_a_ = path_.axes;
  }

  // The arm of body a reaches to anchor b: there rows along axes of frame a act.
  [[nodiscard]] JointArms reach() const { return {arms_.a + arms_.gap, arms_.b, arms_.gap}; }

  // Along the path; on a closed one the shorter way from the target of a spring.
  [[nodiscard]] std::int64_t path_distance() const {
    LKS_ASSERT(place().curve->length() > Position{});
    const std::int64_t whole = place().curve->length().raw, distance = path_.distance.raw;
    if (!place().curve->is_closed() || place().joint.mode(0) != AxisMode::free) return distance;
    const std::int64_t target = rows_.value_of(0, place().joint.axes[0].target);
    const std::int64_t error = (distance - target) % whole;
    return target + (2 * error > whole    ? error - whole
                     : 2 * error < -whole ? error + whole
                                          : error);
  }

  // A row about an axis. The frame of a path joint turns on its way besides.
  [[nodiscard]] JointRow angular_row(const RawVec3& axis) const {
    JointRow row = rows_.angular_row(axis);
    if (place().curve != nullptr) subtract_turning(axis, row);
    return row;
  }

  [[gnu::noinline, gnu::cold]] void subtract_turning(const RawVec3& axis, JointRow& row) const {
    ProductSum sum;
    for (std::size_t i = 0; i < 3; ++i)
      sum.add(axis[i], path_.turning[i]);
    const std::int64_t turn = shifted(sum.rounded(30), -place().exponent);
    LKS_ASSERT(turn <= std::int64_t{1} << 44 && turn >= -(std::int64_t{1} << 44));
    const JointRow way = rows_.linear_row(reach(), raw_of(frame_a_.x));
    row.shifts = true;
    for (RawVec3 JointDirections::*part :
         {&JointDirections::linear_a, &JointDirections::linear_b, &JointDirections::angular_a,
          &JointDirections::angular_b}) {
      for (std::size_t i = 0; i < 3; ++i)
        (row.*part)[i] -= product_rounded((way.*part)[i], turn, 30);
    }
  }

  void fill_linear() {
    const bool on_path = place().curve != nullptr;
    const JointArms reach = this->reach();
    const Vec3<Position>& gap = on_path ? path_.gap : arms_.gap;
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      if (!rows_.is_wanted(axis)) continue;
      const RawVec3 n = raw_of(frame_a_.column(i));
      rows_.add_axis(
          axis, [&] { return rows_.linear_row(reach, n); },
          on_path && i == 0 ? path_distance() : along(gap, n));
    }
  }

  // Whether an angular axis can have a row besides that of a spring that acts with others.
  [[nodiscard]] bool turns_alone(std::size_t axis) const {
    const bool sprung = rows_.acts_together(axis);
    return rows_.is_wanted(axis) && !(sprung && place().joint.mode(axis) != AxisMode::limited);
  }

  void fill_angular() {
    if (rows_.wants_all()) add_springs_together();
    if (turns_alone(3)) add_twist();
    const bool cone =
        place().joint.is(JointKind::ball) && place().joint.mode(4) == AxisMode::limited;
    if (cone && rows_.wants_all() && !rows_.is_far(4)) add_cone();
    const auto swings = [&](std::size_t axis) {
      return turns_alone(axis) &&
             (!cone || place().joint.axes[axis].is_driven() || rows_.is_rigid(axis));
    };
    if (swings(4)) add_swing(4, negated(raw_of(frame_a_.z)), !cone);
    if (swings(5)) add_swing(5, raw_of(frame_a_.y), !cone);
    if (place().turns_locks) rows_.turn_locks();
  }

  void add_springs_together() {
    const JointRecord& joint = place().joint;
    const SpringTurn springs = spring_turn(joint);
    if (springs == SpringTurn::apart) return;
    rows_.act_together(springs);
    const SpringTurnRows turn =
        spring_turn_rows(joint, springs, place().a.orientation, place().b.orientation);
    for (std::size_t axis = 3; axis < k_joint_axes; ++axis) {
      if (!rows_.acts_together(axis)) continue;
      const auto drive = [&] {
        JointRow row = rows_.angular_row(turn.axes[axis - 3]);
        row.speed = rows_.speed_of(axis, joint.axes[axis].speed);
        return row;
      };
      rows_.push(drive, axis, RowKind::drive, rows_.arc(turn.errors[axis - 3]));
    }
  }

  // The twist's rate is ω·(xA + xB) / (1 + xA·xB).
  void add_twist() {
    const std::int64_t base = k_one + cosine(frame_a_.x, frame_b_.x);
    if (base < k_one / 64) return;  // swung back to front: the twist means nothing
    const auto row = [&] {
      RawVec3 sum;
      for (int i = 0; i < 3; ++i)
        sum[static_cast<std::size_t>(i)] = std::int64_t{frame_a_.x[i].raw} + frame_b_.x[i].raw;
      return angular_row(divided(sum, base));
    };
    if (rows_.is_rigid(3)) {
      const std::int64_t sine = cosine(frame_a_.z, frame_b_.y) - cosine(frame_a_.y, frame_b_.z);
      return rows_.add_axis(3, row, rows_.arc(sine * 2));  // half of it, from Q30 to Q32
    }
    rows_.add_axis(3, row, rows_.arc(std::int64_t{twist_of(frame_a_, frame_b_).raw} << 5));
  }

  // The tilt atan2(t·xB, xA·xB), t = yA or −zA, turns at ω·(xB × (a·t − b·xA)) / (a² + b²) with
  // a = xA·xB, b = t·xB; next to 0 it is b, at ω·(xB × t).
  void add_swing(std::size_t axis, const RawVec3& t, bool limits) {
    const RawVec3 x = raw_of(frame_b_.x);
    LKS_ASSERT(axis == 4 || axis == 5);
    const std::int64_t b =
        along({Position::from_raw(x[0]), Position::from_raw(x[1]), Position::from_raw(x[2])}, t);
    if (rows_.is_rigid(axis))
      return rows_.add_axis(
          axis, [&] { return angular_row(cross_raw(x, t)); }, rows_.arc(b * 4));
    const std::int64_t a = cosine(frame_a_.x, frame_b_.x);
    const std::int64_t square = raw::round_shift(a * a, 30) + raw::round_shift(b * b, 30);
    if (square < k_one / 64) return;
    const auto row = [&] {
      const RawVec3 xa = raw_of(frame_a_.x);
      RawVec3 u;
      for (std::size_t i = 0; i < 3; ++i)
        u[i] = raw::round_shift(a * t[i], 30) - raw::round_shift(b * xa[i], 30);
      return angular_row(divided(cross_raw(x, u), square));
    };
    const std::int64_t angle = std::int64_t{atan2_raw(b, a).raw} << 5;
    rows_.add_axis(axis, row, rows_.arc(angle), limits);
  }

  void add_cone() {
    const RawVec3 axis = cross_raw(raw_of(frame_a_.x), raw_of(frame_b_.x));
    const Direction d = direction(axis[0], axis[1], axis[2]);
    const std::int64_t a = cosine(frame_a_.x, frame_b_.x);
    const std::int64_t angle = std::int64_t{atan2_raw(static_cast<std::int64_t>(d.length), a).raw}
                               << 5;
    LKS_ASSERT(angle >= 0);
    const std::int64_t left = (std::int64_t{place().joint.axes[4].upper} << 5) - angle;
    if (d.length < std::uint64_t{1} << 16 && a > 0) return;  // no direction, and far from the limit
    const auto row = [&] {
      JointRow flipped = angular_row(negated(raw_of(d.unit)));
      flipped.flipped = true;
      return flipped;
    };
    rows_.push(row, 4, RowKind::limit, rows_.arc(left));
  }

  RowWriter& rows_;
  const JointArms& arms_;
  Mat3 frame_a_{}, frame_b_{};
  PathFrame path_{};  // of a path joint
};

void fill(RowWriter& rows) {
  const JointPlace& place = rows.place();
  const JointRecord& joint = place.joint;
  LKS_ASSERT(joint.exists());
  JointArms arms{arm_of(place.a.rotation, joint.anchor_a),
                 arm_of(place.b.rotation, joint.anchor_b)};
  arms.gap = (place.b.position + arms.b) - (place.a.position + arms.a);
  if (place.holds_a_point) return rows.lock_point(arms);
  switch (static_cast<JointKind>(joint.kind)) {
    case JointKind::distance:
      return fill_distance(rows, arms);
    case JointKind::pulley:
      return fill_pulley(rows, arms);
    case JointKind::gear:
      return fill_gear(rows);
    case JointKind::rack:
      return fill_rack(rows, arms);
    default:
      return SixAxisRows(rows, arms).fill();
  }
}

}  // namespace

bool has_world_axes(const JointRecord& joint) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (joint.mode(i) != AxisMode::locked || joint.axes[i].is_driven()) return false;
  }
  return true;
}

std::size_t most_rows(const JointRecord& joint) {
  LKS_ASSERT(joint.exists());
  if (has_own_equation(static_cast<JointKind>(joint.kind))) return 1;
  std::size_t count = 0;
  for (std::size_t axis = 0; axis < k_joint_axes; ++axis) {
    if (joint.mode(axis) != AxisMode::free) ++count;
    if (joint.axes[axis].is_driven()) ++count;
  }
  return count;
}

bool is_free_ball(const JointRecord& joint) {
  constexpr auto k_locked = static_cast<std::uint8_t>(AxisMode::locked);
  constexpr auto k_free = static_cast<std::uint8_t>(AxisMode::free);
  constexpr std::array k_modes{k_locked, k_locked, k_locked, k_free, k_free, k_free};
  return joint.is(JointKind::ball) && joint.modes == k_modes;
}

bool is_point(const JointRecord& joint) {
  return is_free_ball(joint) && !is_driven(joint);
}

bool holds_a_point(const JointRecord& joint, std::uint8_t far) {
  if (has_own_equation(static_cast<JointKind>(joint.kind))) return false;
  if (joint.is(JointKind::distance) || !has_world_axes(joint)) return false;
  for (std::size_t axis = 3; axis < k_joint_axes; ++axis) {
    const bool is_free = joint.mode(axis) == AxisMode::free || (far >> axis & 1) != 0;
    if (!is_free || joint.axes[axis].is_driven()) return false;
  }
  return true;
}

RawVec3 point_gap(const JointPlace& place) {
  const Vec3<Position> gap = (place.b.position + arm_of(place.b.rotation, place.joint.anchor_b)) -
                             (place.a.position + arm_of(place.a.rotation, place.joint.anchor_a));
  const auto part = [](Position x) { return bounded(x.raw, k_product_bound); };
  return {part(gap.x), part(gap.y), part(gap.z)};
}

LockErrors lock_errors(const JointPlace& place) {
  LockErrors errors;
  RowWriter writer(place, RowParts::locks, nullptr, &errors);
  fill(writer);
  return errors;
}

void fill_rows(const JointPlace& place, RowParts parts, JointRows& out) {
  RowWriter writer(place, parts, &out, nullptr);
  fill(writer);
}

}  // namespace lockstone
