#include "core/math/trig.h"

#include <array>
#include <bit>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

/// ⌊2^shift / n!⌉ for the Taylor coefficients.
constexpr std::uint64_t inverse_factorial(int n, int shift) {
  std::uint64_t factorial = 1;
  for (int i = 2; i <= n; ++i)
    factorial *= static_cast<std::uint64_t>(i);
  return ((std::uint64_t{1} << shift) + factorial / 2) / factorial;
}

/// a · b · 2^-32 for values below 2^32.
constexpr std::uint64_t multiply_q32(std::uint64_t a, std::uint64_t b) {
  return (a * b) >> 32;
}

// ⌊2^95 / 2π⌋ in two words. A wrong digit shows in rotations of 2^31 radians, which are tested.
constexpr std::uint64_t k_inverse_turn_high = 0x145f306dU;
constexpr std::uint64_t k_inverse_turn_low = 0xc9c882a53f84eafaU;

// ⌊2π · 2^60⌉ and ⌊π/2 · 2^40⌉: π = 3.243f6a8885a308d3…, hexadecimal.
constexpr std::uint64_t k_turn_q60 = 0x6487ed5110b4611aU;
constexpr std::uint64_t k_half_pi_q40 = 0x1921fb54443U;

/// Sine and cosine with 60 fraction bits, and signs.
struct WideSinCos {
  std::int64_t sin = 0;
  std::int64_t cos = 0;
};

/// 0 ≤ r ≤ π/4 with 60 fraction bits; errors below 2^-33.
constexpr WideSinCos sin_cos_first_octant(std::uint64_t r) {
  const std::uint64_t r32 = (r + (std::uint64_t{1} << 27)) >> 28;
  const std::uint64_t square = r32 * r32;  // r², 64 fraction bits
  const std::uint64_t z = square >> 32;
  // sin r = r − r³·(1/3! − r²·(1/5! − …)): the inner sums with 32 fraction bits.
  std::uint64_t s = inverse_factorial(9, 32) - multiply_q32(z, inverse_factorial(11, 32));
  s = inverse_factorial(7, 32) - multiply_q32(z, s);
  s = inverse_factorial(5, 32) - multiply_q32(z, s);
  s = inverse_factorial(3, 32) - multiply_q32(z, s);
  const std::uint64_t cube = multiply_q32(z, s) * r32;  // 64 fraction bits
  // cos r = 1 − r²/2 + r⁴·(1/4! − r²·(1/6! − …)).
  std::uint64_t c = inverse_factorial(10, 32) - multiply_q32(z, inverse_factorial(12, 32));
  c = inverse_factorial(8, 32) - multiply_q32(z, c);
  c = inverse_factorial(6, 32) - multiply_q32(z, c);
  c = inverse_factorial(4, 32) - multiply_q32(z, c);
  const std::uint64_t fourth = multiply_q32(z, z) * c;  // 64 fraction bits
  const std::uint64_t cos = (std::uint64_t{1} << 60) - (square >> 5) + (fourth >> 4);
  return {static_cast<std::int64_t>(r - (cube >> 4)), static_cast<std::int64_t>(cos)};
}

/// Of `angle` · 2^-33 radians, for all 64-bit values. (Payne and Hanek, Radian reduction for
/// trigonometric functions: multiply by the inverse turn and keep the fraction.)
constexpr WideSinCos sin_cos_q33(std::uint64_t angle) {
  // The product has 33 + 95 = 128 fraction bits: its low two words are the fraction of a turn.
  const UInt128 product =
      multiply_wide(angle, k_inverse_turn_low) + UInt128{angle * k_inverse_turn_high, 0};
  const std::uint64_t turns = product.high;
  const std::uint64_t quadrant = (turns + (std::uint64_t{1} << 61)) >> 62;
  const auto rest = static_cast<std::int64_t>(turns - (quadrant << 62));  // within ⅛ turn
  const WideSinCos octant = sin_cos_first_octant(multiply_high(magnitude(rest), k_turn_q60));
  const std::int64_t s = rest < 0 ? -octant.sin : octant.sin;
  switch (quadrant & 3) {
    case 0:
      return {s, octant.cos};
    case 1:
      return {octant.cos, -s};
    case 2:
      return {-s, -octant.cos};
    default:
      return {-octant.cos, s};
  }
}

