// Division, roots of typed quantities, powers, logarithms and tangents. Every input of the
// functions of one 32-bit argument is tried by numerics_exhaustive; here are two arguments, 64-bit
// formats, symmetries and bounds.
#include <gmpxx.h>
#include <gtest/gtest.h>

#include "core/math/divide.h"
#include "core/math/exponential.h"
#include "core/math/square_roots.h"
#include "core/math/trig.h"
#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::k_max;
using test::k_min;
using test::Raws;
using test::Real;
using test::worst_of;

mpz_class clamped(const mpz_class& x) {
  return x > mpz_class(k_max) ? mpz_class(k_max) : x < mpz_class(k_min) ? mpz_class(k_min) : x;
}

/// ⌊a · 2^shift / b⌉ by whole numbers of any size.
mpz_class exact_quotient(std::int64_t a, std::int64_t b, int shift) {
  const unsigned up = shift > 0 ? static_cast<unsigned>(shift) : 0;
  const unsigned down = shift < 0 ? static_cast<unsigned>(-shift) : 0;
  const mpz_class n = abs(mpz_class(a)) << up, d = abs(mpz_class(b)) << down;
  const mpz_class size = (2 * n + d) / (2 * d);
  return clamped((a < 0) != (b < 0) ? mpz_class(-size) : size);
}

TEST(Divide, EqualsTheExactQuotientOfEverySizeAndShift) {
  Raws raws;
  for (int i = 0; i < test::share_of(1000000); ++i) {
    const std::int64_t a = i % 61 == 0 ? k_min : raws.signed_below_bits(63);
    const std::int64_t b = i % 59 == 0 ? k_min : raws.signed_below_bits(63);
    const int shift = static_cast<int>(raws.bits64() % 127) - 63;
    if (b == 0) continue;
    ASSERT_EQ(mpz_class(divide_raw_saturating(a, b, shift)), exact_quotient(a, b, shift))
        << a << ' ' << b << ' ' << shift;
  }
}

TEST(Divide, SendsTiesAwayFromZeroAndZeroDivisorsToTheBounds) {
  EXPECT_EQ(divide_raw_saturating(5, 2, 0), 3);
  EXPECT_EQ(divide_raw_saturating(-5, 2, 0), -3);
  EXPECT_EQ(divide_raw_saturating(k_min, k_min, -1), 1);  // a tie at a divisor beyond 64 bits
  EXPECT_EQ(divide_raw_saturating(k_max, k_min, -1), 0);
  EXPECT_EQ(divide_raw_saturating(1, 0, 5), k_max);
  EXPECT_EQ(divide_raw_saturating(-1, 0, 5), k_min);
  EXPECT_EQ(divide_raw_saturating(0, 0, 5), 0);
  EXPECT_EQ(divide_raw_saturating(k_min, -1, 0), k_max);
  EXPECT_EQ(divide<Rate>(SolverVelocity::from_integer(3), Length::from_integer(-2)).raw, -3 << 19);
  EXPECT_EQ(reciprocal<Number>(Number::from_integer(3)).raw, 349525);
  EXPECT_EQ(divide_saturating<Number>(Number::max(), Number::from_raw(1)), Number::max());
}

template <class To, class A, class B>
concept Divisible = requires(A a, B b) {
  divide<To>(a, b);
};
static_assert(Divisible<Rate, SolverVelocity, Length>);
static_assert(!Divisible<Number, SolverVelocity, Length>);  // m/s over m is no plain number
static_assert(divide<Number>(Number::from_integer(1), Number::from_integer(4)).raw == 1 << 18);

/// (2r − 1)² ≤ 4n < (2r + 1)²
bool is_root(const mpz_class& r, const mpz_class& n) {
  return (r == 0 || (2 * r - 1) * (2 * r - 1) <= 4 * n) && 4 * n < (2 * r + 1) * (2 * r + 1);
}

TEST(SquareRoot, OfAreasAndWideNumbersIsTheNearest) {
  using Area = Fixed<SquareMetre, std::int64_t, 40>;
  using WideNumber = Fixed<Scalar, std::int64_t, 32>;
  Raws raws;
  for (int i = 0; i < test::share_of(500000); ++i) {
    const auto raw = static_cast<std::int64_t>(raws.below_bits(63));
    const mpz_class n(raw);
    ASSERT_TRUE(is_root(sqrt(WideNumber::from_raw(raw)).raw, n << 32));
    if (raw < std::int64_t{1} << 61) {
      ASSERT_TRUE(is_root(sqrt<Length>(Area::from_raw(raw)).raw, n));
    }
  }
  EXPECT_EQ(sqrt_saturating<Length>(Area::max()), Length::max());
  EXPECT_EQ(sqrt_saturating<Number>(Number::from_raw(-1)), Number{});
  EXPECT_EQ(rsqrt_saturating<Number>(Number{}), Number::max());
  EXPECT_EQ(rsqrt<Number>(Number::from_integer(4)).raw, 1 << 19);
}

