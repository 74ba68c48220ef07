#include "core/dynamics/joint/joint_rows.h"

#include <algorithm>
#include <bit>

#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/joint/joint_vectors.h"
#include "core/dynamics/joint/turn_springs.h"
#include "core/dynamics/state/time_step.h"
#include "core/math/product_sum.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

// Angular rows reach no farther than this many powers of two beyond a body's scale.
constexpr int k_most_lever = 12;

RawVec3 raw_of(const Vec3<Unit>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

// x · 2^-shift for either sign of `shift`, within ±2^44.
std::int64_t shifted(std::int64_t x, int shift) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 44;
  if (shift >= 0) return std::clamp(raw::round_shift(x, std::min(shift, 62)), -k_bound, k_bound);
  return std::clamp(x, -(k_bound >> -shift), k_bound >> -shift) * (std::int64_t{1} << -shift);
}

class RowFiller {
 public:
  // Fills one of both.
  RowFiller(const JointPlace& place, RowParts parts, JointRows* out, LockErrors* errors)
      : place_(place), parts_(parts), out_(out), errors_(errors) {
    if (out == nullptr) return;
    out->locks = out->count = 0;
    out->is_point = false;
  }

  void fill() {
    const JointRecord& joint = place_.joint;
    arm_a_ = arm_of(place_.a.rotation, joint.anchor_a);
    arm_b_ = arm_of(place_.b.rotation, joint.anchor_b);
    gap_ = (place_.b.position + arm_b_) - (place_.a.position + arm_a_);
    if (place_.holds_a_point) return lock_anchors();
    switch (static_cast<JointKind>(joint.kind)) {
      case JointKind::distance:
        return fill_distance();
      case JointKind::pulley:
        return fill_pulley();
      case JointKind::gear:
        set_frames();
        return fill_gear();
      case JointKind::rack:
        set_frames();
        return fill_rack();
      default:
        break;
    }
    const bool world_axes = has_world_axes(joint);
    const bool turns = is_wanted(3) || is_wanted(4) || is_wanted(5);
    if (!world_axes || turns) set_frames();
    if (world_axes)
      lock_anchors();
    else
      fill_linear();
    if (turns) fill_angular();
  }

 private:
  void set_frames() {
    frame_a_ = frame_of(place_.a.rotation, place_.frames.a);
    frame_b_ = frame_of(place_.b.rotation, place_.frames.b);
  }

  [[nodiscard]] bool is_far(std::size_t axis) const { return (place_.far >> axis & 1) != 0; }

  // Whether an axis can have a row of the wanted parts.
  [[nodiscard]] bool is_wanted(std::size_t axis) const {
    const JointAxisRecord& settings = place_.joint.axes[axis];
    if (place_.joint.mode(axis) != AxisMode::free && !is_far(axis)) {
      return parts_ == RowParts::all || is_rigid(axis) || settings.lower == settings.upper;
    }
    return parts_ == RowParts::all && settings.is_driven();
  }

  // A row along n, positive where b goes that way.
  [[nodiscard]] JointRow linear_row(const RawVec3& n, const Vec3<Position>& arm_a) const {
    JointRow row;
    row.linear_b = n;
    row.linear_a = negated(n);
    row.angular_b = lever(arm_b_, n, place_.scale_b);
    row.angular_a = negated(lever(arm_a, n, place_.scale_a));
    return row;
  }

  // A row about an axis (Q30, of any length), positive where b turns that way.
  [[nodiscard]] JointRow angular_row(const RawVec3& axis) const {
    const auto scaled = [&](int scale) {
      const int shift = std::clamp(scale - place_.exponent, -k_most_lever, k_most_lever);
      return RawVec3{shifted(axis[0], shift), shifted(axis[1], shift), shifted(axis[2], shift)};
    };
    JointRow row;
    row.angular_b = scaled(place_.scale_b);
    row.angular_a = negated(scaled(place_.scale_a));
    return row;
  }

  // `make` returns the row's Jacobians, which errors alone do not need.
  template <class Make>
  void push(const Make& make, std::size_t axis, RowKind kind, std::int64_t error) {
    if (kind != RowKind::lock && parts_ != RowParts::all) return;
    if (errors_ != nullptr) {
      errors_->errors[errors_->count++] = error;
      return;
    }
    JointRow row = make();
    row.axis = static_cast<std::uint8_t>(axis);
    row.kind = kind;
    row.error = error;
    LKS_ASSERT(out_->count < out_->rows.size());
    const auto begin = out_->rows.begin();
    out_->rows[out_->count++] = row;
    if (kind != RowKind::lock) return;
    if (out_->locks + 1 < out_->count)
      std::rotate(begin + static_cast<std::ptrdiff_t>(out_->locks),
                  begin + static_cast<std::ptrdiff_t>(out_->count) - 1,
                  begin + static_cast<std::ptrdiff_t>(out_->count));
    ++out_->locks;
  }