constexpr Unit to_unit(std::int64_t q60) {
  return Unit::from_raw(static_cast<std::int32_t>(raw::round_shift(q60, 30)));
}

/// A rotation with 32 fraction bits: two more than a Quat, so that composing it with an orientation
/// rounds once at the end.
struct WideQuat {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t z = 0;
  std::int64_t w = 0;
};

constexpr Quat narrowed(const WideQuat& q) {
  const auto unit = [](std::int64_t q32) {
    return Unit::from_raw(static_cast<std::int32_t>(raw::round_shift(q32, 2)));
  };
  return {unit(q.x), unit(q.y), unit(q.z), unit(q.w)};
}

/// `half` is the sine and cosine of half the angle.
WideQuat rotation_about(const Vec3<Unit>& axis, const WideSinCos& half) {
  const std::int64_t sin = raw::round_shift(half.sin, 29);  // 31 fraction bits
  const auto component = [sin](Unit u) { return raw::round_shift(u.raw * sin, 29); };
  return {component(axis.x), component(axis.y), component(axis.z), raw::round_shift(half.cos, 28)};
}

// --- arc tangent

constexpr int k_arc_steps = 32;

/// atan(i/32) with 40 fraction bits, by Euler's series Σ 2^(2n)·n!²/(2n+1)! · x^(2n+1)/(1+x²)^(n+1)
/// (Chien-Lih, An elementary derivation of Euler's series for the arctangent function), computed
/// with 52.
constexpr std::uint64_t arc_tangent_entry(std::uint64_t i) {
  const std::uint64_t squares = k_arc_steps * k_arc_steps + i * i;
  std::uint64_t term = ((std::uint64_t{1} << 52) / squares) * k_arc_steps * i;
  std::uint64_t sum = 0;
  for (std::uint64_t n = 1; term != 0; ++n) {
    sum += term;
    const UInt128 next = multiply_wide(term, 2 * n * i * i);
    term = divide(next, (2 * n + 1) * squares).quotient;
  }
  return (sum + (std::uint64_t{1} << 11)) >> 12;
}

constexpr std::array<std::uint64_t, k_arc_steps + 1> make_arc_table() {
  std::array<std::uint64_t, k_arc_steps + 1> table{};
  for (std::uint64_t i = 0; i <= k_arc_steps; ++i)
    table[i] = arc_tangent_entry(i);
  return table;
}

constexpr auto k_arc_table = make_arc_table();

/// atan(a/b), 0 ≤ a ≤ b, b > 0, with 40 fraction bits and an error below 2^-38.
std::uint64_t arc_tangent(std::uint64_t a, std::uint64_t b) {
  const int shift = std::countl_zero(b);  // b to exactly 57 bits; bits lost weigh under 2^-56
  a = shift >= 7 ? a << (shift - 7) : a >> (7 - shift);
  b = shift >= 7 ? b << (shift - 7) : b >> (7 - shift);
  const std::uint64_t coarse = b >> 32;  // 25 bits
  const std::uint64_t i = (k_arc_steps * (a >> 32) + coarse / 2) / coarse;
  // tan(α − β) = (a/b − i/32) / (1 + a/b · i/32): at most about 1/64.
  const auto numerator = static_cast<std::int64_t>(k_arc_steps * a - i * b);
  const std::uint64_t denominator = k_arc_steps * b + i * a;
  const Int128 wide = Int128::from(numerator) << 40;
  const std::int64_t d = round_divide(wide, static_cast<std::int64_t>(denominator));
  // atan d = d − d·(d²/3 − d⁴/5), |d| ≤ 2^34; the bracket needs 20 significant bits.
  const std::int64_t square = ((d >> 6) * (d >> 6)) >> 28;  // 40 fraction bits
  const std::int64_t bend = square / 3 - ((square >> 8) * (square >> 8) >> 24) / 5;
  const std::int64_t cube = raw::round_shift(d * bend, 40);
  return k_arc_table[i] + static_cast<std::uint64_t>(d - cube);
}

