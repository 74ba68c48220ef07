#include "core/dynamics/joint/pivot_integrator.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/body/free_rotation.h"
#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/body/tick_gain.h"
#include "core/dynamics/joint/joint_geometry.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/math/principal_axes.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// A joint that is open by more is closed by the solver.
constexpr std::int64_t k_most_gap = std::int64_t{1} << (Position::frac_bits - 16);

// A substep is taken in pieces of at most half a radian of the swing, in this many at most.
constexpr std::int32_t k_most_pivot_pieces = 32;

// Bits of the mantissa of a pull, so that products below fit in 63 bits.
constexpr int k_pull_bits = 29;
constexpr std::int64_t k_torque_bound = std::int64_t{1} << 31;

// Inverse moments, and a torque divided by a moment, have this many fraction bits.
constexpr int k_inverse_moment_bits = 18;
constexpr int k_turning_bits = 26;
constexpr std::int64_t k_turning_bound = std::int64_t{1} << 30;

RawVec3 cross_q30(const RawVec3& a, const RawVec3& b) {
  const RawVec3 c = cross(a, b);
  return {raw::round_shift(c[0], 30), raw::round_shift(c[1], 30), raw::round_shift(c[2], 30)};
}
RawVec3 turned(const Mat3& m, const RawVec3& v) {
  const auto row = [&](Unit x, Unit y, Unit z) {
    return raw::round_shift(x.raw * v[0] + y.raw * v[1] + z.raw * v[2], 30);
  };
  return {row(m.x.x, m.y.x, m.z.x), row(m.x.y, m.y.y, m.z.y), row(m.x.z, m.y.z, m.z.z)};
}
RawVec3 turned_back(const Mat3& m, const RawVec3& v) {
  const auto row = [&](const Vec3<Unit>& axis) {
    return raw::round_shift(axis.x.raw * v[0] + axis.y.raw * v[1] + axis.z.raw * v[2], 30);
  };
  return {row(m.x), row(m.y), row(m.z)};
}
std::int64_t sum_of(const RawVec3& v) {
  return static_cast<std::int64_t>(magnitude(v[0]) + magnitude(v[1]) + magnitude(v[2]));
}

// u × v for u of 30 bits.
Vec3<Velocity> moment(const RawVec3& u, const Vec3<Velocity>& v) {
  const auto part = [](std::int64_t a, Velocity x, std::int64_t b, Velocity y) {
    ProductSum sum;
    sum.add(a, x.raw);
    sum.subtract(b, y.raw);
    return Velocity::from_raw(sum.rounded(30));
  };
  return {part(u[1], v.z, u[2], v.y), part(u[2], v.x, u[0], v.z), part(u[0], v.y, u[1], v.x)};
}

Vec3<Velocity> scaled(const Vec3<Velocity>& v, int shift) {
  const auto part = [&](Velocity x) { return Velocity::from_raw(raw::scale_binary(x.raw, shift)); };
  return {part(v.x), part(v.y), part(v.z)};
}

// From the centre of mass to the anchor, per 2^exponent m: the first power of two below neither the
// body's radius nor the anchor's length. 30 bits.
struct Arm {
  int exponent = 0;
  RawVec3 part{};
  bool is_along_axis = false;  // of the body: its principal axes serve for the pivot as well

  Arm(const BodyRecord& body, const Vec3<Length>& anchor) {
    std::uint64_t sizes = 0;
    for (int i = 0; i < 3; ++i)
      sizes |= magnitude(anchor[i].raw);
    const int width = static_cast<int>(std::bit_width(sizes)) - Length::frac_bits;
    const int zeros = (anchor.x.raw == 0) + (anchor.y.raw == 0) + (anchor.z.raw == 0);
    is_along_axis = zeros >= 2;
    exponent = std::max<int>(body.scale_exponent, width + (is_along_axis ? 0 : 1));
    const int shift = Unit::frac_bits - Length::frac_bits - exponent;
    for (int i = 0; i < 3; ++i)
      part[static_cast<std::size_t>(i)] = raw::scale_binary(anchor[i].raw, shift);
    LKS_ASSERT(sum_of(part) <= std::int64_t{3} << 30);
  }
};

