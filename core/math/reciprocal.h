// Reciprocals of 64-bit numbers, without dividing.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/math/int128.h"

namespace lockstone {
namespace reciprocal_tables {

// 2^19 / d less a little, by d − 256.
inline constexpr std::array<std::uint16_t, 256> k_first = [] {
  std::array<std::uint16_t, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = static_cast<std::uint16_t>(((1 << 19) - 3 * (1 << 8)) / (i + 256));
  return table;
}();

}  // namespace reciprocal_tables

/// ⌊(2^128 − 1) / d⌋ − 2^64 for a divisor whose top bit is set. N. Möller, T. Granlund, "Improved
/// division by invariant integers", 2011, algorithm 3.
[[nodiscard]] constexpr std::uint64_t reciprocal_word(std::uint64_t d) {
  LKS_ASSERT(d >> 63 == 1);
  const std::uint64_t d40 = (d >> 24) + 1, d63 = (d >> 1) + (d & 1);
  const std::uint64_t v0 = reciprocal_tables::k_first[(d >> 55) - 256];
  const std::uint64_t v1 = (v0 << 11) - ((v0 * v0 * d40) >> 40) - 1;
  const std::uint64_t v2 = (v1 << 13) + ((v1 * ((std::uint64_t{1} << 60) - v1 * d40)) >> 47);
  const std::uint64_t error = ((v2 >> 1) & (0 - (d & 1))) - v2 * d63;
  const std::uint64_t v3 = (v2 << 31) + (multiply_high(v2, error) >> 1);
  const UInt128 product = multiply_wide(v3, d);
  const std::uint64_t carry = product.low + d < d ? 1 : 0;
  return v3 - (product.high + carry) - d;
}

/// 2^124 / d to nearest, ties up, for a divisor whose top bit is set: 2^60 … 2^61.
[[nodiscard]] constexpr std::uint64_t reciprocal_q124(std::uint64_t d) {
  const std::uint64_t quotient = (reciprocal_word(d) >> 4) | std::uint64_t{1} << 60;
  const std::uint64_t remainder = 0 - quotient * d;  // of 2^124; d itself where d is 2^63
  return quotient + (remainder >= d - remainder ? 1 : 0);
}

}  // namespace lockstone