/// The angle of (x, y) in [0, π] for y ≥ 0, with 40 fraction bits; 0 for (0, 0).
std::uint64_t upper_arc(std::uint64_t y, std::int64_t x) {
  const std::uint64_t ux = magnitude(x);
  if (ux == 0 && y == 0) return 0;
  const std::uint64_t angle = y <= ux ? arc_tangent(y, ux) : k_half_pi_q40 - arc_tangent(ux, y);
  return x < 0 ? 2 * k_half_pi_q40 - angle : angle;
}

Angle to_angle(std::uint64_t q40, bool negative) {
  const auto size = static_cast<std::int32_t>((q40 + (std::uint64_t{1} << 12)) >> 13);
  return Angle::from_raw(negative ? -size : size);
}

// --- rotation vectors

/// exp(θ/2) for |θ| ≤ ½. `square` is |θ|² with 64 fraction bits, which is (|θ|/2)² with 66.
WideQuat small_rotation(const RotationVector& theta, std::uint64_t square) {
  const std::uint64_t z = square >> 34;  // h² = (θ/2)² ≤ 1/16, 32 fraction bits
  // sin(h)/h = 1 − h²/3! + h⁴/5! − h⁶/7!
  std::uint64_t s = inverse_factorial(5, 32) - multiply_q32(z, inverse_factorial(7, 32));
  s = inverse_factorial(3, 32) - multiply_q32(z, s);
  const auto sinc = static_cast<std::int64_t>((std::uint64_t{1} << 31) - (multiply_q32(z, s) >> 1));
  // cos(h) = 1 − h²/2 + h⁴·(1/4! − h²/6! + h⁴/8!)
  std::uint64_t c = inverse_factorial(6, 32) - multiply_q32(z, inverse_factorial(8, 32));
  c = inverse_factorial(4, 32) - multiply_q32(z, c);
  const std::uint64_t fourth = multiply_q32(z, z) * c;  // 64 fraction bits
  const std::uint64_t cos = (std::uint64_t{1} << 60) - (square >> 7) + (fourth >> 4);
  const auto component = [sinc](RotationComponent t) {  // 32 + 31 fraction bits, halved
    return raw::round_shift(t.raw * sinc, 32);
  };
  return {component(theta.x), component(theta.y), component(theta.z),
          raw::round_shift(static_cast<std::int64_t>(cos), 28)};
}

WideQuat wide_rotation(const RotationVector& theta) {
  const std::uint64_t sizes =
      magnitude(theta.x.raw) | magnitude(theta.y.raw) | magnitude(theta.z.raw);
  if ((sizes >> 31) == 0) {
    const auto squared = [](std::int64_t t) { return static_cast<std::uint64_t>(t * t); };
    const std::uint64_t square = squared(theta.x.raw) + squared(theta.y.raw) + squared(theta.z.raw);
    if (square <= std::uint64_t{1} << 62) return small_rotation(theta, square);
  }
  const Direction split = direction(theta);
  return rotation_about(split.unit, sin_cos_q33(split.length));  // 33 bits: half the angle
}

/// r · q, exact. |r|, |q| are near 1, so that every partial sum of four products is below
/// 2^62 · (1 + 2^-19) in size when the two have 62 fraction bits together (Cauchy and Schwarz).
WideQuat product(const WideQuat& r, const WideQuat& q) {
  return {
      r.w * q.x + r.x * q.w + r.y * q.z - r.z * q.y, r.w * q.y - r.x * q.z + r.y * q.w + r.z * q.x,
      r.w * q.z + r.x * q.y - r.y * q.x + r.z * q.w, r.w * q.w - r.x * q.x - r.y * q.y - r.z * q.z};
}