// Principal moments about the pivot over mass and squared scale, 30 bits, up to 2, and their axes
// in the body's frame of mass.
struct PivotInertia {
  Vec3<Unit> moments{};
  Quat axes{};
};

// By Steiner: I + |a|² − a·aᵀ.
PivotInertia inertia_about(const BodyRecord& body, const Arm& arm) {
  const auto product = [&](std::size_t i, std::size_t j) {  // a quarter, 60 bits
    return raw::round_shift(arm.part[i] * arm.part[j], 2);
  };
  const std::int64_t x = product(0, 0), y = product(1, 1), z = product(2, 2);
  const int distance = 2 * (arm.exponent - body.scale_exponent);
  const auto own = [&](int i) {
    return raw::round_shift(std::int64_t{body.inertia[i].raw} << 28, distance);
  };
  PrincipalAxes found{{own(0) + y + z, own(1) + z + x, own(2) + x + y}, {}};
  if (!arm.is_along_axis) {
    const Vec3<std::int64_t>& d = found.moments;
    found = principal_axes({d.x, d.y, d.z, -product(0, 1), -product(0, 2), -product(1, 2)});
  }
  PivotInertia result{{}, found.axes};
  LKS_ASSERT(distance >= 0);  // the arm's scale is not below the body's
  for (int i = 0; i < 3; ++i) {
    const std::int64_t whole = raw::round_shift(found.moments[i], 28);
    result.moments[i].raw = raw::saturate<std::int32_t>(std::max(whole, std::int64_t{1}));
  }
  return result;
}

// The acceleration by gravity and forces: mantissas times 2^exponent, in units of Acceleration.
struct Pull {
  RawVec3 mantissa{};
  int exponent = 0;

  Pull(const BodyRecord& body, const Vec3<Acceleration>& gravity, const TimeStep& step) {
    constexpr std::int64_t k_most = std::int64_t{1} << 55;
    const Vec3<Acceleration> g = gravity_on(body, gravity);
    const Vec3<Velocity> force = tick_gain_of(body).velocity;
    RawVec3 sum;
    std::uint64_t sizes = 0;
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      sum[axis] = std::clamp(g[i].raw + force[i].raw * step.tick_rate, -k_most, k_most);
      sizes |= magnitude(sum[axis]);
    }
    if (sizes == 0) return;
    exponent = static_cast<int>(std::bit_width(sizes)) - k_pull_bits;
    for (std::size_t i = 0; i < 3; ++i) {
      mantissa[i] = raw::scale_binary(sum[i], -exponent);
      LKS_ASSERT(magnitude(mantissa[i]) >> k_pull_bits <= 1);
    }
  }
};

// In how many pieces a substep resolves the swing: (h·ω)² ≤ ¼, where ω² ≤ |arm|·|pull| / I. 0: in
// none.
std::int32_t pieces_of(const Pull& pull, const Arm& arm, const Vec3<Unit>& moments,
                       const TimeStep& step) {
  const auto& [x, y, z] = moments;
  const Unit middle = max(min(x, y), min(max(x, y), z));
  LKS_ASSERT(middle.raw > 0);
  const std::int64_t product = (sum_of(pull.mantissa) >> 1) * (sum_of(arm.part) >> 2) / middle.raw;
  const int shift = pull.exponent - 27 - arm.exponent;  // of 4·ω²
  for (std::int32_t pieces = 1; pieces <= k_most_pivot_pieces; pieces *= 2) {
    const std::int64_t rate = std::int64_t{step.substep_rate()} * pieces;
    const std::int64_t left = shift < 0 ? product >> std::min(-shift, 62) : product;
    const std::int64_t right = shift > 0 ? (rate * rate) >> std::min(shift, 62) : rate * rate;
    if (left <= right) return pieces;
  }
  return 0;
}

// A torque times a part of a piece, as spin.
struct Kick {
  Factor factor;
  int shift;

  Kick(const Pull& pull, std::int64_t divisor, int doubled = 0)
      : factor(Factor::one_over(divisor)), shift(factor.shift - pull.exponent - doubled) {}

