#include "core/math/roots.h"

#include <gtest/gtest.h>

#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::k_min;
using test::Raws;
using test::Real;

TEST(ReciprocalSqrt, NeverExceedsTheTrueValueAndStaysWithinItsBound) {
  Raws raws;
  double worst = 0;
  const auto check = [&](std::uint64_t s) {
    const Real fraction =
        Real(static_cast<std::int64_t>(s >> 1), 63) + Real(static_cast<std::int64_t>(s & 1), 64);
    const Real root = Real(1) / sqrt(fraction);
    const Real ours = Real(static_cast<std::int64_t>(reciprocal_sqrt(s) >> 1), 61) +
                      Real(static_cast<std::int64_t>(reciprocal_sqrt(s) & 1), 62);
    ASSERT_FALSE(root < ours) << s;
    worst = test::worst_of(worst, ((root - ours) / root).to_double());
  };
  for (std::uint64_t top = 64; top < 256; ++top) {  // both ends of each table interval
    check(top << 56);
    check((top << 56) | ((std::uint64_t{1} << 56) - 1));
    for (int i = 0; i < 500; ++i)
      check((top << 56) | (raws.bits64() >> 8));
  }
  EXPECT_LT(worst, 0x1p-43);
  RecordProperty("worst_relative_error", std::to_string(worst));
}

TEST(Isqrt, FloorsAtNeighboursOfPerfectSquares) {
  for (std::uint64_t root = 1; root <= 0xffffffffU;
       root += root < 100000 ? 1 : 2039 * test::k_share) {
    const std::uint64_t square = root * root;
    ASSERT_EQ(isqrt(square), root);
    ASSERT_EQ(isqrt(square - 1), root - 1);
    ASSERT_EQ(isqrt(square + 2 * root), root);
    ASSERT_EQ(isqrt_rounded(square + root), root);
    ASSERT_EQ(isqrt_rounded(square + root + 1), root + 1);
  }
  EXPECT_EQ(isqrt(0), 0U);
  EXPECT_EQ(isqrt(~std::uint64_t{0}), 0xffffffffU);
  EXPECT_EQ(isqrt_rounded(~std::uint64_t{0}), std::uint64_t{1} << 32);
}

TEST(Isqrt, FloorsBelowSquaresWhereTheReciprocalIsHigh) {
  // Of k from 2^30 to 2^32, these are among the ten where it is high enough to reach k.
  for (const std::uint64_t k : {3484768811U, 3752242361U, 3771691627U, 3885463971U, 3940446411U}) {
    EXPECT_EQ(isqrt(k * k - 1), k - 1);
    EXPECT_EQ(isqrt(k * k), k);
  }
}

TEST(Isqrt, FloorsRandomInputsOfEveryScale) {
  Raws raws;
  for (int i = 0; i < test::share_of(3000000); ++i) {
    const std::uint64_t n = raws.below_bits(64);
    const std::uint64_t root = isqrt(n);
    ASSERT_TRUE(root * root <= n && n - root * root <= 2 * root) << n;
  }
}

TEST(Isqrt128, FloorsWhereTheFirstEstimateIsHigh) {
  // reciprocal_sqrt of the high word is above 1/√ by 4e-20 of it, and the root by a last place.
  const UInt128 n{0xb69bad757d373f1cU, 0x8e04ea8000000000U};
  EXPECT_EQ(isqrt128(n), 0xd8364d008a904673U);
  EXPECT_EQ(isqrt128(n >> 36), 0xd8364d008a904673U >> 18);
}

TEST(Isqrt128, FloorsInputsOfEveryScaleAndNeighboursOfSquares) {
  Raws raws;
  const auto check = [](UInt128 n) {
    const std::uint64_t root = isqrt128(n);
    const UInt128 square = multiply_wide(root, root);
    ASSERT_TRUE(square <= n && n - square <= (UInt128{0, root} << 1)) << n.high << ' ' << n.low;
  };
  for (int i = 0; i < test::share_of(1000000); ++i) {
    check({raws.below_bits(64), raws.bits64()});
    const std::uint64_t root = raws.below_bits(64) | 1;
    const UInt128 square = multiply_wide(root, root);
    ASSERT_EQ(isqrt128(square), root);
    ASSERT_EQ(isqrt128(square - UInt128{0, 1}), root - 1);
  }
  check({~std::uint64_t{0}, ~std::uint64_t{0}});
}

