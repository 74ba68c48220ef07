#include "core/math/trig.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/math/roots.h"
#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::Raws;
using test::Real;
using test::worst_of;

RotationVector rotation_vector(std::int64_t x, std::int64_t y, std::int64_t z) {
  using T = RotationComponent;
  return {T::from_raw(x), T::from_raw(y), T::from_raw(z)};
}

double worst_component(const Quat& q, const Real (&expected)[4]) {
  double worst = expected[0].error_of(q.x.raw, 30);
  worst = worst_of(worst, expected[1].error_of(q.y.raw, 30));
  worst = worst_of(worst, expected[2].error_of(q.z.raw, 30));
  return worst_of(worst, expected[3].error_of(q.w.raw, 30));
}

double error_of_rotation(const RotationVector& v) {
  const Real x(v.x.raw, 32), y(v.y.raw, 32), z(v.z.raw, 32);
  const Real angle = sqrt(x * x + y * y + z * z);
  if (angle.is_zero()) return rotation_from_vector(v) == Quat{} ? 0 : 1e9;
  const Real half = angle / Real(2);
  const Real factor = sin(half) / angle;
  return worst_component(rotation_from_vector(v), {x * factor, y * factor, z * factor, cos(half)});
}

TEST(SinCos, ErrsLessThanOneLastPlace) {
  Raws raws;
  double worst = 0;
  for (std::int64_t raw = -(std::int64_t{1} << 31); raw < std::int64_t{1} << 31;
       raw += 42937 * test::k_share) {
    const Angle x = Angle::from_raw(static_cast<std::int32_t>(raw));
    const SinCos ours = sin_cos(x);
    worst = worst_of(worst, sin(Real(raw, 27)).error_of(ours.sin.raw, 30));
    worst = worst_of(worst, cos(Real(raw, 27)).error_of(ours.cos.raw, 30));
  }
  EXPECT_LT(worst, 0.8);
  RecordProperty("worst_ulp", std::to_string(worst));
}

TEST(SinCos, IsOddAndEvenExactly) {
  for (std::int64_t raw = 0; raw < std::int64_t{1} << 31; raw += 1021) {
    const SinCos plus = sin_cos(Angle::from_raw(static_cast<std::int32_t>(raw)));
    const SinCos minus = sin_cos(Angle::from_raw(static_cast<std::int32_t>(-raw)));
    ASSERT_EQ(minus.sin, -plus.sin);
    ASSERT_EQ(minus.cos, plus.cos);
  }
  EXPECT_EQ(sin_cos({}).sin, Unit{});
  EXPECT_EQ(sin_cos({}).cos, Unit::from_integer(1));
}

TEST(Atan2, ErrsLittleMoreThanHalfALastPlaceAtEveryScale) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const std::int64_t y = raws.signed_below_bits(i % 2 == 0 ? 31 : 63);
    const std::int64_t x = raws.signed_below_bits(i % 3 == 0 ? 31 : 63);
    if (x == 0 && y == 0) continue;
    worst = worst_of(worst, atan2(Real(y), Real(x)).error_of(atan2_raw(y, x).raw, 27));
  }
  EXPECT_LT(worst, 0.51);
  RecordProperty("worst_ulp", std::to_string(worst));
}

TEST(Atan2, KnowsTheAxesAndIsOddInY) {
  constexpr std::int32_t pi = 421657428;  // ⌊π · 2^27⌉
  EXPECT_EQ(atan2_raw(0, 0).raw, 0);
  EXPECT_EQ(atan2_raw(0, 5).raw, 0);
  EXPECT_EQ(atan2_raw(0, -5).raw, pi);
  EXPECT_EQ(atan2_raw(7, 0).raw, pi / 2);
  EXPECT_EQ(atan2_raw(-7, 0).raw, -pi / 2);
  EXPECT_EQ(atan2_raw(std::numeric_limits<std::int64_t>::min(), 0).raw, -pi / 2);
  Raws raws;
  for (int i = 0; i < test::share_of(200000); ++i) {
    const std::int64_t y = raws.signed_below_bits(63) | 1, x = raws.signed_below_bits(63);
    ASSERT_EQ(atan2_raw(-y, x), -atan2_raw(y, x));
  }
}