TEST(Hypot, IsTheNearestEvenAndSymmetric) {
  Raws raws;
  for (int i = 0; i < test::share_of(300000); ++i) {
    const std::int64_t x = raws.signed_below_bits(62), y = raws.signed_below_bits(62),
                       z = i % 2 == 0 ? 0 : raws.signed_below_bits(61);
    const mpz_class n = mpz_class(x) * x + mpz_class(y) * y + mpz_class(z) * z;
    const Position wide =
        hypot(Position::from_raw(x), Position::from_raw(y), Position::from_raw(z));
    ASSERT_TRUE(is_root(wide.raw, n));
    ASSERT_EQ(hypot(Position::from_raw(-z), Position::from_raw(x), Position::from_raw(-y)), wide);
    const auto narrow = [](std::int64_t c) {
      return Length::from_raw(static_cast<std::int32_t>(c >> 33));
    };
    const Length a = narrow(x), b = narrow(y);
    ASSERT_TRUE(is_root(hypot(a, b).raw, mpz_class(a.raw) * a.raw + mpz_class(b.raw) * b.raw));
  }
  EXPECT_EQ(hypot(Length::from_raw(3), Length::from_raw(-4)).raw, 5);
  EXPECT_EQ(hypot_saturating(Length::min(), Length::min(), Length::min()), Length::max());
  EXPECT_EQ(hypot_saturating(Position::min(), Position::min(), Position::min()), Position::max());
}

TEST(Exp2, IsExactAtWholeNumbersAndRisesMonotonically) {
  for (int x = -20; x <= 10; ++x)
    ASSERT_EQ(exp2<Number>(Number::from_integer(x)).raw, 1 << (20 + x));
  EXPECT_EQ(exp2_saturating<Number>(Number::from_integer(-21)).raw, 1);  // a tie, away from zero
  EXPECT_EQ(exp2_saturating<Number>(Number::from_raw(-21 * (1 << 20) - 1)).raw, 0);
  EXPECT_EQ(exp2_saturating<Number>(Number::min()).raw, 0);
  EXPECT_EQ(exp2_saturating<Number>(Number::from_integer(11)), Number::max());
  std::int32_t last = 0;
  for (std::int32_t raw = -(22 << 20); raw < 11 << 20; raw += 7 * test::k_share) {
    const std::int32_t power = exp2_saturating<Number>(Number::from_raw(raw)).raw;
    ASSERT_GE(power, last);
    last = power;
  }
}

TEST(Log2, IsExactAtPowersOfTwoAndTakesWideInputs) {
  for (int bit = 0; bit < 31; ++bit)
    ASSERT_EQ(log2<Number>(Number::from_raw(1 << bit)), Number::from_integer(bit - 20));
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const auto raw = static_cast<std::int64_t>(raws.below_bits(63)) | 1;
    const auto ours = log2_raw(raw, 32, 56);
    worst = worst_of(worst, log2(Real(raw, 32)).error_of(ours, 56));
  }
  EXPECT_LT(worst, 0.54);  // the table and the series err by less than 2^-61
  RecordProperty("worst_ulp_q56", std::to_string(worst));
}

TEST(Log2, UndoesExp2) {
  for (std::int32_t raw = -(1 << 20); raw < 11 << 20; raw += 997) {
    const Number power = exp2<Number>(Number::from_raw(raw));
    ASSERT_NEAR(log2<Number>(power).raw, raw, 2) << raw;
  }
}

TEST(Tan, IsOddAndSaturatesAtThePoles) {
  constexpr std::int32_t half_pi = 210828714;  // ⌊π/2 · 2^27⌉
  EXPECT_EQ(tan(Angle{}), Number{});
  EXPECT_EQ(tan(Angle::from_raw(half_pi / 2)).raw, 1 << 20);
  EXPECT_EQ(tan_saturating(Angle::from_raw(half_pi)), Number::max());
  EXPECT_EQ(tan_saturating(Angle::from_raw(-half_pi)).raw, -Number::max().raw);
  EXPECT_EQ(tan_saturating(Angle::from_raw(half_pi + 1)).raw, -Number::max().raw);
  for (std::int64_t raw = 0; raw < std::int64_t{1} << 31; raw += 1021) {
    const auto x = static_cast<std::int32_t>(raw);
    ASSERT_EQ(tan_saturating(Angle::from_raw(-x)).raw, -tan_saturating(Angle::from_raw(x)).raw);
  }
  using Slope = Fixed<Scalar, std::int32_t, 30>;
  EXPECT_EQ(tan<Slope>(Angle::from_raw(half_pi / 2)).raw, 1073741823);
}

}  // namespace
}  // namespace lockstone
