// Collects the rows of a joint while they are computed.
//
// The mode of an axis decides which rows it has: a lock, or the nearer one of its limits, or none;
// besides that a drive. Where only the errors of locks are wanted, no Jacobian is computed.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <lockstone/assert.h>
#include <lockstone/units.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/joint/joint_vectors.h"
#include "core/dynamics/joint/turn_springs.h"

namespace lockstone {

/// From the centres of mass to the anchors, and from anchor a to anchor b, in world axes.
struct JointArms {
  Vec3<Position> a{}, b{}, gap{};
};

/// Angular rows reach no farther than this many powers of two beyond a body's scale.
inline constexpr int k_most_lever = 12;

class RowWriter {
 public:
  /// Writes rows, or the errors of locks: one of both.
  RowWriter(const JointPlace& place, RowParts parts, JointRows* out, LockErrors* errors)
      : place_(place), parts_(parts), out_(out), errors_(errors) {
    LKS_ASSERT((out == nullptr) != (errors == nullptr));
    LKS_ASSERT(errors == nullptr || parts == RowParts::locks);
    if (out == nullptr) return;
    out->locks = out->count = 0;
    out->is_point = false;
  }

  [[nodiscard]] const JointPlace& place() const { return place_; }
  [[nodiscard]] bool wants_all() const { return parts_ == RowParts::all; }

  /// Springs about several axes that have rows together, and none by themselves.
  void act_together(SpringTurn springs) { springs_ = springs; }
  [[nodiscard]] bool acts_together(std::size_t axis) const {
    return springs_ != SpringTurn::apart && lockstone::acts_together(place_.joint, springs_, axis);
  }

  [[nodiscard]] bool is_far(std::size_t axis) const { return (place_.far >> axis & 1) != 0; }
  [[nodiscard]] bool is_rigid(std::size_t axis) const {
    return place_.joint.mode(axis) == AxisMode::locked && !place_.joint.axes[axis].is_spring();
  }

  /// Whether an axis can have a row of the wanted parts.
  [[nodiscard]] bool is_wanted(std::size_t axis) const {
    const JointAxisRecord& settings = place_.joint.axes[axis];
    if (place_.joint.mode(axis) != AxisMode::free && !is_far(axis)) {
      return parts_ == RowParts::all || is_rigid(axis) || settings.lower == settings.upper;
    }
    return parts_ == RowParts::all && settings.is_driven();
  }

  /// A row along n at the ends of both arms, positive where b goes that way.
  [[nodiscard]] JointRow linear_row(const JointArms& arms, const RawVec3& n) const {
    JointRow row;
    row.linear_b = n;
    row.linear_a = negated(n);
    row.angular_b = lever(arms.b, n, place_.scale_b);
    row.angular_a = negated(lever(arms.a, n, place_.scale_a));
    return row;
  }

  /// A row about an axis (Q30, of any length), positive where b turns that way.
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

