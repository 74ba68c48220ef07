#include "core/dynamics/impact/impact_response.h"

#include <algorithm>
#include <array>
#include <limits>

#include <lockstone/assert.h>

#include "core/dynamics/body/motion.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/math/block_float.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

constexpr int k_passes_per_point = 12;

// Impulses stay below this, m/s: more than any approach asks for where the answer is not absurd.
constexpr Velocity k_most_impulse = Velocity::from_integer(1 << 20);

// Of restitution, where with it the bodies would gain energy: half, a quarter, none.
constexpr int k_attempts = 4;

// r / 2^k, 30 bits, at most 2.
Vec3<Unit> normalized_arm(const Vec3<Length>& r, int scale_exponent) {
  const auto entry = [&](Length x) {
    return Unit::from_raw(
        raw::saturate<std::int32_t>(std::int64_t{x.raw} << (10 - scale_exponent)));
  };
  return {entry(r.x), entry(r.y), entry(r.z)};
}

Velocity dot(const Vec3<Velocity>& v, const Vec3<Unit>& u) {
  return times(v.x, u.x) + times(v.y, u.y) + times(v.z, u.z);
}

Vec3<Velocity> times(const Vec3<Unit>& u, Velocity v) {
  return {times(v, u.x), times(v, u.y), times(v, u.z)};
}

// r × v
Vec3<Velocity> cross_arm(const Vec3<Unit>& r, const Vec3<Velocity>& v) {
  return {times(v.z, r.y) - times(v.y, r.z), times(v.x, r.z) - times(v.z, r.x),
          times(v.y, r.x) - times(v.x, r.y)};
}

// One side of the pair.
struct Side {
  ImpactBody body;
  Unit share;  // α: its part of the pair's velocity jump
  bool turns;
  bool is_ball;

  [[nodiscard]] Vec3<Velocity> velocity_at(const Vec3<Unit>& arm) const {
    const Vec3<Velocity> w = surface_velocity(body.inertia, body.record.spin);
    return body.record.velocity - cross_arm(arm, w);  // ω × r = −(r × ω)
  }

  // The jump P, or −P, at a point. Along the normal it does not turn a ball.
  void push(const Vec3<Velocity>& jump, const Vec3<Unit>& arm, bool along_normal) const {
    if (share == Unit{}) return;  // others may be reading it
    const Vec3<Velocity> own{times(jump.x, share), times(jump.y, share), times(jump.z, share)};
    body.record.velocity += own;
    if (turns && !(is_ball && along_normal)) body.record.spin += cross_arm(arm, own);
    apply_axis_locks(body.record);
  }

  // α (u·u + (r̄ × u) · M (r̄ × u)), 32 bits; u·u without locked axes
  [[nodiscard]] std::int64_t compliance(const Vec3<Unit>& arm, const Vec3<Unit>& u) const {
    LKS_ASSERT(share >= Unit{} && share <= Unit::from_integer(1) && geometry::is_unit(u));
    std::int64_t free = std::int64_t{share.raw} * 4;
    for (int i = 0; i < 3; ++i) {
      if (!body.record.is_locked(i)) continue;
      const std::int64_t square = raw::round_shift(std::int64_t{u[i].raw} * u[i].raw, 28);
      free -= raw::multiply_shift(square, share.raw, Unit::frac_bits);
    }
    if (!turns || share == Unit{}) return free;
    const Vec3<Velocity> axis = cross_arm(arm, times(u, Velocity::from_integer(1)));
    const Vec3<Velocity> w = surface_velocity(body.inertia, axis);
    const auto product = [](Velocity a, Velocity b) { return saturated_product(a.raw, b.raw, 32); };
    const std::int64_t sum = product(axis.x, w.x) + product(axis.y, w.y) + product(axis.z, w.z);
    return free + raw::multiply_shift(std::max<std::int64_t>(sum, 0), share.raw, Unit::frac_bits);
  }
};

struct Point {
  Vec3<Unit> arm_a, arm_b;
  Velocity wanted{};   // the speed apart to reach, ≥ 0
  Velocity impulse{};  // along the normal so far
};

// The work of impulses, per mass, Q32.
struct Work {
  std::int64_t sum = 0;
  std::int64_t gross = 0;  // of magnitudes

  // By an impulse along a direction in which the relative velocity went from `before` to `after`.
  void add(Velocity impulse, Velocity before, Velocity after) {
    const auto half = [&](Velocity v) { return saturated_product(impulse.raw, v.raw, 33); };
    const std::int64_t first = half(before), last = half(after);
    sum = raw::saturating_add(sum, raw::saturating_add(first, last));
    gross = raw::saturating_add(gross, raw::saturating_add(magnitude(first), magnitude(last)));
  }

  // More than rounding gains, or more than is counted.
  [[nodiscard]] bool is_gain() const {
    return gross > k_most || sum > (gross >> 16) + (std::int64_t{1} << 8);
  }

 private:
  static constexpr std::int64_t k_most = std::numeric_limits<std::int64_t>::max() / 2;

  [[nodiscard]] static std::int64_t magnitude(std::int64_t x) {
    return std::max(x, -std::max(x, -std::numeric_limits<std::int64_t>::max()));
  }
};

// The fields of a body that an impact changes.
struct SideMotion {
  Vec3<Velocity> velocity, spin;
};

