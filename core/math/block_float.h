// Block floats: inverse masses and inertias, which span more powers of two than one fixed format.
#pragma once

#include <bit>
#include <cstdint>

#include <lockstone/units.h>

#include "core/math/int128.h"

namespace lockstone {

/// mantissa · 2^exponent with a mantissa in [2^30, 2^31), or zero with exponent zero. Never
/// negative. The unit is the owner's.
struct BlockFloat {
  std::int32_t mantissa = 0;
  std::int8_t exponent = 0;

  friend constexpr bool operator==(BlockFloat, BlockFloat) = default;
};

/// value · 2^exponent as a block float, to nearest (ties up). The result's exponent must fit.
[[nodiscard]] constexpr BlockFloat block_float(std::uint64_t value, int exponent) {
  if (value == 0) return {};
  const int excess = 33 - std::countl_zero(value);  // bits beyond the 31 of a mantissa
  std::uint64_t mantissa = excess <= 0 ? value << -excess : value >> (excess - 1);
  if (excess > 0) mantissa = (mantissa + 1) >> 1;
  const int carry = static_cast<int>(mantissa >> 31);
  const int result = exponent + excess + carry;
  LKS_ASSERT(result >= -128 && result <= 127);
  return {static_cast<std::int32_t>(mantissa >> carry), static_cast<std::int8_t>(result)};
}

/// 1 / x in 1/kg, correctly rounded: relative error ≤ 2^-31. The inverse of zero is zero: that is
/// how an immovable body is written. Negative masses are a programmer's error.
[[nodiscard]] constexpr BlockFloat inverse_of(Mass x) {
  LKS_ASSERT(x.raw >= 0);
  if (x.raw <= 0) return {};
  const auto raw = static_cast<std::uint64_t>(x.raw);
  const int shift = std::countl_zero(raw);
  // 2^32 / raw = 2^94 / (raw · 2^shift) · 2^(shift − 62); the quotient is in (2^30, 2^31].
  const std::uint64_t quotient = round_divide(UInt128{std::uint64_t{1} << 30, 0}, raw << shift);
  return block_float(quotient, shift - 62);
}

/// raw · x · 2^shift to nearest, ties away from zero; a result that does not fit becomes the
/// nearest bound.
[[nodiscard]] constexpr std::int64_t scale_saturating(std::int64_t raw, BlockFloat x, int shift) {
  const Int128 product = multiply_wide(raw, std::int64_t{x.mantissa});  // below 2^94
  const int left = shift + x.exponent;
  if (left <= 0) return saturate_to_int64(round_shift(product, -left));
  if (product == Int128{}) return 0;
  // Below 2^32 in size times 2^95 still fits; anything larger shifted by 33 or more saturates.
  if (left <= 33) return saturate_to_int64(product << left);
  const bool fits = magnitude(product) < UInt128{0, std::uint64_t{1} << 33} && left < 64;
  if (fits) return saturate_to_int64(product << left);
  return saturate_to_int64(Int128{product.negative() ? std::numeric_limits<std::int64_t>::min()
                                                     : std::numeric_limits<std::int64_t>::max(),
                                  0});
}

/// a · x in the format To, rounded once and saturating. The units of `x` are the caller's promise.
template <class To, class D, class Rep, int F>
[[nodiscard]] constexpr To multiply_saturating(Fixed<D, Rep, F> a, BlockFloat x) {
  const std::int64_t scaled = scale_saturating(a.raw, x, To::frac_bits - F);
  return To::from_raw(raw::saturate<typename To::Representation>(scaled));
}

/// a < b.
[[nodiscard]] constexpr bool is_less(BlockFloat a, BlockFloat b) {
  if (a.mantissa == 0 || b.mantissa == 0) return a.mantissa < b.mantissa;
  return a.exponent != b.exponent ? a.exponent < b.exponent : a.mantissa < b.mantissa;
}

/// a / (a + b), correctly rounded. Equal inputs give exactly ½; a = 0 gives 0 (also when both are
/// zero); b = 0 gives exactly 1.
[[nodiscard]] constexpr Unit ratio(BlockFloat a, BlockFloat b) {
  constexpr Unit one = Unit::from_integer(1);
  if (a.mantissa == 0) return {};
  const int distance = a.exponent - b.exponent;
  // Beyond 32 binary places the smaller one is under half the last place of the result.
  if (b.mantissa == 0 || distance > 32) return one;
  if (distance < -32) return {};
  const std::uint64_t ua = static_cast<std::uint64_t>(a.mantissa) << (distance > 0 ? distance : 0);
  const std::uint64_t ub = static_cast<std::uint64_t>(b.mantissa) << (distance < 0 ? -distance : 0);
  const std::uint64_t share = round_divide(UInt128{ua >> 34, ua << 30}, ua + ub);
  return Unit::from_raw(static_cast<std::int32_t>(share));
}

/// a + b, to nearest.
[[nodiscard]] constexpr BlockFloat add(BlockFloat a, BlockFloat b) {
  if (a.mantissa == 0) return b;
  if (b.mantissa == 0) return a;
  const BlockFloat big = a.exponent >= b.exponent ? a : b;
  const BlockFloat small = a.exponent >= b.exponent ? b : a;
  const int distance = big.exponent - small.exponent;
  if (distance > 32) return big;
  const std::uint64_t sum = (static_cast<std::uint64_t>(big.mantissa) << distance) +
                            static_cast<std::uint64_t>(small.mantissa);
  return block_float(sum, small.exponent);
}

}  // namespace lockstone