  // The rows of one axis, where it stands at `value` (m, Q32).
  template <class Make>
  void add_axis(std::size_t axis, const Make& make, std::int64_t value, bool limits = true) {
    const JointAxisRecord& settings = place_.joint.axes[axis];
    const AxisMode mode = place_.joint.mode(axis);
    const bool soft = mode == AxisMode::locked && settings.is_spring();
    if (mode == AxisMode::locked && !soft) return push(make, axis, RowKind::lock, value);
    if (mode == AxisMode::limited && limits && !is_far(axis)) {
      const std::int64_t above = value - value_of(axis, settings.lower);
      if (settings.lower == settings.upper) return push(make, axis, RowKind::lock, above);
      add_limit(axis, make, above, value_of(axis, settings.upper) - value);
    }
    if (!settings.is_driven() || acts_together(place_.joint, springs_, axis)) return;
    const auto drive = [&] {
      JointRow row = make();
      row.speed = speed_of(axis, settings.speed);
      return row;
    };
    const std::int64_t error = value - (soft ? 0 : value_of(axis, settings.target));
    push(drive, axis, RowKind::drive, axis == 3 && mode == AxisMode::free ? nearer(error) : error);
  }

  // The twist that is left, the shorter way round.
  [[nodiscard]] std::int64_t nearer(std::int64_t error) const {
    const std::int64_t whole = arc(k_two_pi_q28 << 4), half = whole / 2;
    return error > half ? error - whole : error < -half ? error + whole : error;
  }

  template <class Make>
  void add_limit(std::size_t axis, const Make& make, std::int64_t above, std::int64_t below) {
    if (above <= below) return push(make, axis, RowKind::limit, above);
    const auto opposite = [&] {
      JointRow row = make();
      row.linear_a = negated(row.linear_a), row.linear_b = negated(row.linear_b);
      row.angular_a = negated(row.angular_a), row.angular_b = negated(row.angular_b);
      row.flipped = true;
      return row;
    };
    push(opposite, axis, RowKind::limit, below);
  }

  // A length or an angle as an error in m, Q32.
  [[nodiscard]] std::int64_t value_of(std::size_t axis, std::int32_t setting) const {
    if (axis < 3) return std::int64_t{setting} << 12;
    return arc(std::int64_t{setting} << 5);
  }
  [[nodiscard]] std::int64_t speed_of(std::size_t axis, std::int32_t setting) const {
    const std::int64_t bound = std::int64_t{1} << 60;
    const std::int64_t speed = axis < 3 ? setting : shifted(setting, -place_.exponent);
    return std::clamp(speed, -(bound >> 30), bound >> 30) * k_one;
  }
  // An angle in Q32 as an arc in m, Q32.
  [[nodiscard]] std::int64_t arc(std::int64_t angle) const {
    return shifted(angle, -place_.exponent);
  }

  // Three locks along the axes of the world.
  void lock_anchors() {
    if (errors_ != nullptr) {
      for (int i = 0; i < 3; ++i)
        errors_->errors[errors_->count++] = bounded(gap_[i].raw, k_product_bound);
      return;
    }
    const RawVec3 lever_a = scaled_arm(arm_a_, place_.scale_a);
    const RawVec3 lever_b = scaled_arm(arm_b_, place_.scale_b);
    for (std::size_t i = 0; i < 3; ++i) {
      JointRow& row = out_->rows[i];
      row.axis = static_cast<std::uint8_t>(i);
      row.kind = RowKind::lock;
      row.flipped = false;
      row.error = bounded(gap_[static_cast<int>(i)].raw, k_product_bound);
      const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
      row.linear_a = row.linear_b = {};
      row.linear_a[i] = -k_one;
      row.linear_b[i] = k_one;
      row.angular_a = row.angular_b = {};
      row.angular_a[j] = -lever_a[k], row.angular_a[k] = lever_a[j];
      row.angular_b[j] = lever_b[k], row.angular_b[k] = -lever_b[j];
    }
    out_->locks = out_->count = 3;
    out_->is_point = true;
  }

