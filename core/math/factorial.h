// Factorials, the divisors of power series.
#pragma once

#include <cstdint>

namespace lockstone {

/// ⌊2^64 / n!⌋ for n ≥ 3.
[[nodiscard]] constexpr std::uint64_t inverse_factorial_q64(int n) {
  std::uint64_t factorial = 1;
  for (int i = 2; i <= n; ++i)
    factorial *= static_cast<std::uint64_t>(i);
  return ~std::uint64_t{0} / factorial;
}

}  // namespace lockstone