// Where Newton's last step has nothing left to add, rounding must not lift the estimate above the
// root: 2^126 / y² for an estimate y of 31 fraction bits, and a case that once did not end.
TEST(Isqrt128, EndsWhereTheEstimateIsAlreadyExact) {
  Raws raws;
  const auto check = [](UInt128 n) {
    const std::uint64_t root = isqrt128(n);
    const UInt128 square = multiply_wide(root, root);
    ASSERT_TRUE(square <= n && n - square <= (UInt128{0, root} << 1)) << n.high << ' ' << n.low;
  };
  check({9, 12113780222731940864U});
  for (int i = 0; i < test::share_of(1000000); ++i) {
    const std::uint64_t y = (std::uint64_t{1} << 31) | raws.below_bits(31) | 1;
    const std::uint64_t s = divide(UInt128{std::uint64_t{1} << 62, 0}, y * y).quotient;
    if (s < std::uint64_t{1} << 62) continue;
    check({s, raws.bits64()});
    check({s - (i % 2 == 0 ? 1U : 0U), ~std::uint64_t{0}});
    check({s + 1, 0});
  }
}

TEST(Norm, IsRoundedCorrectlyForVectorsOfAnyScale) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const std::int64_t x = i % 101 == 0 ? k_min : raws.signed_below_bits(63);
    const std::int64_t y = raws.signed_below_bits(62), z = raws.signed_below_bits(62);
    const Real root = sqrt(Real(x) * Real(x) + Real(y) * Real(y) + Real(z) * Real(z));
    const std::uint64_t ours = norm(x, y, z);
    const Real rest = root - Real(static_cast<std::int64_t>(ours >> 1), -1);
    worst = test::worst_of(worst, rest.error_of(static_cast<std::int64_t>(ours & 1), 0));
    ASSERT_EQ(direction(x, y, z).length, ours);
  }
  EXPECT_LE(worst, 0.5);
  EXPECT_EQ(length(Vec3<Length>{Length::from_raw(3), Length::from_raw(4), Length::from_raw(12)}),
            Length::from_raw(13));
  EXPECT_EQ(length(Vec3<Length>{Length::min(), {}, {}}), Length::max());
}

TEST(NormBound, IsNotBelowTheNormAndAtMostASeventhAbove) {
  const auto check = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    const auto exact = static_cast<std::int64_t>(norm(x, y, z));
    const std::int64_t bound = norm_bound(x, y, z);
    ASSERT_GE(bound, exact) << x << ' ' << y << ' ' << z;
    ASSERT_LE(bound - exact, exact / 7 + 2) << x << ' ' << y << ' ' << z;
  };
  constexpr std::int64_t k_most = std::int64_t{1} << 57;
  for (const std::int64_t one : {std::int64_t{0}, std::int64_t{1}, std::int64_t{1000}, k_most}) {
    check(one, 0, 0);
    check(0, -one, one);
    check(-one, one, -one);
  }
  Raws raws;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const int bits = 1 + i % 57;
    const std::int64_t x = raws.signed_below_bits(bits), y = raws.signed_below_bits(bits);
    check(x, y, raws.signed_below_bits(bits));
  }
}

TEST(Direction, ErrsLessThan0_51InTheLastPlace) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const int bits = 1 + static_cast<int>(raws.bits64() % 63);
    const std::int64_t v[3] = {raws.signed_below_bits(bits), raws.signed_below_bits(bits),
                               i % 101 == 0 ? k_min : raws.signed_below_bits(63)};
    const Real root =
        sqrt(Real(v[0]) * Real(v[0]) + Real(v[1]) * Real(v[1]) + Real(v[2]) * Real(v[2]));
    if (root.is_zero()) continue;
    const Vec3<Unit> unit = direction_of(v[0], v[1], v[2]);
    for (int axis = 0; axis < 3; ++axis) {
      worst = test::worst_of(worst, (Real(v[axis]) / root).error_of(unit[axis].raw, 30));
    }
  }
  EXPECT_LT(worst, 0.51);
  RecordProperty("worst_ulp", std::to_string(worst));
}

