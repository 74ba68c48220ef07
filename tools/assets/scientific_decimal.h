// Decimal numbers as modelling programs write them, to lengths with one rounding and no floating
// point: the same file gives the same asset on every machine.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include <lockstone/units.h>

namespace lockstone::assets {

inline constexpr int k_max_significant_digits = 18;
inline constexpr int k_max_scale_digits = 9;

/// ± digits · 10^exponent.
struct ScientificDecimal {
  bool negative = false;
  std::uint64_t digits = 0;
  int exponent = 0;
};

/// Reads `[+-]digits[.digits][e[+-]digits]`, where the digits on one side of the point may be
/// missing. Nothing for other text, for more than `max_digits` (≤ 18) significant digits, and for
/// exponents beyond ±99.
[[nodiscard]] std::optional<ScientificDecimal> read_scientific(
    std::string_view text, int max_digits = k_max_significant_digits);

/// value · scale metres to nearest, ties away from zero; nothing beyond k_max_asset_coordinate.
/// `scale` has at most k_max_scale_digits digits.
[[nodiscard]] std::optional<Length> scaled_length(const ScientificDecimal& value,
                                                  const ScientificDecimal& scale);

}  // namespace lockstone::assets
