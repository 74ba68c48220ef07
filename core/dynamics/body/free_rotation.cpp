#include "core/dynamics/body/free_rotation.h"

#include <algorithm>
#include <array>
#include <bit>

#include <lockstone/assert.h>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

// Components of the momentum in body axes have this many bits, so that its norm has one more.
constexpr int k_momentum_bits = 29;
constexpr int k_rate_bits = 30;

// Fraction bits of a difference of inverse moments, and of the same times the duration.
constexpr int k_inverse_bits = 30;
constexpr int k_step_bits = 50;

// Angles have 32 fraction bits.
constexpr std::uint64_t k_piece = std::uint64_t{1} << 32;
constexpr std::uint64_t k_most_pieces = 32;
// Below this the product of the turns about both axes is small enough for Strang's scheme: 2^-20.
constexpr UInt128 k_small_product = {0, std::uint64_t{1} << (64 - 20)};

// The turn for a momentum m is m · mantissa · 2^-shift, 32 bits.
struct TurnRate {
  std::int64_t mantissa = 0;
  int shift = 0;

  [[nodiscard]] std::int64_t angle(std::int64_t momentum) const {
    if (shift > 62) return 0;
    return raw::scale_binary(momentum * mantissa, -shift);
  }
  [[nodiscard]] TurnRate times(std::int64_t q30) const {
    return {raw::round_shift(mantissa * q30, 30), shift};
  }
};

// x · time, from 30 fraction bits to 50.
std::int64_t times(std::int64_t x, const TurnTime& time, std::int64_t pieces = 1) {
  const std::int64_t wide = x * (std::int64_t{1} << (k_step_bits - k_inverse_bits));
  const std::int64_t step = raw::round_divide(wide, time.rate * pieces);
  if (time.fraction == Unit::from_integer(1)) return step;
  return raw::multiply_shift(step, time.fraction.raw, Unit::frac_bits);
}

// `exponent` is that of the momentum over the one of the body's scale.
TurnRate turn_rate(std::int64_t step, int exponent) {
  const int beyond = std::max(0, static_cast<int>(std::bit_width(magnitude(step))) - k_rate_bits);
  return {raw::round_shift(step, beyond), k_step_bits - exponent - beyond};
}

FreeAxes axes_of(const Vec3<Unit>& inertia, const TurnTime& time) {
  std::array<int, 3> order = {0, 1, 2};
  const auto sort = [&](std::size_t i, std::size_t j) {
    if (inertia[order[i]] < inertia[order[j]]) std::swap(order[i], order[j]);
  };
  sort(0, 1), sort(1, 2), sort(0, 1);  // 1/I ascends
  const auto inverse = [&](std::size_t i) {
    return raw::round_divide(std::int64_t{1} << (2 * k_inverse_bits), inertia[order[i]].raw);
  };
  const std::int64_t least = inverse(0), middle = inverse(1), greatest = inverse(2);
  LKS_ASSERT(least <= middle && middle <= greatest);
  const bool is_least_nearer = middle - least <= greatest - middle;
  FreeAxes axes;
  axes.nearer = is_least_nearer ? order[0] : order[2];
  axes.third = is_least_nearer ? order[2] : order[0];
  axes.nearer_excess = is_least_nearer ? least - middle : greatest - middle;
  axes.third_excess = is_least_nearer ? greatest - middle : least - middle;
  axes.middle_step = times(middle, time);
  if (axes.nearer_excess != 0) axes.nearer_step = times(axes.nearer_excess, time);
  if (axes.third_excess != 0) axes.third_step = times(axes.third_excess, time);
  return axes;
}

// A body on its way: its rotation so far, and its angular momentum, in body axes.
struct Turning {
  std::array<std::int64_t, 3> momentum{};
  FineQuat turned;
  std::uint32_t turns = 0;

  void turn(int axis, const TurnRate& rate) {
    LKS_ASSERT(axis >= 0 && axis < 3);
    const auto i = static_cast<std::size_t>(axis), j = (i + 1) % 3, k = (i + 2) % 3;
    const std::int64_t angle = rate.angle(momentum[i]);
    if (angle == 0) return;
    ++turns;
    const FineSinCos half = half_sin_cos(RotationComponent::from_raw(angle));
    const std::int64_t sin = raw::round_shift(half.sin * half.cos, 30);
    const std::int64_t cos = (std::int64_t{1} << 31) - raw::round_shift(half.sin * half.sin, 30);
    rotate(momentum[j], momentum[k], sin, cos);
    rotate(turned.v[j], turned.v[k], half.sin, half.cos);
    rotate(turned.v[i], turned.w, half.sin, half.cos);
  }

 private:
  // (a, b) ← (a·cos + b·sin, b·cos − a·sin)
  static void rotate(std::int64_t& a, std::int64_t& b, std::int64_t sin, std::int64_t cos) {
    const std::int64_t old_a = a;
    a = raw::round_shift(a * cos + b * sin, 31);
    b = raw::round_shift(b * cos - old_a * sin, 31);
  }
};

struct Split {
  const FreeAxes& axes;
  TurnRate nearer;
  TurnRate third;
};

void turn_by_halves(const Split& split, Turning& body) {
  const TurnRate half = split.nearer.times(1 << 29);
  body.turn(split.axes.nearer, half);
  body.turn(split.axes.third, split.third);
  body.turn(split.axes.nearer, half);
}

// S6: the shares of the third axis and of the nearer one, 30 bits, up to the middle.
constexpr std::int64_t k_third_shares[4] = {85044321, 379216520, -45167036, 235554214};
constexpr std::int64_t k_nearer_shares[3] = {224965133, -154459665, 466365444};
static_assert(2 * (k_third_shares[0] + k_third_shares[1] + k_third_shares[2]) + k_third_shares[3] ==
              1 << 30);