  void add(const RawVec3& torque, Vec3<Velocity>& spin) const {
    if (shift > 62) return;
    for (int i = 0; i < 3; ++i) {
      const std::int64_t product = torque[static_cast<std::size_t>(i)] * factor.mantissa;
      spin[i].raw += raw::round_shift(product, shift);
    }
  }
};

// The body about its pivot, on its way through a tick: orientation and angular momentum / (mass ·
// 2^exponent), as spin is of a body.
class PivotMotion {
 public:
  PivotMotion(const BodyRecord& body, const Mat3& rotation, const Arm& arm,
              const PivotInertia& inertia, const Pull& pull)
      : arm_(arm), pull_(pull), moments_(inertia.moments), from_pivot_(negated(arm.part)) {
    const RawVec3 u = turned(rotation, from_pivot_);
    spin_ = scaled(body.spin, body.scale_exponent - arm.exponent) + moment(u, body.velocity);
    orientation_ = body.orientation;
    rotation_ = rotation;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t own = moments_[static_cast<int>(i)].raw;
      LKS_ASSERT(own > 0);
      inverse_[i] = raw::round_divide(std::int64_t{1} << (30 + k_inverse_moment_bits), own);
    }
    if (inertia.axes == Quat{}) return;
    orientation_ = normalized(multiply(orientation_, inertia.axes));
    rotation_ = to_matrix(orientation_);
    from_pivot_ = turned_back(to_matrix(inertia.axes), from_pivot_);
  }

  // By `pieces` of 1 / rate each, with a constant torque besides, as spin in each; returns the
  // turns about an axis that it took.
  std::uint32_t run(std::int32_t rate, std::int32_t pieces, const Vec3<Velocity>& torque) {
    LKS_ASSERT(rate > 0 && pieces > 0);
    const FreeRotor rotor(moments_, arm_.exponent, {2 * rate, Unit::from_integer(1)});
    const Kick first(pull_, std::int64_t{6} * rate), between(pull_, std::int64_t{3} * rate),
        middle(pull_, std::int64_t{3} * rate, 1);
    const Factor h = Factor::one_over(rate), part = Factor::one_over(std::int64_t{24} * rate);
    const int shift = h.shift + part.shift - 33 - pull_.exponent + arm_.exponent;
    std::uint32_t turns = 0;
    first.add(torque_on(arm()), spin_);
    for (std::int32_t piece = 1; piece <= pieces; ++piece) {
      turns += turn(rotor);
      const RawVec3 u = arm(), plain = torque_on(u), gradient = gradient_on(u, plain);
      RawVec3 both = plain;
      for (std::size_t i = 0; i < 3 && shift <= 62; ++i) {
        const std::int64_t step = raw::round_shift(gradient[i] * part.mantissa, 31) * h.mantissa;
        both[i] += raw::round_shift(step, std::max(shift, 0));
        both[i] = std::clamp(both[i], -k_torque_bound, k_torque_bound);
      }
      middle.add(both, spin_);
      spin_ += torque;
      turns += turn(rotor);
      (piece < pieces ? between : first).add(torque_on(arm()), spin_);
    }
    return turns;
  }

  [[nodiscard]] const Quat& orientation() const { return orientation_; }
  [[nodiscard]] const Vec3<Velocity>& spin() const { return spin_; }

  // Of the arm's unit: ω · 2^exponent.
  [[nodiscard]] Vec3<Velocity> surface_velocity() const {
    Vec3<Velocity> w = rotate_inverse_wide(rotation_, spin_);
    for (int i = 0; i < 3; ++i) {
      const std::int64_t inverse = raw::round_divide(std::int64_t{1} << 60, moments_[i].raw);
      w[i].raw = product_rounded(w[i].raw, inverse, 30);
    }
    return rotate_wide(rotation_, w);
  }

 private:
  std::uint32_t turn(const FreeRotor& rotor) {
    const FreeTurn turn = rotor.turn(orientation_, rotation_, spin_);
    orientation_ = turn.orientation;
    rotation_ = to_matrix(orientation_);
    return turn.axis_turns;
  }

  // From the pivot to the centre of mass.
  [[nodiscard]] RawVec3 arm() const { return turned(rotation_, from_pivot_); }
  [[nodiscard]] RawVec3 torque_on(const RawVec3& arm) const {
    return cross_q30(arm, pull_.mantissa);
  }

  // Half of ∇(τ·Wτ): u × (g × y) + y × τ with y = Wτ.
  [[nodiscard]] RawVec3 gradient_on(const RawVec3& u, const RawVec3& torque) const {
    RawVec3 y = turned_back(rotation_, torque);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int64_t own =
          raw::round_shift(y[i] * inverse_[i], 30 + k_inverse_moment_bits - k_turning_bits);
      y[i] = std::clamp(own, -k_turning_bound, k_turning_bound);
    }
    y = turned(rotation_, y);
    const RawVec3 a = cross_q30(u, cross_q30(pull_.mantissa, y)), b = cross_q30(y, torque);
    RawVec3 sum;
    for (std::size_t i = 0; i < 3; ++i)
      sum[i] = std::clamp(a[i] + b[i], -k_torque_bound, k_torque_bound);
    return sum;
  }

  const Arm& arm_;
  const Pull& pull_;
  const Vec3<Unit>& moments_;
  RawVec3 inverse_{};
  RawVec3 from_pivot_;  // to the centre of mass, along the axes below
  Quat orientation_;    // of the principal axes about the pivot
  Mat3 rotation_;
  Vec3<Velocity> spin_;
};

}  // namespace

