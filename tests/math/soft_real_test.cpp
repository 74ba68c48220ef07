// Real numbers in integers, against long double.
#include "core/math/soft_real.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

long double value(SoftReal x) {
  return std::ldexp(static_cast<long double>(x.mantissa), x.exponent);
}

SoftReal random_soft(test::Random& random) {
  const std::int64_t lanes = random.between(-(std::int64_t{1} << 40), std::int64_t{1} << 40);
  const auto exponent = static_cast<int>(random.between(-60, 60));
  return SoftReal::of(lanes, exponent);
}

TEST(SoftReal, HasNormalMantissasOrIsZero) {
  EXPECT_EQ(SoftReal::of(0).mantissa, 0);
  EXPECT_EQ(SoftReal::of(1).mantissa, std::int64_t{1} << 62);
  EXPECT_EQ(value(SoftReal::of(INT64_MIN)), std::ldexp(-1.0L, 63));
  EXPECT_EQ(value(SoftReal::of(-3, 5)), -96);
}

TEST(SoftReal, AddsMultipliesDividesAndTakesRoots) {
  test::Random random(1);
  for (int i = 0; i < test::share_of(100000); ++i) {
    const SoftReal a = random_soft(random), b = random_soft(random);
    const long double x = value(a), y = value(b), tiny = std::ldexp(1.0L, -60);
    const long double most = std::max(std::fabs(x), std::fabs(y));
    ASSERT_LE(std::fabs(value(a + b) - (x + y)), most * tiny);
    ASSERT_LE(std::fabs(value(a - b) - (x - y)), most * tiny);
    ASSERT_LE(std::fabs(value(a * b) - x * y), std::fabs(x * y) * tiny);
    if (y != 0) {
      ASSERT_LE(std::fabs(value(a / b) - x / y), std::fabs(x / y) * tiny);
    }
    const SoftReal square = a * a;
    ASSERT_LE(std::fabs(value(root_of(square)) - std::fabs(x)), std::fabs(x) * tiny);
  }
}

TEST(SoftReal, BecomesAFixedPointNumberToNearest) {
  EXPECT_EQ(fixed_point(SoftReal::of(3, -2), 0), 1);
  EXPECT_EQ(fixed_point(SoftReal::of(-7, -2), 0), -2);
  EXPECT_EQ(fixed_point(SoftReal::of(3, -2), 2), 3);
  EXPECT_EQ(fixed_point(SoftReal::of(1, -100), 30), 0);
  EXPECT_EQ(fixed_point(SoftReal::of(1, 70), 0), INT64_MAX);
  EXPECT_EQ(fixed_point(SoftReal::of(-1, 70), 0), INT64_MIN);
}

}  // namespace
}  // namespace lockstone
