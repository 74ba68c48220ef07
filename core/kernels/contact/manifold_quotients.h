// Divisions and roots that preparation does lane by lane.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lockstone/fixed.h>

#include "core/math/roots.h"

namespace lockstone::lanes {

/// ⌊2^exponent / divisor⌋, at most `most`, and `most` for a divisor ≤ 0. 0 ≤ exponent ≤ 62.
[[nodiscard]] inline std::int64_t bounded_quotient(int exponent, std::int64_t divisor,
                                                   std::int64_t most) {
  if (divisor <= 0) return most;
  const auto quotient = static_cast<std::int64_t>((std::uint64_t{1} << exponent) /
                                                  static_cast<std::uint64_t>(divisor));
  return quotient < most ? quotient : most;
}

/// 1/(ρ²·K) in Q24, at most 2^31 − 1, for K in Q(shift) and ρ in Q30.
[[nodiscard]] inline std::int64_t twist_mass(int shift, std::int64_t response,
                                             std::int64_t radius) {
  const auto times = [&](std::uint64_t x) {
    return (x * static_cast<std::uint64_t>(radius)) >> 30;
  };
  const std::uint64_t twice = times(times(static_cast<std::uint64_t>(response)));
  return bounded_quotient(shift + 24, static_cast<std::int64_t>(twice), 0x7fffffff);
}

/// The inverse of the response to torques about t and b, Q24.
struct RollingMass {
  std::int64_t tt = 0, bb = 0, tb = 0;
};

/// K = (yy, −xy; −xy, xx) in Q(shift). Entries of the inverse are at most 64, of a response that
/// hardly is one less than they ought to be.
[[nodiscard]] inline RollingMass rolling_mass(int shift, std::int64_t xx, std::int64_t yy,
                                              std::int64_t xy) {
  constexpr std::int64_t k_most = std::int64_t{1} << 30;
  const auto narrow = [](std::int64_t x) { return std::int64_t{static_cast<std::int32_t>(x)}; };
  const std::int64_t x = std::max<std::int64_t>(narrow(xx), 1);
  const std::int64_t y = std::max<std::int64_t>(narrow(yy), 1), mixed = narrow(xy);
  const std::int64_t square = mixed * mixed;
  const std::int64_t tt = bounded_quotient(shift + 24, y - square / x, k_most);
  const std::int64_t bb = bounded_quotient(shift + 24, x - square / y, k_most);
  const std::int64_t ratio = std::clamp(raw::round_divide(mixed << 30, x), -k_most, k_most);
  return {tt, bb, raw::round_shift(ratio * tt, 30)};
}

/// √(square), from Q28 to Q30. Of the word only the lower half counts, without its sign.
[[nodiscard]] inline std::int64_t radius_of(std::int64_t square_word) {
  const std::uint64_t square = static_cast<std::uint64_t>(square_word) & 0xffffffffU;
  return static_cast<std::int64_t>(isqrt(square << 32));
}

}  // namespace lockstone::lanes
