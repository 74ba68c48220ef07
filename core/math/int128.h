// 128-bit integers as two 64-bit words, for every target: 32-bit ARM and MSVC have no __int128.
//
// The functions of `portable` are the meaning. Where the compiler has a 128-bit type, the product
// and the quotient use it; tests compare the two.
#pragma once

#include <bit>
#include <compare>
#include <cstdint>
#include <limits>

#include <lockstone/assert.h>

namespace lockstone {

/// high · 2^64 + low. Sums, differences and shifts are modulo 2^128.
struct UInt128 {
  std::uint64_t high = 0;
  std::uint64_t low = 0;

  friend constexpr auto operator<=>(const UInt128&, const UInt128&) = default;

  friend constexpr UInt128 operator+(UInt128 a, UInt128 b) {
    const std::uint64_t sum = a.low + b.low;
    return {a.high + b.high + (sum < a.low ? 1 : 0), sum};
  }
  friend constexpr UInt128 operator-(UInt128 a, UInt128 b) {
    return {a.high - b.high - (a.low < b.low ? 1 : 0), a.low - b.low};
  }

  /// 0 ≤ shift; 128 and more give zero.
  friend constexpr UInt128 operator<<(UInt128 x, int shift) {
    LKS_ASSERT(shift >= 0);
    if (shift == 0) return x;
    if (shift >= 128) return {};
    if (shift >= 64) return {x.low << (shift - 64), 0};
    return {(x.high << shift) | (x.low >> (64 - shift)), x.low << shift};
  }
  friend constexpr UInt128 operator>>(UInt128 x, int shift) {
    LKS_ASSERT(shift >= 0);
    if (shift == 0) return x;
    if (shift >= 128) return {};
    if (shift >= 64) return {0, x.high >> (shift - 64)};
    return {x.high >> shift, (x.low >> shift) | (x.high << (64 - shift))};
  }
};

/// Two's complement, high · 2^64 + low. Sums and differences are modulo 2^128.
struct Int128 {
  std::int64_t high = 0;
  std::uint64_t low = 0;

  [[nodiscard]] static constexpr Int128 from(std::int64_t x) {
    return {x >> 63, static_cast<std::uint64_t>(x)};
  }
  [[nodiscard]] static constexpr Int128 from_bits(UInt128 x) {
    return {static_cast<std::int64_t>(x.high), x.low};
  }
  [[nodiscard]] constexpr UInt128 bits() const { return {static_cast<std::uint64_t>(high), low}; }
  [[nodiscard]] constexpr bool negative() const { return high < 0; }

  friend constexpr auto operator<=>(const Int128&, const Int128&) = default;
  friend constexpr Int128 operator+(Int128 a, Int128 b) { return from_bits(a.bits() + b.bits()); }
  friend constexpr Int128 operator-(Int128 a, Int128 b) { return from_bits(a.bits() - b.bits()); }
  friend constexpr Int128 operator-(Int128 a) { return from_bits(UInt128{} - a.bits()); }