bool can_step_about_pivot(const BodyRecord& body, const Mat3& rotation, const Pivot& pivot,
                          const Vec3<Acceleration>& gravity, const TimeStep& step) {
  LKS_ASSERT(body.is_dynamic());
  const Vec3<Position> gap = body.position + arm_of(rotation, pivot.anchor) - pivot.place;
  for (int i = 0; i < 3; ++i)
    if (gap[i].raw > k_most_gap || gap[i].raw < -k_most_gap) return false;
  const Arm arm(body, pivot.anchor);
  const Unit least = min(body.inertia.x, min(body.inertia.y, body.inertia.z));
  const int distance = 2 * (arm.exponent - body.scale_exponent);
  if (least.raw >> std::min(distance, 31) < k_min_inertia.raw) return false;
  const Pull pull(body, gravity, step);
  return pieces_of(pull, arm, inertia_about(body, arm).moments, step) != 0;
}

PivotStep step_about_pivot(BodyRecord& body, const Mat3& rotation, const Pivot& pivot,
                           const Vec3<Acceleration>& gravity, const TimeStep& step) {
  const Arm arm(body, pivot.anchor);
  const PivotInertia inertia = inertia_about(body, arm);
  const Pull pull(body, gravity, step);
  const std::int32_t pieces = std::max(pieces_of(pull, arm, inertia.moments, step), 1);
  LKS_ASSERT(body.is_dynamic() && step.substeps > 0);
  const TickGain gain = tick_gain_of(body);
  Vec3<Velocity> torque = scaled(gain.spin, body.scale_exponent - arm.exponent);
  for (int i = 0; i < 3; ++i)
    torque[i].raw = raw::round_divide(torque[i].raw, pieces * step.substeps);

  PivotMotion motion(body, rotation, arm, inertia, pull);
  PivotStep result;
  result.axis_turns = motion.run(step.substep_rate() * pieces, step.substeps * pieces, torque);

  body.orientation = inertia.axes == Quat{}
                         ? motion.orientation()
                         : normalized(multiply(motion.orientation(), conjugate(inertia.axes)));
  const Mat3 end = to_matrix(body.orientation);
  const RawVec3 back = turned(end, arm.part);
  const Vec3<Velocity> before = body.velocity + tick_gain(body, gravity, step);
  body.velocity = moment(back, motion.surface_velocity());  // (−back) × … the other way about
  body.spin =
      scaled(motion.spin() + moment(back, body.velocity), arm.exponent - body.scale_exponent);
  body.position = pivot.place - arm_of(end, pivot.anchor);
  result.impulse = body.velocity - before;
  for (int i = 0; i < 3; ++i)
    result.impulse[i].raw = raw::round_divide(result.impulse[i].raw, step.substeps);
  return result;
}

}  // namespace lockstone