  void fill_linear() {
    const Vec3<Position> arm_a = arm_a_ + gap_;
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      if (!is_wanted(axis)) continue;
      const RawVec3 n = raw_of(frame_a_.column(i));
      add_axis(
          axis, [&] { return linear_row(n, arm_a); }, along(gap_, n));
    }
  }

  [[nodiscard]] bool is_rigid(std::size_t axis) const {
    return place_.joint.mode(axis) == AxisMode::locked && !place_.joint.axes[axis].is_spring();
  }

  // Whether an angular axis can have a row besides that of a spring that acts with others.
  [[nodiscard]] bool turns_alone(std::size_t axis) const {
    const bool sprung = acts_together(place_.joint, springs_, axis);
    return is_wanted(axis) && !(sprung && place_.joint.mode(axis) != AxisMode::limited);
  }

  void fill_angular() {
    if (parts_ == RowParts::all) add_springs_together();
    if (turns_alone(3)) add_twist();
    const bool cone = place_.joint.is(JointKind::ball) && place_.joint.mode(4) == AxisMode::limited;
    if (cone && parts_ == RowParts::all && !is_far(4)) add_cone();
    const auto swings = [&](std::size_t axis) {
      return turns_alone(axis) && (!cone || place_.joint.axes[axis].is_driven() || is_rigid(axis));
    };
    if (swings(4)) add_swing(4, negated(raw_of(frame_a_.z)), !cone);
    if (swings(5)) add_swing(5, raw_of(frame_a_.y), !cone);
  }

  void add_springs_together() {
    const JointRecord& joint = place_.joint;
    springs_ = spring_turn(joint);
    if (springs_ == SpringTurn::apart) return;
    const SpringTurnRows turn =
        spring_turn_rows(joint, springs_, place_.a.orientation, place_.b.orientation);
    for (std::size_t axis = 3; axis < k_joint_axes; ++axis) {
      if (!acts_together(joint, springs_, axis)) continue;
      const auto drive = [&] {
        JointRow row = angular_row(turn.axes[axis - 3]);
        row.speed = speed_of(axis, joint.axes[axis].speed);
        return row;
      };
      push(drive, axis, RowKind::drive, arc(turn.errors[axis - 3]));
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
    if (is_rigid(3)) {
      const std::int64_t sine = cosine(frame_a_.z, frame_b_.y) - cosine(frame_a_.y, frame_b_.z);
      return add_axis(3, row, arc(sine * 2));  // half of it, from Q30 to Q32
    }
    add_axis(3, row, arc(std::int64_t{twist_of(frame_a_, frame_b_).raw} << 5));
  }

  // The tilt atan2(t·xB, xA·xB), t = yA or −zA, turns at ω·(xB × (a·t − b·xA)) / (a² + b²) with
  // a = xA·xB, b = t·xB; next to 0 it is b, at ω·(xB × t).
  void add_swing(std::size_t axis, const RawVec3& t, bool limits) {
    const RawVec3 x = raw_of(frame_b_.x);
    const std::int64_t b =
        along({Position::from_raw(x[0]), Position::from_raw(x[1]), Position::from_raw(x[2])}, t);
    if (is_rigid(axis))
      return add_axis(
          axis, [&] { return angular_row(cross_raw(x, t)); }, arc(b * 4));
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
    add_axis(axis, row, arc(angle), limits);
  }

  void add_cone() {
    const RawVec3 axis = cross_raw(raw_of(frame_a_.x), raw_of(frame_b_.x));
    const Direction d = direction(axis[0], axis[1], axis[2]);
    const std::int64_t a = cosine(frame_a_.x, frame_b_.x);
    const std::int64_t angle = std::int64_t{atan2_raw(static_cast<std::int64_t>(d.length), a).raw}
                               << 5;
    const std::int64_t left = (std::int64_t{place_.joint.axes[4].upper} << 5) - angle;
    if (d.length < std::uint64_t{1} << 16 && a > 0) return;  // no direction, and far from the limit
    const auto row = [&] {
      JointRow flipped = angular_row(negated(raw_of(d.unit)));
      flipped.flipped = true;
      return flipped;
    };
    push(row, 4, RowKind::limit, arc(left));
  }

  void fill_distance() {
    if (!is_wanted(0)) return;
    const Direction d = direction(gap_);
    if (d.length == 0) return;
    const auto row = [&] { return linear_row(raw_of(d.unit), arm_a_); };
    const std::int64_t length =
        std::min(static_cast<std::int64_t>(d.length), std::int64_t{1} << 44);
    if (place_.joint.mode(0) == AxisMode::locked && !place_.joint.axes[0].is_spring()) {
      return push(row, 0, RowKind::lock, length - value_of(0, place_.joint.axes[0].target));
    }
    add_axis(0, row, length);
  }

  void fill_pulley() {
    const Direction a = direction((place_.a.position + arm_a_) - place_.joint.ground_a);
    const Direction b = direction((place_.b.position + arm_b_) - place_.joint.ground_b);
    const std::int64_t ratio = std::int64_t{place_.joint.ratio.raw} << 10;
    RawVec3 n = raw_of(b.unit);
    for (std::int64_t& x : n)
      x = product_rounded(x, ratio, 30);
    JointRow row;
    row.linear_a = raw_of(a.unit);
    row.linear_b = n;
    row.angular_a = lever(arm_a_, row.linear_a, place_.scale_a);
    row.angular_b = lever(arm_b_, row.linear_b, place_.scale_b);
    const auto bounded = [](std::uint64_t x) {
      return static_cast<std::int64_t>(std::min(x, std::uint64_t{1} << 44));
    };
    const std::int64_t out = bounded(a.length) + product_rounded(bounded(b.length), ratio, 30) -
                             (std::int64_t{place_.joint.total_length.raw} << 12);
    push([&] { return row; }, 0, RowKind::lock, out);
  }

  // Rows of ratios beyond 1 are read per 2^shift, so that Jacobians keep their range.
  [[nodiscard]] int ratio_shift() const {
    const std::int64_t ratio = place_.joint.ratio.raw;
    const auto size = static_cast<std::uint64_t>(ratio < 0 ? -ratio : ratio);
    return std::max(0, static_cast<int>(std::bit_width(size)) - 20);
  }

  // v · ratio · 2^-shift
  [[nodiscard]] RawVec3 geared(const RawVec3& v, int shift) const {
    RawVec3 result;
    for (std::size_t i = 0; i < 3; ++i)
      result[i] = product_rounded(v[i], place_.joint.ratio.raw, 20 + shift);
    return result;
  }

  void fill_gear() {
    const int shift = ratio_shift();
    RawVec3 x = raw_of(frame_a_.x);
    for (std::int64_t& part : x)
      part = shifted(part, shift);
    JointRow row;
    row.angular_a = negated(angular_row(x).angular_a);
    row.angular_b = angular_row(geared(raw_of(frame_b_.x), shift)).angular_b;
    push([&] { return row; }, 0, RowKind::lock, 0);
  }

  void fill_rack() {
    const int shift = ratio_shift();
    RawVec3 x = raw_of(frame_a_.x);
    for (std::int64_t& part : x)
      part = shifted(part, shift);
    JointRow row;
    row.angular_a = negated(angular_row(x).angular_a);
    row.linear_b = geared(raw_of(frame_b_.x), shift - place_.exponent);
    row.angular_b = lever(arm_b_, row.linear_b, place_.scale_b);
    push([&] { return row; }, 0, RowKind::lock, 0);
  }

  const JointPlace& place_;
  const RowParts parts_;
  JointRows* const out_;
  LockErrors* const errors_;
  SpringTurn springs_ = SpringTurn::apart;
  Mat3 frame_a_{}, frame_b_{};
  Vec3<Position> arm_a_{}, arm_b_{}, gap_{};
};

}  // namespace

