// Square roots, lengths and directions.
//
// One kernel serves all: the reciprocal square root of a 64-bit fraction, by a table of 192 entries
// and two Newton–Householder steps (Householder, The Numerical Treatment of a Single Nonlinear
// Equation, ch. 4). Every rounding in it goes down, so it never exceeds the true value, and a root
// is repaired to the exact floor by an upward step.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/math/int128.h"

namespace lockstone {
namespace roots_detail {

/// ⌊√n⌋ bit by bit: only for building the table.
[[nodiscard]] constexpr std::uint64_t slow_isqrt(std::uint64_t n) {
  std::uint64_t root = 0;
  for (int bit = 31; bit >= 0; --bit) {
    const std::uint64_t candidate = root | (std::uint64_t{1} << bit);
    if (candidate * candidate <= n) root = candidate;
  }
  return root;
}

/// Entry i is ⌊2^15 / √((i + 64.5) / 256)⌋ = ⌊√(2^39 / (2i + 129))⌋, the middle of its interval.
[[nodiscard]] constexpr std::array<std::uint16_t, 192> make_table() {
  std::array<std::uint16_t, 192> table{};
  for (std::uint64_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<std::uint16_t>(slow_isqrt((std::uint64_t{1} << 39) / (2 * i + 129)));
  }
  return table;
}

inline constexpr std::array<std::uint16_t, 192> k_start = make_table();

}  // namespace roots_detail

/// 2^62 / √(s · 2^-64) for s ≥ 2^62: from 2^62 to 2^63. At most the true value, and below it by
/// less than 2^-43 of it.
[[nodiscard]] constexpr std::uint64_t reciprocal_sqrt(std::uint64_t s) {
  LKS_ASSERT(s >= std::uint64_t{1} << 62);
  constexpr std::int64_t one = std::int64_t{1} << 62;
  // y ← y · (1 + e/2), e = 1 − s·y²; y has 15 fraction bits, then 31; e has 62.
  const std::int64_t y0 = roots_detail::k_start[(s >> 56) - 64];
  const std::int64_t s_above = static_cast<std::int64_t>(s >> 32) + 1;  // so that e errs down
  const std::int64_t e0 = one - y0 * y0 * s_above;
  const auto y1 = static_cast<std::uint64_t>((y0 << 16) + ((y0 * (e0 >> 14)) >> 33));
  // y ← y · (1 + e/2 + 3e²/8); now 0 ≤ e < 2^48 because the step before undershoots. The product is
  // rounded up, so that e errs down.
  const std::uint64_t product = multiply_high(s, y1 * y1);
  const std::uint64_t e1 =
      product < static_cast<std::uint64_t>(one) ? static_cast<std::uint64_t>(one) - product - 1 : 0;
  const std::uint64_t square = ((e1 >> 16) * (e1 >> 16)) >> 32;  // 60 fraction bits
  const std::uint64_t factor = (e1 >> 1) + ((3 * square) >> 1);
  return (y1 << 31) + ((y1 * (factor >> 16)) >> 15);
}

/// ⌊√n⌋, exact.
[[nodiscard]] constexpr std::uint32_t isqrt(std::uint64_t n) {
  if (n == 0) return 0;
  const int shift = std::countl_zero(n) & ~1;
  const std::uint64_t s = n << shift;
  std::uint64_t root = multiply_high(s, reciprocal_sqrt(s)) >> (30 + shift / 2);
  if (n - root * root > 2 * root) ++root;
  return static_cast<std::uint32_t>(root);
}

/// √n to nearest (there are no ties); at most 2^32.
[[nodiscard]] constexpr std::uint64_t isqrt_rounded(std::uint64_t n) {
  const std::uint64_t root = isqrt(n);
  return root + (n - root * root > root ? 1 : 0);
}

/// ⌊√n⌋, exact.
[[nodiscard]] constexpr std::uint64_t isqrt128(UInt128 n) {
  if (n.high == 0) return isqrt(n.low);
  const int shift = std::countl_zero(n.high) & ~1;
  const UInt128 scaled = n << shift;
  const std::uint64_t reciprocal = reciprocal_sqrt(scaled.high);
  std::uint64_t root = multiply_high(scaled.high, reciprocal) << 2;  // low by less than 2^22
  const UInt128 rest = scaled - multiply_wide(root, root);
  root += multiply_high((rest >> 24).low, reciprocal) >> 39;  // rest / (2·√scaled)
  while (scaled - multiply_wide(root, root) > UInt128{root >> 63, root << 1})
    ++root;
  return root >> (shift / 2);
}

/// √n to nearest; n < 2^128 − 2^64.
[[nodiscard]] constexpr std::uint64_t isqrt128_rounded(UInt128 n) {
  const std::uint64_t root = isqrt128(n);
  return root + (n - multiply_wide(root, root) > UInt128{0, root} ? 1 : 0);
}

/// √(x² + y² + z²) to nearest, for all inputs.
[[nodiscard]] std::uint64_t norm(std::int64_t x, std::int64_t y, std::int64_t z);

/// At least √(x² + y² + z²), and at most a seventh more, plus 2; components within ±2^57. It is
/// linear between (1, 0, 0), (1, 1, 0) and (1, 1, 1), where it is not below the norm, and a norm is
/// convex.
[[nodiscard]] constexpr std::int64_t norm_bound(std::int64_t x, std::int64_t y, std::int64_t z) {
  const std::int64_t a = x < 0 ? -x : x, b = y < 0 ? -y : y, c = z < 0 ? -z : z;
  const std::int64_t most = std::max({a, b, c}), least = std::min({a, b, c});
  const std::int64_t middle = a + b + c - most - least;
  constexpr std::int64_t k_middle = 27, k_least = 21;  // above √2 − 1 and √3 − √2, in 64 parts
  return most + ((k_middle * middle + k_least * least) >> 6) + 1;
}

/// x² + y² + z² of 32-bit raws, exact.
template <class D, int F>
[[nodiscard]] constexpr std::uint64_t norm_squared(const Vec3<Fixed<D, std::int32_t, F>>& v) {
  const auto square = [](std::int64_t c) { return static_cast<std::uint64_t>(c * c); };
  return square(v.x.raw) + square(v.y.raw) + square(v.z.raw);
}

/// |q|², 60 fraction bits, exact but for four components of −2, which give 2^64 − 1.
[[nodiscard]] constexpr std::uint64_t norm_squared(const Quat& q) {
  const auto square = [](std::int64_t c) { return static_cast<std::uint64_t>(c * c); };
  const std::uint64_t sum = square(q.x.raw) + square(q.y.raw) + square(q.z.raw) + square(q.w.raw);
  return sum == 0 && q.w.raw != 0 ? ~std::uint64_t{0} : sum;
}

/// Whether |q|² differs from 1 by at most 2^-20: then one first-order step normalises.
[[nodiscard]] constexpr bool is_near_unit(std::uint64_t norm_squared) {
  constexpr std::uint64_t one = std::uint64_t{1} << 60;
  constexpr std::uint64_t tolerance = std::uint64_t{1} << 40;
  return norm_squared - (one - tolerance) <= 2 * tolerance;
}

/// 1/|q| = 1 + correction · 2^-51 for |q| near 1, in error by less than 2^-41; |correction| ≤ 2^30.
[[nodiscard]] constexpr std::int64_t unit_correction(std::uint64_t norm_squared) {
  constexpr std::int64_t one = std::int64_t{1} << 60;
  return raw::round_shift(one - static_cast<std::int64_t>(norm_squared), 10);
}

/// |v| to nearest; a length beyond the format (components beyond 1182 m) becomes its maximum.
template <class D, int F>
[[nodiscard]] constexpr Fixed<D, std::int32_t, F> length(const Vec3<Fixed<D, std::int32_t, F>>& v) {
  const auto root = static_cast<std::int64_t>(isqrt_rounded(norm_squared(v)));
  return Fixed<D, std::int32_t, F>::from_raw(raw::saturate<std::int32_t>(root));
}

/// A vector split in two. `length` is in the raw unit of the vector that was split.
struct Direction {
  Vec3<Unit> unit;
  std::uint64_t length = 0;
};

/// The unit vector along a raw vector of any scale; each component errs by less than 0.51 · 2^-30.
/// Zero gives zero. Mirroring or permuting the axes mirrors or permutes the result exactly, and
/// 2·v gives the same as v wherever both fit in 31 bits.
[[nodiscard]] Vec3<Unit> direction_of(std::int64_t x, std::int64_t y, std::int64_t z);

/// The same for the unit quaternion along a raw one; zero gives the identity.
[[nodiscard]] Quat direction_of(std::int64_t x, std::int64_t y, std::int64_t z, std::int64_t w);

/// `direction_of` and the rounded length `norm`, in one.
[[nodiscard]] Direction direction(std::int64_t x, std::int64_t y, std::int64_t z);

template <class D, class Rep, int F>
[[nodiscard]] Direction direction(const Vec3<Fixed<D, Rep, F>>& v) {
  return direction(v.x.raw, v.y.raw, v.z.raw);
}

template <class D, class Rep, int F>
[[nodiscard]] Vec3<Unit> direction_of(const Vec3<Fixed<D, Rep, F>>& v) {
  return direction_of(v.x.raw, v.y.raw, v.z.raw);
}

}  // namespace lockstone
