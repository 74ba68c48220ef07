// The meaning of every lane operation, one lane at a time: the scalar twin of lanes_inl.h.
//
// A lane is a 64-bit word, held here as int64. As an operand of a product it counts by its lower
// half alone, a signed 32-bit number; the upper half may hold anything ("dirty"), often a second
// operand. Sums wrap, so every operation is defined for every input.
#pragma once

#include <cstdint>

namespace lockstone::lanes::scalar {

using Lane = std::int64_t;

[[nodiscard]] constexpr std::uint64_t bits(Lane x) {
  return static_cast<std::uint64_t>(x);
}

[[nodiscard]] constexpr Lane add(Lane a, Lane b) {
  return static_cast<Lane>(bits(a) + bits(b));
}
[[nodiscard]] constexpr Lane subtract(Lane a, Lane b) {
  return static_cast<Lane>(bits(a) - bits(b));
}

/// The operand in the lower half.
[[nodiscard]] constexpr std::int32_t low(Lane x) {
  return static_cast<std::int32_t>(x);
}

/// The operand in the upper half.
[[nodiscard]] constexpr std::int32_t high(Lane x) {
  return static_cast<std::int32_t>(x >> 32);
}

/// Two operands in one word: the lower halves of both.
[[nodiscard]] constexpr Lane pack(std::int64_t low_half, std::int64_t high_half) {
  return static_cast<Lane>((bits(low_half) & 0xffffffffU) | (bits(high_half) << 32));
}

/// `low_half` with the upper half of `other`.
[[nodiscard]] constexpr Lane with_upper_of(Lane low_half, Lane other) {
  return pack(low_half, high(other));
}

/// The lower half, and the upper one, as numbers without sign.
[[nodiscard]] constexpr Lane low_part(Lane x) {
  return static_cast<Lane>(bits(x) & 0xffffffffU);
}
[[nodiscard]] constexpr Lane high_part(Lane x) {
  return static_cast<Lane>(bits(x) >> 32);
}

/// The lowest eight bits.
[[nodiscard]] constexpr Lane low_byte(Lane x) {
  return static_cast<Lane>(bits(x) & 0xffU);
}

/// x · 2^shift, 0 ≤ shift ≤ 63; bits beyond the word are lost.
[[nodiscard]] constexpr Lane shift_left(Lane x, int shift) {
  return static_cast<Lane>(bits(x) << shift);
}

/// The word moved down by 0 ≤ shift ≤ 63, with zeros above.
[[nodiscard]] constexpr Lane shift_right(Lane x, int shift) {
  return static_cast<Lane>(bits(x) >> shift);
}

/// 2^exponent, 0 ≤ exponent ≤ 63.
[[nodiscard]] constexpr Lane power_of_two(Lane exponent) {
  return static_cast<Lane>(std::uint64_t{1} << exponent);
}

/// The product of the lower halves, exact.
[[nodiscard]] constexpr Lane multiply(Lane a, Lane b) {
  return Lane{low(a)} * low(b);
}

[[nodiscard]] constexpr Lane multiply_add(Lane sum, Lane a, Lane b) {
  return add(sum, multiply(a, b));
}
[[nodiscard]] constexpr Lane multiply_subtract(Lane sum, Lane a, Lane b) {
  return subtract(sum, multiply(a, b));
}

/// x · 2^-shift to nearest, ties away from zero, in the lower half; the upper half is dirty, for
/// the shift is a logical one: AVX2 and older have no arithmetic one. 1 ≤ shift ≤ 32.
[[nodiscard]] constexpr Lane round_shift_low(Lane x, int shift) {
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  return static_cast<Lane>((bits(x) + half - (bits(x) >> 63)) >> shift);
}

/// The same for 32 < shift < 63, in the lower half; the upper half is dirty.
[[nodiscard]] constexpr Lane round_shift_far(Lane x, int shift) {
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  return static_cast<Lane>(bits(x) + half - (bits(x) >> 63)) >> shift;
}

/// x · 2^-shift to nearest, ties away from zero: the whole word. 1 ≤ shift ≤ 62 and
/// x < 2^63 − 2^(shift − 1).
[[nodiscard]] constexpr Lane round_shift(Lane x, int shift) {
  const std::uint64_t half = std::uint64_t{1} << (shift - 1);
  return static_cast<Lane>(bits(x) + half - (bits(x) >> 63)) >> shift;
}

/// The same as round_shift_low of a number without sign.
[[nodiscard]] constexpr Lane round_shift_unsigned(Lane x, int shift) {
  return static_cast<Lane>((bits(x) + (std::uint64_t{1} << (shift - 1))) >> shift);
}

/// max(0, x · 2^-shift to nearest), at most `bound` ≥ 0. x < 2^(32 + shift) − 2^(shift − 1).
[[nodiscard]] constexpr Lane round_shift_positive(Lane x, int shift, std::int32_t bound) {
  if (x < 0) return 0;
  const auto rounded = static_cast<std::uint32_t>(round_shift_unsigned(x, shift));
  const auto most = static_cast<std::uint32_t>(bound);
  return Lane{rounded < most ? rounded : most};
}

/// x to the nearest multiple of 2^bits_dropped, ties away from zero. 1 ≤ bits_dropped ≤ 62.
[[nodiscard]] constexpr Lane round_to_multiple(Lane x, int bits_dropped) {
  const std::uint64_t half = std::uint64_t{1} << (bits_dropped - 1);
  return static_cast<Lane>((bits(x) + half - (bits(x) >> 63)) & ~(2 * half - 1));
}

/// The lower half, as a number without sign, but no more than `bound`; the upper half alike but at
/// most 0.
[[nodiscard]] constexpr Lane at_most(Lane x, std::int32_t bound) {
  const auto half = static_cast<std::uint32_t>(x);
  const auto most = static_cast<std::uint32_t>(bound);
  return Lane{half < most ? half : most};
}

[[nodiscard]] constexpr Lane bit_and(Lane a, Lane b) {
  return a & b;
}
[[nodiscard]] constexpr Lane bit_or(Lane a, Lane b) {
  return a | b;
}
/// The bits of b that a lacks.
[[nodiscard]] constexpr Lane bit_and_not(Lane a, Lane b) {
  return ~a & b;
}
/// x, or −x − 1 where x < 0: as many bits as |x| has, or one fewer.
[[nodiscard]] constexpr Lane without_sign(Lane x) {
  return x < 0 ? ~x : x;
}

[[nodiscard]] constexpr Lane min(Lane a, Lane b) {
  return b < a ? b : a;
}
[[nodiscard]] constexpr Lane max(Lane a, Lane b) {
  return a < b ? b : a;
}
[[nodiscard]] constexpr Lane clamp(Lane x, Lane lowest, Lane highest) {
  return min(max(x, lowest), highest);
}

/// Clamps to the range of int32.
[[nodiscard]] constexpr Lane saturate(Lane x) {
  return clamp(x, -(Lane{1} << 31), (Lane{1} << 31) - 1);
}

/// a < b ? yes : no.
[[nodiscard]] constexpr Lane select_less(Lane a, Lane b, Lane yes, Lane no) {
  return a < b ? yes : no;
}
/// Whether a < b in any lane.
[[nodiscard]] constexpr bool any_less(Lane a, Lane b) {
  return a < b;
}
/// Bit i: a < b in lane i.
[[nodiscard]] constexpr std::uint32_t bits_of_less(Lane a, Lane b) {
  return a < b ? 1U : 0U;
}
/// a = b ? yes : no.
[[nodiscard]] constexpr Lane select_equal(Lane a, Lane b, Lane yes, Lane no) {
  return a == b ? yes : no;
}

}  // namespace lockstone::lanes::scalar