  friend constexpr Int128 operator<<(Int128 x, int shift) { return from_bits(x.bits() << shift); }
  /// Arithmetic: rounds towards −∞.
  friend constexpr Int128 operator>>(Int128 x, int shift) {
    const UInt128 flip = x.negative() ? UInt128{~std::uint64_t{0}, ~std::uint64_t{0}} : UInt128{};
    const UInt128 shifted = UInt128{x.bits().high ^ flip.high, x.low ^ flip.low} >> shift;
    return from_bits({shifted.high ^ flip.high, shifted.low ^ flip.low});
  }
};

struct Quotient64 {
  std::uint64_t quotient = 0;
  std::uint64_t remainder = 0;
};

/// |x|, for every x.
[[nodiscard]] constexpr std::uint64_t magnitude(std::int64_t x) {
  return x < 0 ? 0 - static_cast<std::uint64_t>(x) : static_cast<std::uint64_t>(x);
}
[[nodiscard]] constexpr UInt128 magnitude(Int128 x) {
  return x.negative() ? UInt128{} - x.bits() : x.bits();
}

[[nodiscard]] constexpr int countl_zero(UInt128 x) {
  return x.high != 0 ? std::countl_zero(x.high) : 64 + std::countl_zero(x.low);
}

namespace portable {

[[nodiscard]] constexpr UInt128 multiply_wide(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t mask = 0xffffffffU;
  const std::uint64_t low = (a & mask) * (b & mask);
  const std::uint64_t cross_a = (a >> 32) * (b & mask);
  const std::uint64_t cross_b = (a & mask) * (b >> 32);
  const std::uint64_t middle = (low >> 32) + (cross_a & mask) + (cross_b & mask);
  const std::uint64_t high =
      (a >> 32) * (b >> 32) + (cross_a >> 32) + (cross_b >> 32) + (middle >> 32);
  return {high, (middle << 32) | (low & mask)};
}

/// One 32-bit digit of the quotient (remainder · 2^32 + next) / divisor; the divisor's top bit is
/// set and remainder < divisor. Leaves the new remainder.
[[nodiscard]] constexpr std::uint64_t divide_step(std::uint64_t& remainder, std::uint64_t next,
                                                  std::uint64_t divisor) {
  const std::uint64_t top = divisor >> 32;
  const std::uint64_t bottom = divisor & 0xffffffffU;
  std::uint64_t digit = remainder / top;
  std::uint64_t rest = remainder % top;
  // The estimate is at most two too high.
  while ((digit >> 32) != 0 || digit * bottom > ((rest << 32) | next)) {
    --digit;
    rest += top;
    if ((rest >> 32) != 0) break;
  }
  remainder = ((remainder << 32) | next) - digit * divisor;
  return digit;
}

/// Knuth, The Art of Computer Programming 2, 4.3.1, algorithm D, with 32-bit digits.
[[nodiscard]] constexpr Quotient64 divide(UInt128 numerator, std::uint64_t denominator) {
  const int shift = std::countl_zero(denominator);
  const UInt128 n = numerator << shift;
  const std::uint64_t d = denominator << shift;
  std::uint64_t remainder = n.high;
  const std::uint64_t high = divide_step(remainder, n.low >> 32, d);
  const std::uint64_t low = divide_step(remainder, n.low & 0xffffffffU, d);
  return {(high << 32) | low, remainder >> shift};
}

}  // namespace portable

#if defined(__SIZEOF_INT128__)
namespace native {

__extension__ typedef unsigned __int128 Word;

[[nodiscard]] constexpr UInt128 multiply_wide(std::uint64_t a, std::uint64_t b) {
  const Word product = Word{a} * b;
  return {static_cast<std::uint64_t>(product >> 64), static_cast<std::uint64_t>(product)};
}

[[nodiscard]] constexpr Quotient64 divide(UInt128 numerator, std::uint64_t denominator) {
  const Word n = (Word{numerator.high} << 64) | numerator.low;
  return {static_cast<std::uint64_t>(n / denominator), static_cast<std::uint64_t>(n % denominator)};
}

}  // namespace native
namespace words_128 = native;
#else
namespace words_128 = portable;
#endif

/// a · b, exact.
[[nodiscard]] constexpr UInt128 multiply_wide(std::uint64_t a, std::uint64_t b) {
  return words_128::multiply_wide(a, b);
}

/// a · b, exact.
[[nodiscard]] constexpr Int128 multiply_wide(std::int64_t a, std::int64_t b) {
  const UInt128 product = words_128::multiply_wide(magnitude(a), magnitude(b));
  return Int128::from_bits((a < 0) != (b < 0) ? UInt128{} - product : product);
}

/// ⌊a · b / 2^64⌋.
[[nodiscard]] constexpr std::uint64_t multiply_high(std::uint64_t a, std::uint64_t b) {
  return words_128::multiply_wide(a, b).high;
}

/// Quotient and remainder. numerator.high < denominator, so that the quotient fits.
[[nodiscard]] constexpr Quotient64 divide(UInt128 numerator, std::uint64_t denominator) {
  LKS_ASSERT(numerator.high < denominator);
  return words_128::divide(numerator, denominator);
}

/// numerator / denominator to nearest, ties up. The rounded quotient must fit in 64 bits.
[[nodiscard]] constexpr std::uint64_t round_divide(UInt128 numerator, std::uint64_t denominator) {
  const Quotient64 q = divide(numerator, denominator);
  return q.quotient + (q.remainder >= denominator - q.remainder ? 1 : 0);
}

/// numerator / denominator to nearest, ties away from zero. denominator > 0; |quotient| < 2^63.
[[nodiscard]] constexpr std::int64_t round_divide(Int128 numerator, std::int64_t denominator) {
  LKS_ASSERT(denominator > 0);
  const std::uint64_t size =
      round_divide(magnitude(numerator), static_cast<std::uint64_t>(denominator));
  LKS_ASSERT(size <= std::uint64_t{0x7fffffffffffffff});
  return static_cast<std::int64_t>(numerator.negative() ? 0 - size : size);
}

/// x · 2^-shift to nearest, ties up. 0 ≤ shift; x < 2^128 − 2^(shift−1) for shift ≤ 128.
[[nodiscard]] constexpr UInt128 round_shift(UInt128 x, int shift) {
  if (shift == 0) return x;
  if (shift > 128) return {};
  return (x + (UInt128{0, 1} << (shift - 1))) >> shift;
}

/// x · 2^-shift to nearest, ties away from zero, for every x. 0 ≤ shift.
[[nodiscard]] constexpr Int128 round_shift(Int128 x, int shift) {
  if (shift > 127) return {};  // |x| ≤ 2^127; the tie |x| = 2^127 at 128 is not needed
  const UInt128 size = round_shift(magnitude(x), shift);
  return Int128::from_bits(x.negative() ? UInt128{} - size : size);
}

/// The nearest int64.
[[nodiscard]] constexpr std::int64_t saturate_to_int64(Int128 x) {
  const auto low = static_cast<std::int64_t>(x.low);
  if (x.high == (low >> 63)) return low;
  return x.negative() ? std::numeric_limits<std::int64_t>::min()
                      : std::numeric_limits<std::int64_t>::max();
}

/// a · b / 2^shift, rounded to nearest, halves away from zero; saturates.
[[nodiscard]] constexpr std::int64_t saturated_product(std::int64_t a, std::int64_t b, int shift) {
  return saturate_to_int64(round_shift(multiply_wide(a, b), shift));
}

}  // namespace lockstone
