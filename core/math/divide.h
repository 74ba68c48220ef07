// Quotients and reciprocals, correctly rounded: ⌊a / b⌉ in any format, ties away from zero.
#pragma once

#include <concepts>
#include <cstdint>
#include <limits>

#include <lockstone/units.h>

#include "core/math/int128.h"

namespace lockstone {

template <class A, class B>
using DimensionQuotient =
    Dimension<A::metres - B::metres, A::kilograms - B::kilograms, A::seconds - B::seconds>;

/// ⌊a · 2^shift / b⌉ for −63 ≤ shift ≤ 63; a result that does not fit becomes the nearest bound. b
/// = 0 gives the bound of a's sign, and 0 for a = 0.
[[nodiscard]] constexpr std::int64_t divide_raw_saturating(std::int64_t a, std::int64_t b,
                                                           int shift) {
  LKS_ASSERT(shift >= -63 && shift <= 63);
  if (a == 0) return 0;
  const bool negative = (a < 0) != (b < 0);
  const std::int64_t bound = negative ? std::numeric_limits<std::int64_t>::min()
                                      : std::numeric_limits<std::int64_t>::max();
  const UInt128 numerator = UInt128{0, magnitude(a)} << (shift > 0 ? shift : 0);
  const UInt128 denominator = UInt128{0, magnitude(b)} << (shift < 0 ? -shift : 0);
  if (denominator.high != 0) {  // |a| ≤ 2^63 and the denominator is at least 2^64
    const bool tie = numerator + numerator == denominator;
    return !tie ? 0 : negative ? -1 : 1;
  }
  if (numerator.high >= denominator.low) return bound;  // and b = 0
  const Quotient64 q = divide(numerator, denominator.low);
  const bool up = q.remainder >= denominator.low - q.remainder;
  if (q.quotient > std::uint64_t{0x7fffffffffffffff} - (up ? 1 : 0)) return bound;
  const auto size = static_cast<std::int64_t>(q.quotient + (up ? 1 : 0));
  return negative ? -size : size;
}

/// a / b to nearest in the format To; the nearest bound of To when it does not fit. b = 0 gives the
/// bound of a's sign, and 0 for a = 0.
template <class To, class D1, class R1, int F1, class D2, class R2, int F2>
requires(std::same_as<typename To::Unit, DimensionQuotient<D1, D2>>) [[nodiscard]] constexpr To
    divide_saturating(Fixed<D1, R1, F1> a, Fixed<D2, R2, F2> b) {
  constexpr int shift = To::frac_bits + F2 - F1;
  static_assert(shift >= -63 && shift <= 63);
  const std::int64_t quotient = divide_raw_saturating(a.raw, b.raw, shift);
  return To::from_raw(raw::saturate<typename To::Representation>(quotient));
}

/// As `divide_saturating`; b ≠ 0, and the result must be within the bounds of To.
template <class To, class D1, class R1, int F1, class D2, class R2, int F2>
requires(std::same_as<typename To::Unit, DimensionQuotient<D1, D2>>) [[nodiscard]] constexpr To
    divide(Fixed<D1, R1, F1> a, Fixed<D2, R2, F2> b) {
  LKS_ASSERT(b.raw != 0);
  const To quotient = divide_saturating<To>(a, b);
  LKS_ASSERT(quotient.raw != To::max().raw && quotient.raw != To::min().raw);
  return quotient;
}

/// 1 / x to nearest, the nearest bound of To when it does not fit; x = 0 gives the upper bound.
template <class To, class D, class R, int F>
[[nodiscard]] constexpr To reciprocal_saturating(Fixed<D, R, F> x) {
  return divide_saturating<To>(Fixed<Dimension<0, 0, 0>, std::int32_t, 0>::from_raw(1), x);
}

/// As `reciprocal_saturating`; x ≠ 0, and the result must be within the bounds of To.
template <class To, class D, class R, int F>
[[nodiscard]] constexpr To reciprocal(Fixed<D, R, F> x) {
  return divide<To>(Fixed<Dimension<0, 0, 0>, std::int32_t, 0>::from_raw(1), x);
}

}  // namespace lockstone