TEST(ArcSineAndCosine, ErrLessThanOneLastPlace) {
  Raws raws;
  double worst = 0;
  for (std::int64_t i = -(std::int64_t{1} << 30); i <= std::int64_t{1} << 30;
       i += 42949 * test::k_share) {
    const std::int64_t near_one = (std::int64_t{1} << 30) - (i & 0xffff);
    for (const std::int64_t raw : {i, near_one}) {
      const Unit x = Unit::from_raw(static_cast<std::int32_t>(raw));
      worst = worst_of(worst, asin(Real(raw, 30)).error_of(asin(x).raw, 27));
      worst = worst_of(worst, acos(Real(raw, 30)).error_of(acos(x).raw, 27));
      ASSERT_EQ(asin(-x), -asin(x));
    }
  }
  EXPECT_LT(worst, 0.6);
  EXPECT_EQ(acos(Unit::max()), Angle{});
}

TEST(RotationFromVector, SmallVectorsErrLessThanOneLastPlace) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(40000); ++i) {
    const int bits = 1 + static_cast<int>(raws.bits64() % 31);
    worst = worst_of(worst, error_of_rotation(rotation_vector(raws.signed_below_bits(bits),
                                                              raws.signed_below_bits(bits),
                                                              raws.signed_below_bits(bits - 1))));
  }
  EXPECT_LT(worst, 1.5);
  RecordProperty("worst_ulp", std::to_string(worst));
}

TEST(RotationFromVector, LargeVectorsErrLessThanTwoLastPlaces) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(40000); ++i) {
    const int bits = 31 + static_cast<int>(raws.bits64() % 33);
    worst = worst_of(worst, error_of_rotation(rotation_vector(raws.signed_below_bits(bits),
                                                              raws.signed_below_bits(bits),
                                                              raws.signed_below_bits(bits))));
  }
  EXPECT_LT(worst, 2.0);
  RecordProperty("worst_ulp", std::to_string(worst));
}

TEST(RotationFromVector, FlipsMirrorsAndPermutesExactly) {
  Raws raws;
  for (int i = 0; i < test::share_of(300000); ++i) {
    const int bits = 1 + static_cast<int>(raws.bits64() % 63);
    const std::int64_t x = raws.signed_below_bits(bits), y = raws.signed_below_bits(bits),
                       z = raws.signed_below_bits(bits);
    const Quat q = rotation_from_vector(rotation_vector(x, y, z));
    ASSERT_EQ(rotation_from_vector(rotation_vector(-x, -y, -z)), conjugate(q));
    ASSERT_EQ(rotation_from_vector(rotation_vector(-x, y, z)), (Quat{-q.x, q.y, q.z, q.w}));
    ASSERT_EQ(rotation_from_vector(rotation_vector(z, x, y)), (Quat{q.z, q.x, q.y, q.w}));
  }
  const std::int64_t low = std::numeric_limits<std::int64_t>::min();
  const Quat extreme = rotation_from_vector(rotation_vector(low, low, low));
  EXPECT_EQ(extreme.x, extreme.y);
  EXPECT_EQ(rotation_from_vector({}), Quat{});
}

TEST(FromAxisAngle, ErrsLessThanTwoLastPlaces) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(30000); ++i) {
    const Vec3<Unit> axis = direction_of(raws.any32(), raws.any32(), raws.any32());
    const Angle angle = Angle::from_raw(raws.any32());
    const Real half = Real(angle.raw, 28);
    const Real s = sin(half);
    worst = worst_of(worst, worst_component(from_axis_angle(axis, angle),
                                            {Real(axis.x.raw, 30) * s, Real(axis.y.raw, 30) * s,
                                             Real(axis.z.raw, 30) * s, cos(half)}));
  }
  EXPECT_LT(worst, 1.5);  // one of the sine and half of the product's rounding
}

