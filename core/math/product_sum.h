// Sums of 64-bit products, exact until they are rounded once.
#pragma once

#include <cstdint>

#include "core/math/int128.h"

namespace lockstone {

/// A sum is clamped to this bound when it is rounded, so that the difference of two does not
/// overflow.
inline constexpr std::int64_t k_product_bound = std::int64_t{1} << 61;

/// The caller guarantees that every partial sum is below 2^126.
class ProductSum {
 public:
  constexpr void add(std::int64_t a, std::int64_t b) { sum_ = sum_ + product(a, b); }
  constexpr void subtract(std::int64_t a, std::int64_t b) { sum_ = sum_ - product(a, b); }

  /// sum · 2^-shift to nearest, ties away from zero, within ±k_product_bound. 1 ≤ shift ≤ 125.
  [[nodiscard]] constexpr std::int64_t rounded(int shift) const;

 private:
#if defined(__SIZEOF_INT128__)
  __extension__ typedef __int128 Word;
  __extension__ typedef unsigned __int128 Bits;
  [[nodiscard]] static constexpr Word product(std::int64_t a, std::int64_t b) {
    return Word{a} * b;
  }
  /// The reference definition.
  [[nodiscard, gnu::noinline]] static constexpr std::int64_t rounded_any(Word sum, int shift) {
    const Word half = Word{1} << (shift - 1);
    const Word result = (sum + half + (sum >> 127)) >> shift;
    if (result > k_product_bound) return k_product_bound;
    if (result < -k_product_bound) return -k_product_bound;
    return static_cast<std::int64_t>(result);
  }
#else
  using Word = Int128;
  [[nodiscard]] static constexpr Word product(std::int64_t a, std::int64_t b) {
    return multiply_wide(a, b);
  }
#endif
  Word sum_{};
};

#if defined(__SIZEOF_INT128__)
// A sum that fits after a shift within a word, or beyond one, needs a few instructions.
constexpr std::int64_t ProductSum::rounded(int shift) const {
  LKS_ASSERT(shift >= 1 && shift <= 125);
  const auto bits = static_cast<Bits>(sum_);
  const auto high = static_cast<std::uint64_t>(bits >> 64);
  if (shift >= 3 && shift < 64) {
    const bool fits = high + (std::uint64_t{1} << (shift - 3)) < std::uint64_t{1} << (shift - 2);
    if (fits) [[likely]] {
      const std::uint64_t half = (std::uint64_t{1} << (shift - 1)) - (high >> 63);
      const std::uint64_t low = static_cast<std::uint64_t>(bits) + half;
      const std::uint64_t carry = low < half ? 1 : 0;
      return static_cast<std::int64_t>((Bits{high + carry} << 64 | low) >> shift);
    }
  } else if (shift >= 67) {
    const std::uint64_t borrow = static_cast<std::uint64_t>(bits) == 0 ? high >> 63 : 0;
    const std::uint64_t up = high + (std::uint64_t{1} << (shift - 65)) - borrow;
    return static_cast<std::int64_t>(up) >> (shift - 64);
  }
  return rounded_any(sum_, shift);
}
#else
constexpr std::int64_t ProductSum::rounded(int shift) const {
  LKS_ASSERT(shift >= 1 && shift <= 125);
  const std::int64_t result = saturate_to_int64(round_shift(sum_, shift));
  if (result > k_product_bound) return k_product_bound;
  return result < -k_product_bound ? -k_product_bound : result;
}
#endif

/// a · b · 2^-shift, as above.
[[nodiscard]] constexpr std::int64_t product_rounded(std::int64_t a, std::int64_t b, int shift) {
  ProductSum sum;
  sum.add(a, b);
  return sum.rounded(shift);
}

}  // namespace lockstone
