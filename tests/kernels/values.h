// Words for lane tests: random ones, extremes, and those beside which a carry or a rounding tips.
#pragma once

#include <cstdint>

#include "tests/support/random.h"

namespace lockstone::lanes::test {

/// ±2^k, and the numbers up to two beside it.
inline std::int64_t beside_power(lockstone::test::Random& random) {
  const std::uint64_t power = std::uint64_t{1} << random.between(0, 63);
  const std::uint64_t value = power + static_cast<std::uint64_t>(random.between(-2, 2));
  return static_cast<std::int64_t>(random.next() % 2 == 0 ? value : 0 - value);
}

/// A word for a shift by some amount: a tie between two results, or one beside it.
inline std::int64_t beside_tie(lockstone::test::Random& random) {
  const int shift = static_cast<int>(random.between(1, 62));
  const std::uint64_t whole = random.next() << shift;
  return static_cast<std::int64_t>(whole + (std::uint64_t{1} << (shift - 1)) +
                                   static_cast<std::uint64_t>(random.between(-1, 1)));
}

inline std::int32_t operand(lockstone::test::Random& random) {
  switch (random.next() % 4) {
    case 0:
      return static_cast<std::int32_t>(beside_power(random));
    case 1:
      return INT32_MIN;
    case 2:
      return INT32_MAX;
    default:
      return static_cast<std::int32_t>(random.next());
  }
}

inline std::int64_t word(lockstone::test::Random& random) {
  switch (random.next() % 5) {
    case 0:
      return beside_power(random);
    case 1:
      return beside_tie(random);
    case 2:
      return operand(random);
    case 3:
      return static_cast<std::int64_t>((std::uint64_t{random.next()} << 32) |
                                       static_cast<std::uint32_t>(operand(random)));
    default:
      return static_cast<std::int64_t>(random.next());
  }
}

}  // namespace lockstone::lanes::test
