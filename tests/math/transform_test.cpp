#include <gtest/gtest.h>

#include <lockstone/transform.h>

#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::Raws;

Transform random_transform(Raws& raws) {
  const auto unit = [&] { return Unit::from_raw(raws.any32()); };
  const auto far = [&] { return Position::from_raw(raws.signed_below_bits(52)); };
  return {{far(), far(), far()}, normalized({unit(), unit(), unit(), unit()})};
}

void expect_near(const Vec3<Position>& a, const Vec3<Position>& b, std::int64_t tolerance) {
  for (int axis = 0; axis < 3; ++axis)
    ASSERT_NEAR(static_cast<double>(a[axis].raw - b[axis].raw), 0, static_cast<double>(tolerance));
}

TEST(Transform, IdentityChangesNothing) {
  Raws raws;
  const Transform t = random_transform(raws);
  EXPECT_EQ(apply({}, t.position), t.position);
  EXPECT_EQ(apply_inverse({}, t.position), t.position);
  EXPECT_EQ(compose({}, t).position, t.position);
  EXPECT_EQ(compose(t, {}).position, t.position);
}

TEST(Transform, QuarterTurnsAreExact) {
  const Unit half = Unit::from_raw(1 << 29);
  const auto raws = [](std::int64_t x, std::int64_t y, std::int64_t z) {
    return Vec3<Position>{Position::from_raw(x), Position::from_raw(y), Position::from_raw(z)};
  };
  const Vec3<Length> lengths{Length::from_raw(1), Length::from_raw(2), Length::from_raw(3)};
  const Transform turn{raws(5, 6, 7), {half, half, half, half}};  // x → y → z → x
  EXPECT_EQ(apply(turn, raws(1, 2, 3)), raws(8, 7, 9));
  EXPECT_EQ(apply(turn, lengths), raws(5 + (3 << 12), 6 + (1 << 12), 7 + (2 << 12)));
  EXPECT_EQ(apply_inverse(turn, raws(8, 7, 9)), raws(1, 2, 3));
  EXPECT_EQ(compose(turn, compose(turn, turn)).orientation,
            (Quat{{}, {}, {}, -Unit::from_integer(1)}));
}

// Points within 2^30 raw (¼ m): the matrix errs by 2^-30 per entry, so a few raws; a point 2^20 m
// away is off by 2^-30 of that.
TEST(Transform, InverseUndoesWithinTheMatrixError) {
  Raws raws;
  for (int i = 0; i < test::share_of(50000); ++i) {
    const Transform t = random_transform(raws);
    const auto near = [&] { return Position::from_raw(raws.signed_below_bits(30)); };
    const Vec3<Position> p{near(), near(), near()};
    expect_near(apply_inverse(t, apply(t, p)), p, 8);
    expect_near(apply(inverse(t), apply(t, p)), p, 1 << 25);
  }
}

TEST(Transform, ComposeAppliesTheSecondFirst) {
  Raws raws;
  for (int i = 0; i < test::share_of(50000); ++i) {
    const Transform a = random_transform(raws), b = random_transform(raws);
    const auto near = [&] { return Position::from_raw(raws.signed_below_bits(30)); };
    const Vec3<Position> p{near(), near(), near()};
    expect_near(apply(compose(a, b), p), apply(a, apply(b, p)), 1 << 4);
  }
}

TEST(Transform, RotationOfWidePositionsIsRoundedOnce) {
  Raws raws;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const Mat3 m = to_matrix(random_transform(raws).orientation);
    const auto far = [&] { return Position::from_raw(raws.signed_below_bits(60)); };
    const Vec3<Position> v{far(), far(), far()};
    const Vec3<Position> turned = rotate(m, v), back = rotate_inverse(m, v);
    for (int axis = 0; axis < 3; ++axis) {
      const auto exact = [&](auto entry) {
        return test::Real(entry(0).raw, 30) * test::Real(v.x.raw) +
               test::Real(entry(1).raw, 30) * test::Real(v.y.raw) +
               test::Real(entry(2).raw, 30) * test::Real(v.z.raw);
      };
      ASSERT_LE(exact([&](int j) { return m.column(j)[axis]; }).error_of(turned[axis].raw, 0), 0.5);
      ASSERT_LE(exact([&](int j) { return m.column(axis)[j]; }).error_of(back[axis].raw, 0), 0.5);
    }
  }
}

}  // namespace
}  // namespace lockstone
