// Division by one number again and again, without dividing.
#pragma once

#include <cstdint>

#include "core/math/int128.h"

namespace lockstone {

/// T. Granlund, P. L. Montgomery, "Division by Invariant Integers using Multiplication", 1994.
class RoundDivisor {
 public:
  RoundDivisor() = default;

  /// 1 ≤ divisor ≤ 2^60.
  constexpr explicit RoundDivisor(std::int64_t divisor)
      : divisor_(static_cast<std::uint64_t>(divisor)), inverse_(~std::uint64_t{0} / divisor_) {
    LKS_ASSERT(divisor >= 1 && divisor <= std::int64_t{1} << 60);
  }

  /// Divides by twice as much.
  [[nodiscard]] constexpr RoundDivisor doubled() const {
    RoundDivisor result;
    result.divisor_ = 2 * divisor_;
    result.inverse_ = inverse_ / 2;
    return result;
  }

  /// x / divisor to nearest, ties away from zero. |x| ≤ 2^62. With inverse > 2^64/divisor − 1 the
  /// first quotient is at most one too small.
  [[nodiscard]] constexpr std::int64_t quotient(std::int64_t x) const {
    const std::uint64_t sign = x < 0 ? ~std::uint64_t{0} : 0;
    const std::uint64_t size = (static_cast<std::uint64_t>(x) ^ sign) - sign;
    std::uint64_t result = multiply_high(size, inverse_);
    const std::uint64_t remainder = size - result * divisor_;  // below twice the divisor
    result += remainder + remainder >= divisor_ ? 1 : 0;
    result += remainder + remainder >= 3 * divisor_ ? 1 : 0;
    return static_cast<std::int64_t>((result ^ sign) - sign);
  }

 private:
  std::uint64_t divisor_ = 1;
  std::uint64_t inverse_ = ~std::uint64_t{0};
};

}  // namespace lockstone
