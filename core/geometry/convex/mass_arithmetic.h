// The arithmetic of masses and moments that the shapes share.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include <lockstone/units.h>

#include "core/math/block_float.h"
#include "core/math/int128.h"

namespace lockstone::geometry {

/// π/3, 61 fraction bits.
constexpr std::uint64_t k_third_pi = 2414673152692374281U;

constexpr std::uint64_t square(std::uint64_t x) {
  return x * x;
}

constexpr std::uint64_t raw_of(Length x) {
  return static_cast<std::uint64_t>(x.raw);
}

/// a · b for a < 2^96.
constexpr UInt128 multiply(UInt128 a, std::uint32_t b) {
  const UInt128 low = multiply_wide(a.low, std::uint64_t{b});
  return {low.high + a.high * b, low.low};
}

constexpr Mass saturated_mass(UInt128 x) {
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (x.high != 0 || x.low > most) return Mass::max();
  return Mass::from_raw(static_cast<std::int64_t>(x.low));
}

/// volume · density · factor, where the volume (below 2^96) has 60 fraction bits and the factor has
/// `factor_bits`.
constexpr Mass mass_with_factor(UInt128 volume, Density density, std::uint64_t factor,
                                int factor_bits) {
  const UInt128 product = multiply(volume, static_cast<std::uint32_t>(density.raw));
  const int dropped = std::max(0, 64 - countl_zero(product));
  const UInt128 mass = multiply_wide((product >> dropped).low, factor);
  return saturated_mass(
      round_shift(mass, 60 + Density::frac_bits + factor_bits - Mass::frac_bits - dropped));
}

/// x · 2^exponent from its leading 64 bits.
constexpr BlockFloat from_wide(UInt128 x, int exponent) {
  const int zeros = countl_zero(x);
  return block_float((x << zeros).high, exponent + 64 - zeros);
}

/// volume · factor, likewise; the volume is not zero.
constexpr BlockFloat volume_with_factor(UInt128 volume, std::uint64_t factor, int factor_bits) {
  const int zeros = countl_zero(volume);
  return from_wide(multiply_wide((volume << zeros).high, factor),
                   64 - zeros - factor_bits - 3 * Length::frac_bits);
}

/// A moment with 30 fraction bits; at least one step, or a needle's about its own axis would
/// vanish.
constexpr Unit moment_of(std::uint64_t x) {
  return Unit::from_raw(static_cast<std::int32_t>(std::max(x, std::uint64_t{1})));
}

/// x / (divisor · 2^30), rounded, for x with 60 fraction bits.
constexpr Unit moment_share(std::uint64_t x, std::uint64_t divisor) {
  return moment_of(round_divide(UInt128{0, x}, divisor << 30));
}

/// A length with 50 fraction bits, brought to 20 bits upwards.
constexpr Length rounded_up(std::int64_t x) {
  constexpr int shift = Unit::frac_bits;
  constexpr std::int64_t below_one = (std::int64_t{1} << shift) - 1;
  return Length::from_raw(static_cast<std::int32_t>((x + below_one) >> shift));
}

/// √squares, rounded up.
[[nodiscard]] Length root_up(std::uint64_t squares);

}  // namespace lockstone::geometry