bool has_world_axes(const JointRecord& joint) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (joint.mode(i) != AxisMode::locked || joint.axes[i].is_driven()) return false;
  }
  return true;
}

std::size_t most_rows(const JointRecord& joint) {
  if (joint.kind >= static_cast<std::uint8_t>(JointKind::pulley)) return 1;
  std::size_t count = 0;
  for (std::size_t axis = 0; axis < k_joint_axes; ++axis) {
    if (joint.mode(axis) != AxisMode::free) ++count;
    if (joint.axes[axis].is_driven()) ++count;
  }
  return count;
}

bool is_point(const JointRecord& joint) {
  if (!joint.is(JointKind::ball) || !has_world_axes(joint)) return false;
  for (std::size_t axis = 3; axis < k_joint_axes; ++axis) {
    if (joint.mode(axis) != AxisMode::free || joint.axes[axis].is_driven()) return false;
  }
  return true;
}

bool holds_a_point(const JointRecord& joint, std::uint8_t far) {
  if (joint.kind >= static_cast<std::uint8_t>(JointKind::pulley)) return false;
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

RawVec3 response_of(const InverseInertia& m, const RawVec3& j) {
  // With |entries| ≤ 2^30 and levers below 2^31 the sums stay below 3·2^61.
  if (((magnitude(j[0]) | magnitude(j[1]) | magnitude(j[2])) >> 31) == 0) {
    const auto row = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
      return raw::round_shift(a * j[0] + b * j[1] + c * j[2], 30 - m.exponent);
    };
    return {row(m.xx, m.xy, m.xz), row(m.xy, m.yy, m.yz), row(m.xz, m.yz, m.zz)};
  }
  const auto row = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    ProductSum sum;
    sum.add(a, j[0]);
    sum.add(b, j[1]);
    sum.add(c, j[2]);
    return sum.rounded(30 - m.exponent);
  };
  return {row(m.xx, m.xy, m.xz), row(m.xy, m.yy, m.yz), row(m.xz, m.yz, m.zz)};
}

LockErrors lock_errors(const JointPlace& place) {
  LockErrors errors;
  RowFiller(place, RowParts::locks, nullptr, &errors).fill();
  return errors;
}

void fill_rows(const JointPlace& place, RowParts parts, JointRows& out) {
  RowFiller(place, parts, &out, nullptr).fill();
}

}  // namespace lockstone
