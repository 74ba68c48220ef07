// Shapes fitted to points: all points inside, and little more.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/fit.h>
#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "tests/support/random.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;
using Points = std::vector<Vec3<Length>>;

constexpr double k_outside = 8e-6;

Vec3<Length> fit_point(double x, double y, double z) {
  const auto length = [](double v) {
    return Length::from_raw(static_cast<std::int32_t>(std::lround(v * 1048576)));
  };
  return {length(x), length(y), length(z)};
}

// In the frame of the shape, m.
std::array<double, 3> seen_from(const FittedShape& fitted, const Vec3<Length>& point) {
  const Mat3 axes = to_matrix(fitted.orientation);
  std::array<double, 3> local{};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      local[static_cast<std::size_t>(i)] +=
          to_double(axes.column(i)[k]) * (to_double(point[k]) - to_double(fitted.position[k]));
  return local;
}

// How far a point is outside: below 0 within.
double beyond(const FittedShape& fitted, const Vec3<Length>& point) {
  const auto [x, y, z] = seen_from(fitted, point);
  const auto size = [&](int axis) { return to_double(fitted.shape.size[axis]); };
  if (fitted.shape.kind == ShapeKind::sphere) return std::hypot(x, y, z) - size(0);
  if (fitted.shape.kind == ShapeKind::box)
    return std::max({std::abs(x) - size(0), std::abs(y) - size(1), std::abs(z) - size(2)});
  const double half = size(1), along = std::max(std::abs(y) - half, 0.0);
  return std::hypot(x, along, z) - size(0);
}

void expect_inside(const Result<FittedShape>& fitted, const Points& points) {
  ASSERT_TRUE(fitted.ok());
  for (const Vec3<Length>& point : points)
    ASSERT_LT(beyond(fitted.value(), point), k_outside);
}

double drawn(test::Random& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random.below(1000001)) / 1e6;
}

// A cloud of the given half extents, turned about z and moved.
Points cloud(test::Random& random, double x, double y, double z, double angle) {
  Points points;
  for (int i = 0; i < 300; ++i) {
    const double u = drawn(random, -1, 1) * x;
    const double v = drawn(random, -1, 1) * y;
    const double w = drawn(random, -1, 1) * z;
    points.push_back(fit_point(u * std::cos(angle) - v * std::sin(angle) + 3,
                               u * std::sin(angle) + v * std::cos(angle) - 2, w + 1));
  }
  return points;
}

TEST(Fit, HoldsAllPoints) {
  test::Random random(20261127);
  for (int round = 0; round < 60; ++round) {
    const double x = std::pow(10.0, drawn(random, -3, 2.2));
    const double y = std::pow(10.0, drawn(random, -3, 2.2));
    const double z = std::pow(10.0, drawn(random, -3, 2.2));
    const double angle = drawn(random, 0, 3.14);
    const Points points = cloud(random, x, y, z, angle);
    expect_inside(fit_sphere(points), points);
    expect_inside(fit_box(points), points);
    expect_inside(fit_capsule(points), points);
  }
}

TEST(Fit, FindsATurnedBox) {
  Points corners;
  for (int i = 0; i < 8; ++i) {
    const double x = i & 1 ? 2 : -2, y = i & 2 ? 0.5 : -0.5, z = i & 4 ? 1 : -1;
    corners.push_back(fit_point(x * std::cos(0.6) - y * std::sin(0.6) + 5,
                                x * std::sin(0.6) + y * std::cos(0.6), z));
  }
  const FittedShape box = fit_box(corners).value();
  std::array<double, 3> half{to_double(box.shape.size.x), to_double(box.shape.size.y),
                             to_double(box.shape.size.z)};
  std::ranges::sort(half);
  EXPECT_NEAR(half[0], 0.5, 2e-5);
  EXPECT_NEAR(half[1], 1, 2e-5);
  EXPECT_NEAR(half[2], 2, 2e-5);
  EXPECT_NEAR(to_double(box.position.x), 5, 1e-5);
}

// Points of a sphere of 3 m, and of a capsule of radius 0.4 m and half height 1.5 m along z.
TEST(Fit, FindsASphereAndACapsule) {
  Points sphere, capsule;
  for (int i = 0; i < 2000; ++i) {
    const double turn = 2.399963 * i, h = 1 - 2 * (i + 0.5) / 2000, r = std::sqrt(1 - h * h);
    const double x = r * std::cos(turn), y = r * std::sin(turn);
    sphere.push_back(fit_point(3 * x - 7, 3 * y, 3 * h + 1));
    capsule.push_back(fit_point(0.4 * x, 0.4 * y, 0.4 * h + (h > 0 ? 1.5 : -1.5)));
  }
  const FittedShape ball = fit_sphere(sphere).value();
  EXPECT_NEAR(to_double(ball.shape.size.x), 3, 0.06);
  EXPECT_NEAR(to_double(ball.position.x), -7, 0.1);
  const FittedShape pill = fit_capsule(capsule).value();
  EXPECT_NEAR(to_double(pill.shape.size.x), 0.4, 0.01);
  EXPECT_NEAR(to_double(pill.shape.size.y), 1.5, 0.02);
  expect_inside(fit_capsule(capsule), capsule);
}

TEST(Fit, RaisesSizesToTheLeast) {
  const Points one{fit_point(1, 2, 3)};
  for (const auto& fitted : {fit_sphere(one), fit_box(one), fit_capsule(one)}) {
    ASSERT_TRUE(fitted.ok());
    EXPECT_EQ(fitted.value().shape.size.x, k_min_shape_size);
    EXPECT_EQ(fitted.value().position, one[0]);
  }
}

TEST(Fit, RefusesPointsThatItCannotHold) {
  const Points far{{{}, {}, Length(513_m)}}, wide{{-512_m, {}, {}}, {512_m, {}, {}}};
  for (const Points& points : {Points{}, far, Points(k_max_fit_points + 1)}) {
    EXPECT_EQ(fit_sphere(points).status(), Status::invalid_argument);
    EXPECT_EQ(fit_box(points).status(), Status::invalid_argument);
    EXPECT_EQ(fit_capsule(points).status(), Status::invalid_argument);
  }
  EXPECT_EQ(fit_box(wide).status(), Status::invalid_argument);  // 512 m and the slack
}

}  // namespace
}  // namespace lockstone
