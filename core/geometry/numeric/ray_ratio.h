// Fractions of a ray as quotients that are never divided to be compared.
#pragma once

#include <cstdint>

#include <lockstone/units.h>

#include "core/math/int128.h"

namespace lockstone::geometry {

/// numerator / denominator, denominator > 0.
struct RayRatio {
  std::int64_t numerator = 0;
  std::int64_t denominator = 1;

  friend constexpr bool operator<(const RayRatio& a, const RayRatio& b) {
    return multiply_wide(a.numerator, b.denominator) < multiply_wide(b.numerator, a.denominator);
  }
};

/// To nearest. 0 ≤ ratio ≤ 1.
[[nodiscard]] constexpr Unit rounded(const RayRatio& ratio) {
  const std::int64_t fraction = round_divide(
      multiply_wide(ratio.numerator, std::int64_t{1} << Unit::frac_bits), ratio.denominator);
  return Unit::from_raw(static_cast<std::int32_t>(fraction));
}

}  // namespace lockstone::geometry