class ImpactSolver {
 public:
  ImpactSolver(const Side& a, const Side& b, const ImpactContact& contact)
      : a_(a), b_(b), contact_(contact), normal_(contact.manifold.normal) {
    LKS_ASSERT(geometry::is_unit(normal_));
    for (int i = 0; i < contact.manifold.count; ++i) {
      const ManifoldPoint& from = contact.manifold.points[static_cast<std::size_t>(i)];
      Point& point = points_[static_cast<std::size_t>(i)];
      point.arm_a = normalized_arm(from.anchor_a, a.body.record.scale_exponent);
      point.arm_b = normalized_arm(from.anchor_b, b.body.record.scale_exponent);
      const Velocity approach = -dot(relative(point), normal_);
      greatest_approach_ = max(greatest_approach_, approach);
      if (approach > contact.threshold) point.wanted = times(approach, contact.restitution);
    }
  }

  // Restitution says how fast the points part, whatever friction and axis locks make of the way
  // there, and so may give the bodies more than they had (T. R. Kane, "A dynamics puzzle", 1984).
  // Without restitution all impulses take energy away.
  Velocity run() {
    const SideMotion before_a = motion_of(a_), before_b = motion_of(b_);
    for (int attempt = 0; attempt < k_attempts; ++attempt) {
      sweep();
      if (!work_.is_gain()) break;
      set_motion(a_, before_a);
      set_motion(b_, before_b);
      start_again(attempt + 2 == k_attempts);
    }
    LKS_ASSERT(greatest_approach_ >= Velocity{});
    return greatest_approach_;
  }

 private:
  static SideMotion motion_of(const Side& side) {
    return {side.body.record.velocity, side.body.record.spin};
  }

  static void set_motion(const Side& side, const SideMotion& motion) {
    if (side.share == Unit{}) return;  // others may be reading it
    side.body.record.velocity = motion.velocity;
    side.body.record.spin = motion.spin;
  }

  void start_again(bool without_restitution) {
    work_ = {};
    for (Point& point : points_) {
      point.impulse = {};
      point.wanted = without_restitution ? Velocity{} : point.wanted / 2;
    }
  }

  void sweep() {
    for (int i = 0; i < k_passes_per_point * contact_.manifold.count; ++i)
      solve(points_[static_cast<std::size_t>(i % contact_.manifold.count)]);
  }

  [[nodiscard]] Vec3<Velocity> relative(const Point& point) const {
    return b_.velocity_at(point.arm_b) - a_.velocity_at(point.arm_a);
  }

  // The jump that changes the relative velocity along u by `change`.
  [[nodiscard]] Velocity jump_for(Velocity change, const Point& point, const Vec3<Unit>& u) const {
    constexpr std::int64_t k_least = std::int64_t{1} << 26;  // locks may leave hardly any
    const std::int64_t stiffness =
        std::max(a_.compliance(point.arm_a, u) + b_.compliance(point.arm_b, u), k_least);
    return Velocity::from_raw(round_divide(Int128::from(change.raw) << 32, stiffness));
  }

  void push(const Point& point, const Vec3<Velocity>& jump, bool along_normal) {
    a_.push(-jump, point.arm_a, along_normal);
    b_.push(jump, point.arm_b, along_normal);
  }

  void solve(Point& point) {
    const Velocity speed = dot(relative(point), normal_);
    const Velocity jump = jump_for(point.wanted - speed, point, normal_);
    const Velocity before = point.impulse;
    LKS_ASSERT(point.impulse >= Velocity{});
    point.impulse = clamp(Velocity::from_raw(raw::saturating_add(before.raw, jump.raw)), Velocity{},
                          k_most_impulse);
    const Velocity change = point.impulse - before;
    if (change == Velocity{}) return;
    push(point, times(normal_, change), true);
    const Vec3<Velocity> after = relative(point);
    work_.add(change, speed, dot(after, normal_));
    if (change > Velocity{}) slow_sliding(point, after, times(change, contact_.friction));
  }

  // Friction for this much more normal impulse.
  void slow_sliding(const Point& point, const Vec3<Velocity>& v, Velocity limit) {
    const Vec3<Velocity> across = v - times(normal_, dot(v, normal_));
    if (across == Vec3<Velocity>{}) return;
    const Vec3<Unit> direction = direction_of(across);
    const Velocity speed = dot(across, direction);
    const Velocity jump = -min(jump_for(speed, point, direction), limit);
    push(point, times(direction, jump), false);
    work_.add(jump, speed, dot(relative(point), direction));
  }

  const Side& a_;
  const Side& b_;
  const ImpactContact& contact_;
  Vec3<Unit> normal_;
  std::array<Point, k_max_manifold_points> points_{};
  Velocity greatest_approach_{};
  Work work_;
};

Side side_of(ImpactBody body, ImpactBody other) {
  const Unit share = ratio(body.record.inverse_mass_value(), other.record.inverse_mass_value());
  const BodyRecord& record = body.record;
  return {body, share, record.rotates() && record.is_dynamic(),
          record.shape().kind == ShapeKind::sphere};
}

}  // namespace

Velocity answer_impact(ImpactBody a, ImpactBody b, const ImpactContact& contact) {
  const Side side_a = side_of(a, b), side_b = side_of(b, a);
  LKS_ASSERT(contact.restitution >= Coefficient{} && contact.friction >= Coefficient{});
  LKS_ASSERT(contact.manifold.count <= k_max_manifold_points);
  return ImpactSolver(side_a, side_b, contact).run();
}

}  // namespace lockstone
