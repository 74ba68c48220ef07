// 192-bit integers, as few operations as integrals over polyhedra need.
#pragma once

#include <cstdint>

#include "core/math/int128.h"

namespace lockstone {

/// Two's complement, high word first. Sums are modulo 2^192.
struct Int192 {
  std::uint64_t high = 0;
  std::uint64_t middle = 0;
  std::uint64_t low = 0;

  friend constexpr bool operator==(const Int192&, const Int192&) = default;

  [[nodiscard]] static constexpr Int192 from(const Int128& x) {
    return {x.negative() ? ~std::uint64_t{0} : 0, static_cast<std::uint64_t>(x.high), x.low};
  }
  [[nodiscard]] constexpr bool negative() const { return (high >> 63) != 0; }

  friend constexpr Int192 operator+(const Int192& a, const Int192& b) {
    const std::uint64_t sum = a.low + b.low;
    const UInt128 upper = UInt128{a.high, a.middle} + UInt128{b.high, b.middle} +
                          UInt128{0, sum < a.low ? std::uint64_t{1} : 0};
    return {upper.high, upper.low, sum};
  }
  friend constexpr Int192 operator-(const Int192& x) {
    return Int192{~x.high, ~x.middle, ~x.low} + Int192{0, 0, 1};
  }
};

/// a · b, exact.
[[nodiscard]] constexpr Int192 multiply(const Int128& a, std::int64_t b) {
  const UInt128 size = magnitude(a);
  const std::uint64_t factor = magnitude(b);
  const UInt128 lower = multiply_wide(size.low, factor);
  const UInt128 upper = multiply_wide(size.high, factor) + UInt128{0, lower.high};
  const Int192 product{upper.high, upper.low, lower.low};
  return a.negative() != (b < 0) ? -product : product;
}

/// x · 2^shift to nearest, ties away from zero. −63 ≤ shift ≤ 63; the result must be below 2^127.
[[nodiscard]] constexpr Int128 scaled(const Int192& x, int shift) {
  LKS_ASSERT(shift >= -63 && shift <= 63);
  Int192 size = x.negative() ? -x : x;
  UInt128 result{size.middle, size.low};
  if (shift < 0) {
    size = size + Int192{0, 0, std::uint64_t{1} << (-shift - 1)};
    const UInt128 lower = UInt128{size.middle, size.low} >> -shift;
    result = {lower.high | (size.high << (64 + shift)), lower.low};
    LKS_ASSERT((size.high >> -shift) == 0);
  } else {
    LKS_ASSERT(size.high == 0 && countl_zero(result) > shift);
    result = result << shift;
  }
  LKS_ASSERT((result.high >> 63) == 0);
  return Int128::from_bits(x.negative() ? UInt128{} - result : result);
}

}  // namespace lockstone
