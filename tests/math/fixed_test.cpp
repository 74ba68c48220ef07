#include <gtest/gtest.h>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/math/int128.h"
#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::k_max;
using test::k_min;
using test::Raws;

template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept Comparable = requires(A a, B b) {
  a < b;
};
template <class A, class B>
concept Multipliable = requires(A a, B b) {
  a* b;
};
template <class To, class From>
concept Roundable = requires(From from) {
  rounded<To>(from);
};

static_assert(Addable<Length, Length>);
static_assert(!Addable<Length, SolverVelocity>);  // unlike units
static_assert(!Addable<Length, Displacement>);    // unlike formats
static_assert(!Addable<Length, int>);
static_assert(!Comparable<Length, Displacement>);
static_assert(Multipliable<Length, Unit>);
static_assert(!Multipliable<Position, Position>);  // would not be exact in 64 bits
static_assert(Roundable<Length, Displacement>);
static_assert(!Roundable<Length, SolverVelocity>);
static_assert(!std::is_convertible_v<int, Length>);

TEST(RoundShift, EqualsTheWideReferenceAndIsOdd) {
  Raws raws;
  for (int i = 0; i < test::share_of(1000000); ++i) {
    const int shift = static_cast<int>(raws.bits64() % 63);
    const std::int64_t x = raws.signed_below_bits(62);
    const std::int64_t expected = saturate_to_int64(round_shift(Int128::from(x), shift));
    ASSERT_EQ(raw::round_shift(x, shift), expected) << x << ' ' << shift;
    ASSERT_EQ(raw::round_shift(-x, shift), -expected);
    const std::int64_t any = static_cast<std::int64_t>(raws.bits64());
    ASSERT_EQ(raw::round_shift_any(any, shift),
              saturate_to_int64(round_shift(Int128::from(any), shift)));
  }
}

TEST(RoundShift, SendsTiesAwayFromZeroAndKeepsExtremes) {
  EXPECT_EQ(raw::round_shift(3, 1), 2);
  EXPECT_EQ(raw::round_shift(-3, 1), -2);
  EXPECT_EQ(raw::round_shift(-1, 1), -1);
  EXPECT_EQ(raw::round_shift(-1, 2), 0);
  EXPECT_EQ(raw::round_shift_any(k_min, 1), k_min / 2);
  EXPECT_EQ(raw::round_shift_any(k_max, 1), std::int64_t{1} << 62);
  EXPECT_EQ(raw::round_shift_any(k_min, 0), k_min);
}

TEST(RoundDivide, EqualsTheWideReferenceAndIsOdd) {
  Raws raws;
  for (int i = 0; i < test::share_of(1000000); ++i) {
    const std::int64_t n = raws.signed_below_bits(62);
    const auto d = static_cast<std::int64_t>(raws.below_bits(62)) + 1;
    const std::int64_t expected = round_divide(Int128::from(n), d);
    ASSERT_EQ(raw::round_divide(n, d), expected) << n << ' ' << d;
    ASSERT_EQ(raw::round_divide(-n, d), -expected);
  }
}

TEST(MultiplyShift, EqualsTheWideReferenceWhereverTheResultFits) {
  Raws raws;
  for (int i = 0; i < test::share_of(2000000); ++i) {
    const std::int64_t a = i % 97 == 0 ? k_min : raws.signed_below_bits(63);
    const auto b = i % 89 == 0 ? std::numeric_limits<std::int32_t>::min()
                               : static_cast<std::int32_t>(raws.signed_below_bits(31));
    const int shift = 1 + static_cast<int>(raws.bits64() % 62);
    const Int128 exact = multiply_wide(a, std::int64_t{b});
    if (!(magnitude(exact) < (UInt128{0, 1} << (62 + shift)))) continue;
    const std::int64_t expected = saturate_to_int64(round_shift(exact, shift));
    ASSERT_EQ(raw::multiply_shift(a, b, shift), expected) << a << ' ' << b << ' ' << shift;
  }
}

TEST(MultiplyShift, CarriesAcrossItsInnerWordBoundary) {
  for (const int shift : {30, 31, 32, 33}) {
    for (std::int64_t a = (std::int64_t{1} << 31) - 3; a <= (std::int64_t{1} << 31) + 3; ++a) {
      for (const std::int32_t b : {1, -1, 3, 0x7fffffff, -0x7fffffff, 0x40000000, 0x20000001}) {
        const Int128 exact = multiply_wide(a, std::int64_t{b});
        ASSERT_EQ(raw::multiply_shift(a, b, shift), saturate_to_int64(round_shift(exact, shift)));
      }
    }
  }
}

TEST(Saturated, IsTotal) {
  EXPECT_EQ(saturated<SolverVelocity>(Velocity::max()), SolverVelocity::max());
  EXPECT_EQ(saturated<SolverVelocity>(Velocity::min()), SolverVelocity::min());
  EXPECT_EQ(saturated<SolverVelocity>(Velocity::from_raw(-2048)), SolverVelocity::from_raw(-1));
  EXPECT_EQ(raw::saturating_add(k_max, 1), k_max);
  EXPECT_EQ(raw::saturating_add(k_min, -1), k_min);
  EXPECT_EQ(raw::saturating_add(k_min, k_max), -1);
}

TEST(Fixed, FromRatioRoundsAndMirrors) {
  EXPECT_EQ(Length::from_ratio(1, 3).raw, 349525);
  EXPECT_EQ(Length::from_ratio(-2, 3).raw, -699051);
  EXPECT_EQ(rounded<Length>(Displacement::from_raw(-8)), Length::from_raw(-1));
  EXPECT_EQ(rounded<Displacement>(Length::from_raw(-3)), Displacement::from_raw(-48));
}

TEST(Quat, MatrixRotatesAsTheQuaternionDoes) {
  Raws raws;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const auto unit = [&] { return Unit::from_raw(raws.any32()); };
    const Quat q = normalized({unit(), unit(), unit(), unit()});
    const Mat3 m = to_matrix(q);
    const auto length = [&] { return Length::from_raw(raws.any32() >> 2); };
    const Vec3<Length> v{length(), length(), length()};
    const Vec3<Length> back = rotate_inverse(m, rotate(m, v));
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(back[axis].raw, v[axis].raw, 5);
    const Mat3 turned_back = to_matrix(conjugate(q));
    ASSERT_EQ(turned_back.x.y, m.y.x);  // the transpose, exactly
    ASSERT_EQ(turned_back.z.x, m.x.z);
  }
}

}  // namespace
}  // namespace lockstone