/// q · (1 + correction · 2^-51) from 62 fraction bits, rounded once.
Quat corrected(const WideQuat& q, std::int64_t correction) {
  const auto unit = [correction](std::int64_t x) {
    const std::int64_t scaled = x + raw::round_shift(raw::round_shift(x, 32) * correction, 19);
    return Unit::from_raw(static_cast<std::int32_t>(raw::round_shift(scaled, 32)));
  };
  return {unit(q.x), unit(q.y), unit(q.z), unit(q.w)};
}

WideQuat rounded(const WideQuat& q, int shift) {
  return {raw::round_shift(q.x, shift), raw::round_shift(q.y, shift), raw::round_shift(q.z, shift),
          raw::round_shift(q.w, shift)};
}

WideQuat widened(const Quat& q) {
  return {q.x.raw, q.y.raw, q.z.raw, q.w.raw};
}

// |q|² of 31 fraction bits, rounded down to 60.
std::uint64_t norm_squared(const WideQuat& q) {
  const auto square = [](std::int64_t c) { return static_cast<std::uint64_t>(c * c); };
  return (square(q.x) + square(q.y) + square(q.z) + square(q.w)) >> 2;
}

}  // namespace

SinCos sin_cos(Angle x) {
  const WideSinCos wide = sin_cos_q33(magnitude(x.raw) << 6);
  const Unit sin = to_unit(wide.sin);
  return {x.raw < 0 ? -sin : sin, to_unit(wide.cos)};
}

FineSinCos half_sin_cos(RotationComponent angle) {
  const WideSinCos half = sin_cos_q33(magnitude(angle.raw));
  const std::int64_t sin = raw::round_shift(half.sin, 29);
  return {angle.raw < 0 ? -sin : sin, raw::round_shift(half.cos, 29)};
}

Angle atan2_raw(std::int64_t y, std::int64_t x) {
  return to_angle(upper_arc(magnitude(y), x), y < 0);
}

RotationComponent fine_arc(std::uint64_t y, std::int64_t x) {
  return RotationComponent::from_raw(static_cast<std::int64_t>((upper_arc(y, x) + 128) >> 8));
}

Angle asin(Unit x) {
  constexpr std::int64_t one = std::int64_t{1} << 30;
  const std::int64_t sine = x.raw > one ? one : x.raw < -one ? -one : x.raw;
  const auto cosine = isqrt_rounded(static_cast<std::uint64_t>(one * one - sine * sine));
  return atan2_raw(sine, static_cast<std::int64_t>(cosine));
}

Angle acos(Unit x) {
  constexpr std::int64_t one = std::int64_t{1} << 30;
  const std::int64_t cosine = x.raw > one ? one : x.raw < -one ? -one : x.raw;
  const auto sine = isqrt_rounded(static_cast<std::uint64_t>(one * one - cosine * cosine));
  return atan2_raw(static_cast<std::int64_t>(sine), cosine);
}

Quat rotation_from_vector(const RotationVector& theta) {
  return narrowed(wide_rotation(theta));
}

Quat from_axis_angle(const Vec3<Unit>& axis, Angle angle) {
  WideSinCos half = sin_cos_q33(magnitude(angle.raw) << 5);
  if (angle.raw < 0) half.sin = -half.sin;
  return narrowed(rotation_about(axis, half));
}

Quat integrate(const Quat& q, const RotationVector& theta) {
  if (theta == RotationVector{}) return q;
  const Quat start = is_near_unit(norm_squared(q)) ? q : normalized(q);
  return corrected(product(wide_rotation(theta), widened(start)),
                   unit_correction(norm_squared(start)));
}

Quat integrate(const Quat& q, const RotationVector& theta, const FineQuat& turn) {
  if (turn == FineQuat{}) return integrate(q, theta);
  const Quat start = is_near_unit(norm_squared(q)) ? q : normalized(q);
  const WideQuat own{turn.v[0], turn.v[1], turn.v[2], turn.w};
  const WideQuat turned = rounded(product(widened(start), own), 30);  // 31 fraction bits
  return corrected(product(rounded(wide_rotation(theta), 1), turned),
                   unit_correction(norm_squared(start)) + unit_correction(norm_squared(own)));
}

}  // namespace lockstone