TEST(Integrate, ReturnsTheSameBitsForNoRotation) {
  const Quat q{Unit::from_raw(5), Unit::from_raw(-7), Unit::from_raw(1 << 29), Unit::from_raw(3)};
  EXPECT_EQ(integrate(q, {}), q);
}

// A world-frame spin about one axis for a million steps, from a tilted start: the exact end is
// exp(N·θ/2) · start.
TEST(Integrate, DriftsLittleOverAMillionSteps) {
  constexpr int steps = 1000000;
  const RotationVector theta = rotation_vector(123456789, -98765432, 55555555);  // 0.04 rad
  const Quat start = normalized({Unit::from_raw(300000000), Unit::from_raw(-500000000),
                                 Unit::from_raw(100000000), Unit::from_raw(700000000)});
  Quat q = start;
  double worst_norm = 0;
  for (int i = 0; i < steps; ++i) {
    q = integrate(q, theta);
    const double excess = static_cast<double>(norm_squared(q)) * 0x1p-60 - 1;
    worst_norm = worst_of(worst_norm, std::abs(excess) / 2);
  }
  EXPECT_LE(worst_norm, 0x1.04p-30);

  const Real x(theta.x.raw, 32), y(theta.y.raw, 32), z(theta.z.raw, 32);
  const Real angle = sqrt(x * x + y * y + z * z);
  const Real half = angle * Real(steps) / Real(2);
  const Real f = sin(half) / angle, rw = cos(half);
  const Real rx = x * f, ry = y * f, rz = z * f;
  const Real sx(start.x.raw, 30), sy(start.y.raw, 30), sz(start.z.raw, 30), sw(start.w.raw, 30);
  const double drift = worst_component(
      q, {rw * sx + rx * sw + ry * sz - rz * sy, rw * sy - rx * sz + ry * sw + rz * sx,
          rw * sz + rx * sy - ry * sx + rz * sw, rw * sw - rx * sx - ry * sy - rz * sz});
  std::printf("drift after %d steps: %.3g in a component, norm off by at most %.3g\n", steps,
              drift * 0x1p-30, worst_norm);
  EXPECT_LT(drift * 0x1p-30, 2e-4);
}

// Of hundreds of roundings the turn's length is off by up to 2^-22; the orientation's is not.
TEST(Integrate, MakesATurnOfManyRoundingsAUnitAgain) {
  Raws raws;
  double worst = 0;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const auto unit = [&] {
      return Unit::from_raw(static_cast<std::int32_t>(raws.signed_below_bits(30)));
    };
    const Unit x = unit(), y = unit(), z = unit();
    const Quat q = normalized({x, y, z, Unit::from_raw(1 << 29)});
    const FineQuat off{{raws.signed_below_bits(9), raws.signed_below_bits(9), 0},
                       (std::int64_t{1} << 31) + raws.signed_below_bits(9)};
    const RotationVector theta = rotation_vector(raws.signed_below_bits(30), 0, 0);
    const double excess = static_cast<double>(norm_squared(integrate(q, theta, off))) * 0x1p-60 - 1;
    worst = worst_of(worst, std::abs(excess) / 2);
  }
  EXPECT_LE(worst, 0x1.8p-30);
}

TEST(Integrate, MirroredMotionStaysMirrored) {
  Quat q, mirrored;
  Raws raws;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const std::int64_t x = raws.signed_below_bits(30), y = raws.signed_below_bits(30),
                       z = raws.signed_below_bits(30);
    q = integrate(q, rotation_vector(x, y, z));
    mirrored = integrate(mirrored, rotation_vector(x, -y, -z));  // in the plane x = 0
    ASSERT_EQ(mirrored, (Quat{q.x, -q.y, -q.z, q.w}));
  }
}

}  // namespace
}  // namespace lockstone
