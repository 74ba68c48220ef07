// The step of a world, in the forms that the stages need.
#pragma once

#include <cstdint>

#include <lockstone/fixed.h>

namespace lockstone {

/// 2π in Q28, from the digits 6.28318530717958647692: hertz to radians per second.
inline constexpr std::int64_t k_two_pi_q28 = 1686629713;

/// A number in (0, 1] with 31 significant bits: mantissa · 2^-shift, mantissa in [2^30, 2^31).
struct Factor {
  std::int32_t mantissa = 0;
  int shift = 0;

  /// 1 / divisor, 1 ≤ divisor < 2^31; relative error ≤ 2^-31.
  [[nodiscard]] static constexpr Factor one_over(std::int64_t divisor) {
    int shift = 30;
    while ((std::int64_t{1} << (shift - 30)) < divisor)
      ++shift;
    // 2^shift / divisor lies in [2^30, 2^31].
    const std::int64_t quotient = raw::round_divide(std::int64_t{1} << shift, divisor);
    return {raw::saturate<std::int32_t>(quotient), shift};
  }

  /// x · factor, rounded.
  [[nodiscard]] constexpr std::int64_t times(std::int64_t x) const {
    return raw::multiply_shift(x, mantissa, shift);
  }
};

/// Durations: the tick dt = 1 / tick_rate and the substep h = dt / substeps.
struct TimeStep {
  std::int32_t tick_rate = 60;
  std::int32_t substeps = 4;
  Factor tick;
  Factor substep;

  [[nodiscard]] static constexpr TimeStep of(std::int32_t tick_rate, std::int32_t substeps) {
    return {tick_rate, substeps, Factor::one_over(tick_rate),
            Factor::one_over(std::int64_t{tick_rate} * substeps)};
  }

  /// Substeps per second.
  [[nodiscard]] constexpr std::int32_t substep_rate() const { return tick_rate * substeps; }
};

}  // namespace lockstone
