// Real numbers in integers, with 63 significant bits: for sums of products of lengths of different
// orders, none of which may lose its digits beside the others. For shapes and assets, not for
// ticks.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include <lockstone/assert.h>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {

/// mantissa · 2^exponent with a mantissa in ±[2^62, 2^63), or zero. Products, quotients and roots
/// err by at most 2^-62 of themselves, sums by 2^-61 of the greater operand.
struct SoftReal {
  std::int64_t mantissa = 0;
  int exponent = 0;

  [[nodiscard]] static constexpr SoftReal of(std::int64_t value, int exponent = 0) {
    if (value == 0) return {};
    const int zeros = std::countl_zero(magnitude(value));
    if (zeros == 0) return {std::int64_t{-1} << 62, exponent + 1};  // −2^63
    return {value * (std::int64_t{1} << (zeros - 1)), exponent - (zeros - 1)};
  }

  friend constexpr SoftReal operator-(SoftReal a) { return {-a.mantissa, a.exponent}; }

  friend constexpr SoftReal operator+(SoftReal a, SoftReal b) {
    if (a.mantissa == 0) return b;
    if (b.mantissa == 0) return a;
    if (a.exponent < b.exponent) return b + a;
    const int fall = a.exponent - b.exponent;
    if (fall > 60) return a;
    return of((a.mantissa >> 1) + raw::round_shift_any(b.mantissa, fall + 1), a.exponent + 1);
  }
  friend constexpr SoftReal operator-(SoftReal a, SoftReal b) { return a + -b; }

  friend constexpr SoftReal operator*(SoftReal a, SoftReal b) {
    const Int128 product = multiply_wide(a.mantissa, b.mantissa);  // below 2^126
    return of(static_cast<std::int64_t>(round_shift(product, 63).low),
              a.exponent + b.exponent + 63);
  }
  friend constexpr SoftReal operator*(std::int64_t a, SoftReal b) { return of(a) * b; }

  /// b is not zero.
  friend constexpr SoftReal operator/(SoftReal a, SoftReal b) {
    LKS_ASSERT(b.mantissa != 0);
    const UInt128 numerator = UInt128{0, magnitude(a.mantissa)} << 62;
    const std::uint64_t quotient = round_divide(numerator, magnitude(b.mantissa));  // below 2^63
    const auto size = static_cast<std::int64_t>(quotient);
    const bool negative = (a.mantissa < 0) != (b.mantissa < 0);
    return of(negative ? -size : size, a.exponent - b.exponent - 62);
  }

  SoftReal& operator+=(SoftReal b) { return *this = *this + b; }
};

/// √x for x ≥ 0.
[[nodiscard]] constexpr SoftReal root_of(SoftReal x) {
  LKS_ASSERT(x.mantissa >= 0);
  const int odd = x.exponent & 1;
  const UInt128 square = UInt128{0, static_cast<std::uint64_t>(x.mantissa)} << (62 + odd);
  const auto root = static_cast<std::int64_t>(isqrt128_rounded(square));  // below 2^63
  return SoftReal::of(root, (x.exponent - odd - 62) / 2);
}

/// The whole number nearest to x · 2^bits, saturating.
[[nodiscard]] constexpr std::int64_t fixed_point(SoftReal x, int bits) {
  const int shift = x.exponent + bits;
  if (shift < 0) return saturate_to_int64(round_shift(Int128::from(x.mantissa), -shift));
  return saturate_to_int64(Int128::from(x.mantissa) << std::min(shift, 64));
}

}  // namespace lockstone