TEST(Direction, OfTinyZeroAndHugeVectorsIsExactOnTheAxes) {
  const Unit one = Unit::from_integer(1);
  for (int bit = 0; bit < 63; ++bit) {
    const std::int64_t size = std::int64_t{1} << bit;
    EXPECT_EQ(direction_of(0, 0, size), (Vec3<Unit>{{}, {}, one}));
    EXPECT_EQ(direction_of(-size, 0, 0), (Vec3<Unit>{-one, {}, {}}));
    EXPECT_EQ(direction_of(3 * (size >> 3), 4 * (size >> 3), 0).x.raw,
              bit < 3 ? 0 : 644245094);  // 0.6
  }
  EXPECT_EQ(direction_of(0, 0, 0), Vec3<Unit>{});
  EXPECT_EQ(direction_of(0, k_min, 0), (Vec3<Unit>{{}, -one, {}}));
}

TEST(Direction, MirrorsAndPermutesWithItsInputAndIgnoresScale) {
  Raws raws;
  for (int i = 0; i < test::share_of(300000); ++i) {
    const int bits = 1 + static_cast<int>(raws.bits64() % 63);
    const std::int64_t x = raws.signed_below_bits(bits), y = raws.signed_below_bits(bits),
                       z = raws.signed_below_bits(bits);
    const Vec3<Unit> u = direction_of(x, y, z);
    ASSERT_EQ(direction_of(-x, y, z), (Vec3<Unit>{-u.x, u.y, u.z}));
    ASSERT_EQ(direction_of(x, -y, -z), (Vec3<Unit>{u.x, -u.y, -u.z}));
    ASSERT_EQ(direction_of(y, z, x), (Vec3<Unit>{u.y, u.z, u.x}));
    ASSERT_EQ(direction_of(y, x, z), (Vec3<Unit>{u.y, u.x, u.z}));
    if (bits < 31) {
      ASSERT_EQ(direction_of(2 * x, 2 * y, 2 * z), u);
    }
  }
}

TEST(Normalized, QuaternionsOfEveryScaleGetNormOne) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const int bits = 31;
    const auto unit = [&] {
      return Unit::from_raw(static_cast<std::int32_t>(raws.signed_below_bits(bits)));
    };
    const Quat q = normalized({unit(), unit(), unit(), unit()});
    const Real square(static_cast<std::int64_t>(norm_squared(q)), 60);
    worst = test::worst_of(worst, (sqrt(square) - Real(1)).error_of(0, 30));
    const Quat flipped = normalized({-q.x, -q.y, -q.z, -q.w});
    const Quat again = normalized(q);
    ASSERT_EQ(flipped, (Quat{-again.x, -again.y, -again.z, -again.w}));
  }
  EXPECT_LE(worst, 1.01);  // 2^-30: half a last place in each of four components
  EXPECT_EQ(normalized(Quat{{}, {}, {}, {}}), Quat{});
  const Unit low = Unit::min(), half = Unit::from_ratio(1, 2);
  EXPECT_EQ(normalized(Quat{low, low, low, low}), (Quat{-half, -half, -half, -half}));
}

TEST(Normalized, NearUnitPathAgreesWithTheExactScaling) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const Vec3<Unit> d = direction_of(raws.any32(), raws.any32(), raws.any32());
    const auto off = [&](Unit u) {
      return Unit::from_raw(u.raw + static_cast<std::int32_t>(raws.signed_below_bits(10)));
    };
    const Quat q{off(d.x), off(d.y), off(d.z), off({})};
    const Real root = sqrt(Real(static_cast<std::int64_t>(norm_squared(q)), 60));
    const Quat n = normalized(q);
    worst = test::worst_of(worst, (Real(q.x.raw, 30) / root).error_of(n.x.raw, 30));
    worst = test::worst_of(worst, (Real(q.w.raw, 30) / root).error_of(n.w.raw, 30));
  }
  EXPECT_LT(worst, 0.51);
}

}  // namespace
}  // namespace lockstone