  /// Adds a row; `make` returns its Jacobians, which errors alone do not need.
  template <class Make>
  void push(const Make& make, std::size_t axis, RowKind kind, std::int64_t error) {
    if (kind != RowKind::lock && parts_ != RowParts::all) return;
    if (errors_ != nullptr) {
      LKS_ASSERT(errors_->count < errors_->errors.size());
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

  /// Adds the rows of one axis, where it stands at `value` (m, Q32).
  template <class Make>
  void add_axis(std::size_t axis, const Make& make, std::int64_t value, bool limits = true) {
    LKS_ASSERT(axis < k_joint_axes);
    const JointAxisRecord& settings = place_.joint.axes[axis];
    const AxisMode mode = place_.joint.mode(axis);
    const bool soft = mode == AxisMode::locked && settings.is_spring();
    if (is_rigid(axis)) return push(make, axis, RowKind::lock, value);
    if (mode == AxisMode::limited && limits && !is_far(axis)) {
      LKS_ASSERT(settings.lower <= settings.upper);
      const std::int64_t above = value - value_of(axis, settings.lower);
      if (settings.lower == settings.upper) return push(make, axis, RowKind::lock, above);
      if (place_.joint.is(JointKind::ratchet) && axis == 3)
        push(make, axis, RowKind::limit, beyond_tooth(above));
      else
        add_limit(axis, make, above, value_of(axis, settings.upper) - value);
    }
    if (!settings.is_driven() || acts_together(axis)) return;
    const auto drive = [&] {
      JointRow row = make();
      row.speed = speed_of(axis, settings.speed);
      return row;
    };
    const std::int64_t error = value - (soft ? 0 : value_of(axis, settings.target));
    push(drive, axis, RowKind::drive, is_wrapped(axis) ? nearer(error) : error);
  }

  /// A length or an angle as an error in m, Q32.
  [[nodiscard]] std::int64_t value_of(std::size_t axis, std::int32_t setting) const {
    if (axis < 3) return std::int64_t{setting} << 12;
    return arc(std::int64_t{setting} << 5);
  }
  [[nodiscard]] std::int64_t speed_of(std::size_t axis, std::int32_t setting) const {
    const std::int64_t bound = std::int64_t{1} << 60;
    const std::int64_t speed = axis < 3 ? setting : shifted(setting, -place_.exponent);
    return std::clamp(speed, -(bound >> 30), bound >> 30) * k_one;
  }
  /// An angle in Q32 as an arc in m, Q32.
  [[nodiscard]] std::int64_t arc(std::int64_t angle) const {
    return shifted(angle, -place_.exponent);
  }

  /// Gives the locks about axes the speeds with which they turn.
  void turn_locks() {
    if (out_ == nullptr) return;
    LKS_ASSERT(place_.turns_locks);
    for (JointRow& row : out_->rows.first(out_->locks))
      if (row.axis >= 3) row.speed = speed_of(row.axis, place_.joint.axes[row.axis].speed);
  }

  /// Three locks along the axes of the world, which keep the anchors together.
  void lock_point(const JointArms& arms) {
    if (errors_ != nullptr) {
      for (int i = 0; i < 3; ++i)
        errors_->errors[errors_->count++] = bounded(arms.gap[i].raw, k_product_bound);
      return;
    }
    LKS_ASSERT(out_->count == 0 && out_->rows.size() >= 3);
    const RawVec3 lever_a = scaled_arm(arms.a, place_.scale_a);
    const RawVec3 lever_b = scaled_arm(arms.b, place_.scale_b);
    for (std::size_t i = 0; i < 3; ++i) {
      JointRow& row = out_->rows[i];
      row.axis = static_cast<std::uint8_t>(i);
      row.kind = RowKind::lock;
      row.flipped = false;
      row.speed = 0;
      row.error = bounded(arms.gap[static_cast<int>(i)].raw, k_product_bound);
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

 private:
  // Whether an axis turns on and on.
  [[nodiscard]] bool is_wrapped(std::size_t axis) const {
    return axis == 3 &&
           (place_.joint.mode(3) == AxisMode::free || place_.joint.is(JointKind::ratchet));
  }
  // The turn beyond the tooth that holds a ratchet: −π/2 … 3π/2.
  [[nodiscard]] std::int64_t beyond_tooth(std::int64_t above) const {
    const std::int64_t whole = arc(k_two_pi_q28 << 4);
    return 4 * above < -whole ? above + whole : 4 * above >= 3 * whole ? above - whole : above;
  }
  // The twist that is left, the shorter way round.
  [[nodiscard]] std::int64_t nearer(std::int64_t error) const {
    const std::int64_t whole = arc(k_two_pi_q28 << 4), half = whole / 2;
    return error > half ? error - whole : error < -half ? error + whole : error;
  }

  template <class Make>
  void add_limit(std::size_t axis, const Make& make, std::int64_t above, std::int64_t below) {
    LKS_ASSERT(axis < k_joint_axes);
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

  const JointPlace& place_;
  const RowParts parts_;
  JointRows* const out_;
  LockErrors* const errors_;
  SpringTurn springs_ = SpringTurn::apart;
};

}  // namespace lockstone
