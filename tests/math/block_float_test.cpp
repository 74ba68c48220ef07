#include "core/math/block_float.h"

#include <gtest/gtest.h>

#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::k_max;
using test::k_min;
using test::Raws;
using test::Real;

Real power_of_two(int exponent) {
  return Real(1, -exponent);
}
Real value_of(BlockFloat x) {
  return Real(x.mantissa) * power_of_two(x.exponent);
}

bool normal(BlockFloat x) {
  return x == BlockFloat{} || x.mantissa >= std::int32_t{1} << 30;
}

BlockFloat any_block(Raws& raws, int exponents) {
  const auto mantissa = static_cast<std::int32_t>((1U << 30) | raws.below_bits(30));
  const auto span = static_cast<std::uint64_t>(2 * exponents + 1);
  return {mantissa, static_cast<std::int8_t>(static_cast<int>(raws.bits64() % span) - exponents)};
}

TEST(BlockFloat, InverseOfAnyMassIsCorrectlyRounded) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const Mass mass = Mass::from_raw(static_cast<std::int64_t>(raws.below_bits(63)));
    if (mass.raw == 0) continue;
    const BlockFloat inverse = inverse_of(mass);
    ASSERT_TRUE(normal(inverse)) << mass.raw;
    const Real scaled = Real(1) / Real(mass.raw, 32) / power_of_two(inverse.exponent);
    worst = test::worst_of(worst, scaled.error_of(inverse.mantissa, 0));
  }
  EXPECT_LE(worst, 0.5);
}

TEST(BlockFloat, InversesOfPowersOfTwoAreExact) {
  EXPECT_EQ(inverse_of({}), BlockFloat{});
  EXPECT_EQ(inverse_of(Mass::from_integer(1)), (BlockFloat{1 << 30, -30}));
  EXPECT_EQ(inverse_of(Mass::from_integer(4)), (BlockFloat{1 << 30, -32}));
  EXPECT_EQ(inverse_of(Mass::from_raw(1)), (BlockFloat{1 << 30, 2}));
}

TEST(BlockFloat, ScalingRoundsOnceAndSaturates) {
  Raws raws;
  const Real low(k_min), high(k_max);
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const std::int64_t raw = i % 53 == 0 ? k_min : raws.signed_below_bits(63);
    const BlockFloat x = any_block(raws, 127);
    const int shift = static_cast<int>(raws.bits64() % 129) - 64;
    const Real exact = Real(raw) * value_of(x) * power_of_two(shift);
    const std::int64_t ours = scale_saturating(raw, x, shift);
    if (high < exact) {
      ASSERT_EQ(ours, k_max);
    } else if (exact < low) {
      ASSERT_EQ(ours, k_min);
    } else {
      worst = test::worst_of(worst, exact.error_of(ours, 0));
    }
    if (raw != k_min && ours != k_min && ours != k_max) {
      ASSERT_EQ(scale_saturating(-raw, x, shift), -ours);
    }
  }
  EXPECT_LE(worst, 0.5);
}

TEST(BlockFloat, ImpulseTimesInverseMassIsAVelocity) {
  const BlockFloat inverse = inverse_of(Mass::from_integer(4));
  const Impulse impulse = Impulse::from_integer(-10);
  EXPECT_EQ(multiply_saturating<Velocity>(impulse, inverse), Velocity::from_ratio(-5, 2));
  EXPECT_EQ(multiply_saturating<SolverVelocity>(Impulse::max(), inverse), SolverVelocity::max());
  EXPECT_EQ(multiply_saturating<Velocity>(Impulse::max(), BlockFloat{}), Velocity{});
}

TEST(BlockFloat, RatioIsCorrectlyRounded) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const BlockFloat a = any_block(raws, i % 2 == 0 ? 20 : 127);
    const BlockFloat b = any_block(raws, i % 2 == 0 ? 20 : 127);
    const Real exact = value_of(a) / (value_of(a) + value_of(b));
    worst = test::worst_of(worst, exact.error_of(ratio(a, b).raw, 30));
    const std::int64_t both = std::int64_t{ratio(a, b).raw} + ratio(b, a).raw;
    ASSERT_TRUE(both == std::int64_t{1} << 30 || both == (std::int64_t{1} << 30) + 1);
  }
  EXPECT_LE(worst, 0.5);
}

TEST(BlockFloat, IsLessAsTheValuesAre) {
  Raws raws;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const BlockFloat a = i % 5 == 0 ? BlockFloat{} : any_block(raws, 20);
    const BlockFloat b = i % 7 == 0 ? BlockFloat{} : i % 11 == 0 ? a : any_block(raws, 20);
    ASSERT_EQ(is_less(a, b), value_of(a) < value_of(b));
  }
}

TEST(BlockFloat, RatioOfEqualsAndZeros) {
  const BlockFloat a{(1 << 30) + 12345, -77};
  EXPECT_EQ(ratio(a, a), Unit::from_ratio(1, 2));
  EXPECT_EQ(ratio(a, {}), Unit::from_integer(1));
  EXPECT_EQ(ratio({}, a), Unit{});
  EXPECT_EQ(ratio({}, {}), Unit{});
}

TEST(BlockFloat, SumIsCorrectlyRounded) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const BlockFloat a = any_block(raws, i % 2 == 0 ? 20 : 60);
    const BlockFloat b = any_block(raws, i % 2 == 0 ? 20 : 60);
    const BlockFloat sum = add(a, b);
    ASSERT_TRUE(normal(sum));
    ASSERT_EQ(sum, add(b, a));
    const Real exact = (value_of(a) + value_of(b)) / power_of_two(sum.exponent);
    worst = test::worst_of(worst, exact.error_of(sum.mantissa, 0));
  }
  EXPECT_LE(worst, 0.5);
}

}  // namespace
}  // namespace lockstone