static_assert(2 * (k_nearer_shares[0] + k_nearer_shares[1] + k_nearer_shares[2]) == 1 << 30);

void turn_by_shares(const Split& split, std::int64_t pieces, Turning& body) {
  LKS_ASSERT(pieces >= 1);
  std::array<TurnRate, 4> third;
  std::array<TurnRate, 3> nearer;
  std::ranges::transform(k_third_shares, third.begin(),
                         [&](std::int64_t share) { return split.third.times(share); });
  std::ranges::transform(k_nearer_shares, nearer.begin(),
                         [&](std::int64_t share) { return split.nearer.times(share); });
  constexpr std::size_t k_stages[] = {0, 1, 2, 2, 1, 0};
  constexpr std::size_t k_between[] = {1, 2, 3, 2, 1};
  const TurnRate twice = split.third.times(2 * k_third_shares[0]);
  body.turn(split.axes.third, third[0]);
  for (std::int64_t piece = 1; piece <= pieces; ++piece) {
    for (std::size_t i = 0; i < 5; ++i) {
      body.turn(split.axes.nearer, nearer[k_stages[i]]);
      body.turn(split.axes.third, third[k_between[i]]);
    }
    body.turn(split.axes.nearer, nearer[k_stages[5]]);
    body.turn(split.axes.third, piece < pieces ? twice : third[0]);
  }
}

// Norm of the momentum, at most √3 · 2^k_momentum_bits.
std::int64_t norm_of(const std::array<std::int64_t, 3>& m) {
  const auto square = [](std::int64_t x) { return static_cast<std::uint64_t>(x * x); };
  return isqrt(square(m[0]) + square(m[1]) + square(m[2]));
}

// The turn in the body's own axes; `exponent` as for `turn_rate`.
void turn_residual(const FreeAxes& axes, const TurnTime& time, int exponent, Turning& body) {
  if (axes.third_excess == 0) return;
  Split split{axes, {}, turn_rate(axes.third_step, exponent)};
  if (axes.nearer_excess == 0) return body.turn(axes.third, split.third);
  split.nearer = turn_rate(axes.nearer_step, exponent);
  const std::int64_t norm = norm_of(body.momentum);
  const std::uint64_t nearer = magnitude(split.nearer.angle(norm));
  const std::uint64_t third = magnitude(split.third.angle(norm));
  LKS_ASSERT(norm >= 0);
  const bool is_top = nearer == 0 || third > k_most_pieces * k_piece;
  if (is_top) return body.turn(axes.third, split.third);
  if (multiply_wide(nearer, third) <= k_small_product) {
    turn_by_halves(split, body);
    return;
  }
  const auto pieces = static_cast<std::int64_t>(third / k_piece) + 1;
  if (pieces > 1) {
    split.nearer = turn_rate(times(axes.nearer_excess, time, pieces), exponent);
    split.third = turn_rate(times(axes.third_excess, time, pieces), exponent);
  }
  turn_by_shares(split, pieces, body);
}

// spin / (I_a · scale) · time
RotationVector turn_about(const Vec3<Velocity>& spin, std::int64_t step, int scale_exponent) {
  const auto angle = [&](Velocity v) {
    return RotationComponent::from_raw(
        saturated_product(v.raw, step, k_step_bits + scale_exponent));
  };
  return {angle(spin.x), angle(spin.y), angle(spin.z)};
}

}  // namespace

FreeRotor::FreeRotor(const Vec3<Unit>& inertia, int scale_exponent, const TurnTime& time)
    : axes_(axes_of(inertia, time)), time_(time), scale_exponent_(scale_exponent) {}

RotationVector FreeRotor::about_momentum(const Vec3<Velocity>& spin) const {
  return turn_about(spin, axes_.middle_step, scale_exponent_);
}

FreeTurn FreeRotor::turn(const Quat& orientation, const Mat3& rotation,
                         const Vec3<Velocity>& spin) const {
  const std::uint64_t greatest =
      std::max({magnitude(spin.x.raw), magnitude(spin.y.raw), magnitude(spin.z.raw)});
  if (greatest == 0) return {orientation, 0};
  const int exponent = static_cast<int>(std::bit_width(greatest)) - k_momentum_bits;
  const std::array<std::int64_t, 3> scaled = {raw::scale_binary(spin.x.raw, -exponent),
                                              raw::scale_binary(spin.y.raw, -exponent),
                                              raw::scale_binary(spin.z.raw, -exponent)};
  LKS_ASSERT(std::ranges::all_of(
      scaled, [](std::int64_t x) { return magnitude(x) <= std::uint64_t{1} << k_momentum_bits; }));
  Turning turning;
  for (int i = 0; i < 3; ++i) {
    const Vec3<Unit>& axis = rotation.column(i);
    turning.momentum[static_cast<std::size_t>(i)] = raw::round_shift(
        axis.x.raw * scaled[0] + axis.y.raw * scaled[1] + axis.z.raw * scaled[2], 30);
  }
  turn_residual(axes_, time_, exponent - scale_exponent_, turning);
  return {integrate(orientation, about_momentum(spin), turning.turned), turning.turns};
}

FreeTurn turn_freely(const BodyRecord& body, const Mat3& rotation, const Vec3<Velocity>& spin,
                     const TurnTime& time) {
  if (spin == Vec3<Velocity>{}) return {body.orientation, 0};
  return FreeRotor(body.inertia, body.scale_exponent, time).turn(body.orientation, rotation, spin);
}

RotationVector turn_about_momentum(const BodyRecord& body, const TurnTime& time) {
  return FreeRotor(body.inertia, body.scale_exponent, time).about_momentum(body.spin);
}

}  // namespace lockstone
