// Positive factors of any size, which turn a row's quantities into those of its island's problem.
#pragma once

#include <bit>
#include <cstdint>

#include <lockstone/fixed.h>

#include "core/math/product_sum.h"

namespace lockstone {

/// mantissa · 2^-shift, mantissa in [2^30, 2^31); relative error of each operation ≤ 2^-30.
struct RowScale {
  std::uint32_t mantissa = std::uint32_t{1} << 30;
  std::int32_t shift = 30;

  /// value · 2^-shift, value > 0.
  [[nodiscard]] static constexpr RowScale of(std::uint64_t value, int shift) {
    LKS_ASSERT(value != 0);
    const int excess = static_cast<int>(std::bit_width(value)) - 31;
    if (excess > 0) return {static_cast<std::uint32_t>(value >> excess), shift - excess};
    return {static_cast<std::uint32_t>(value << -excess), shift - excess};
  }

  [[nodiscard]] constexpr RowScale operator*(const RowScale& other) const {
    return of(std::uint64_t{mantissa} * other.mantissa, shift + other.shift);
  }

  [[nodiscard]] constexpr RowScale reciprocal() const {
    return of((std::uint64_t{1} << 62) / mantissa, 62 - shift);
  }

  /// As `times`, for |x| < 2^32.
  [[nodiscard]] constexpr std::int64_t times_word(std::int64_t x, int more) const {
    LKS_ASSERT(magnitude(x) >> 32 == 0);
    const int right = shift + more;
    if (right < 0) return times(x, more);
    return right > 62 ? 0 : raw::round_shift_any(x * std::int64_t{mantissa}, right);
  }

  /// x · scale · 2^-more, rounded; within ±k_product_bound.
  [[nodiscard]] constexpr std::int64_t times(std::int64_t x, int more) const {
    const int right = shift + more;
    if (right > 125) return 0;
    if (right >= 1) return product_rounded(x, mantissa, right);
    const std::int64_t product = product_rounded(x, mantissa, 1);
    return std::clamp(raw::scale_saturating(product, std::min(1 - right, 62)), -k_product_bound,
                      k_product_bound);
  }
};

}  // namespace lockstone
