#include <gtest/gtest.h>

#include <lockstone/fixed.h>

#include "core/math/int128.h"
#include "core/math/reciprocal.h"
#include "core/math/round_divisor.h"
#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

constexpr std::uint64_t k_top = std::uint64_t{1} << 63;

void expect_reciprocal(std::uint64_t d) {
  const UInt128 most{~std::uint64_t{0} - d, ~std::uint64_t{0}};  // 2^128 − 1 − 2^64·d
  ASSERT_EQ(reciprocal_word(d), divide(most, d).quotient) << d;
  ASSERT_EQ(reciprocal_q124(d), round_divide(UInt128{0, 1} << 124, d)) << d;
}

TEST(Division, ReciprocalsAreThoseOfTheQuotient) {
  test::Raws raws;
  for (int i = 0; i < test::share_of(1000000); ++i)
    ASSERT_NO_FATAL_FAILURE(expect_reciprocal(raws.below_bits(64) | k_top));
  for (int bit = 0; bit < 63; ++bit) {
    for (std::uint64_t near = 0; near < 5; ++near) {
      expect_reciprocal(k_top + (std::uint64_t{1} << bit) + near);
      expect_reciprocal(~(std::uint64_t{1} << bit) - near);
    }
  }
  expect_reciprocal(k_top);
  expect_reciprocal(~std::uint64_t{0});
}

void expect_quotient(std::int64_t x, std::int64_t d) {
  ASSERT_EQ(RoundDivisor(d).quotient(x), raw::round_divide(x, d)) << x << ' ' << d;
  ASSERT_EQ(RoundDivisor(d).doubled().quotient(x), raw::round_divide(x, 2 * d)) << x << ' ' << d;
}

TEST(Division, RoundDivisorsRoundAsDivisionDoes) {
  test::Raws raws;
  constexpr std::int64_t k_most = std::int64_t{1} << 62;
  for (int i = 0; i < test::share_of(1000000); ++i) {
    const auto d = static_cast<std::int64_t>((raws.below_bits(64) >> 4 >> i % 60) | 1);
    const auto x = static_cast<std::int64_t>(raws.below_bits(64) >> 3);
    ASSERT_NO_FATAL_FAILURE(expect_quotient(x, d));
    ASSERT_NO_FATAL_FAILURE(expect_quotient(-x, d));
    ASSERT_NO_FATAL_FAILURE(expect_quotient(x / d * d + d / 2, d));
  }
  for (const std::int64_t x : {std::int64_t{0}, k_most, -k_most, k_most - 1}) {
    expect_quotient(x, 1);
    expect_quotient(x, 2);
    expect_quotient(x, 240);
    expect_quotient(x, std::int64_t{1} << 60);
  }
}

}  // namespace
}  // namespace lockstone
