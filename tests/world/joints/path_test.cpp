// Paths: curves for joints.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/load_asset.h>
#include <lockstone/path.h>
#include <lockstone/testing/floating.h>

#include "tests/world/joints/path_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::circle;
using testing::to_double;

TEST(Paths, GoThroughTheirPoints) {
  const std::vector<PathPoint> points{{{0_m, 0_m, 0_m}},
                                      {{5_m, 1_m, 0_m}},
                                      {{9_m, 0_m, 4_m}},
                                      {{20_m, -3_m, 4_m}},
                                      {{21_m, -3_m, 5_m}}};
  const PathResult built = Path::build(points, false);
  ASSERT_TRUE(built.ok()) << to_string(built.fault);
  const double length = to_double(built.path->length());
  std::vector<double> nearest(points.size(), 1e9);
  for (int i = 0; i <= 20000; ++i) {
    const Transform at =
        built.path->at(Length::from_ratio(static_cast<int>(length * 50 * i), 1000000));
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double x = to_double(at.position.x) - to_double(points[k].position.x);
      const double y = to_double(at.position.y) - to_double(points[k].position.y);
      const double z = to_double(at.position.z) - to_double(points[k].position.z);
      nearest[k] = std::min(nearest[k], std::sqrt(x * x + y * y + z * z));
    }
  }
  for (std::size_t k = 0; k < points.size(); ++k)
    EXPECT_LT(nearest[k], 2e-3) << "point " << k;
}

// A spline through 32 points of a circle keeps to it within 5e-6 of its radius.
TEST(Paths, OfACircleAreNearlyOne) {
  const AssetPtr asset = circle(32, 10);
  const auto& path = static_cast<const Path&>(*asset);
  const double length = to_double(path.length());
  EXPECT_NEAR(length, 2 * 3.14159265358979 * 10, 1e-3);
  for (int i = 0; i < 1000; ++i) {
    const double s = 62.8 * i / 1000;
    const Transform at = path.at(Length::from_ratio(static_cast<int>(s * 1000), 1000));
    const double x = to_double(at.position.x), z = to_double(at.position.z);
    EXPECT_NEAR(std::hypot(x, z), 10, 5e-5);
    EXPECT_NEAR(std::remainder(std::atan2(-z, x) - s / 10, 6.283185307), 0, 1e-4);
    const Mat3 frame = to_matrix(at.orientation);
    EXPECT_NEAR(to_double(frame.z.y), 1, 1e-6);
    EXPECT_NEAR(to_double(frame.x.x), -std::sin(s / 10), 3e-4);
  }
}

// Along x and level: up, turned about x, to +z.
TEST(Paths, LeanToTheRightByTheirBanks) {
  std::vector<PathPoint> points;
  std::vector<Angle> banks;
  for (int i = 0; i < 17; ++i) {
    points.push_back(test::path_point(4 * i, 0, 0));
    banks.push_back(Angle::from_ratio(i - 4, 2));  // two radians to the left … six to the right
  }
  const PathResult built = Path::build(points, banks, false);
  ASSERT_TRUE(built.ok()) << to_string(built.fault);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double bank = to_double(banks[i]);
    const Mat3 frame = to_matrix(built.path->at(points[i].position.x).orientation);
    EXPECT_NEAR(to_double(frame.z.y), std::cos(bank), 2e-6) << i;
    EXPECT_NEAR(to_double(frame.z.z), std::sin(bank), 2e-6) << i;
    EXPECT_NEAR(to_double(frame.x.x), 1, 1e-6) << i;
  }
}

TEST(Paths, WithoutABankAreTheSame) {
  const AssetPtr level = circle(12, 3);
  const std::span<const PathPoint> points = static_cast<const Path&>(*level).points();
  const std::vector<Angle> none(points.size());
  EXPECT_EQ(Path::build(points, {}, true).path->id(), level->id());
  EXPECT_EQ(Path::build(points, none, true).path->id(), level->id());
  const std::vector<Angle> banked(points.size(), Angle(0.1_rad));
  EXPECT_NE(Path::build(points, banked, true).path->id(), level->id());
}

TEST(Paths, ComeBackFromTheirBytes) {
  const AssetPtr asset = circle(12, 3);
  const std::vector<std::byte> bytes = asset->canonical_bytes();
  const Result<AssetPtr> loaded = load_asset(bytes, AssetSet());
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded.value()->id(), asset->id());
  EXPECT_EQ(loaded.value()->kind(), ShapeKind::path);
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(load_asset(std::span(bytes).first(size), AssetSet()).ok());
}

TEST(Paths, AreRefusedWithTheReason) {
  const auto fault = [](std::vector<PathPoint> points, bool closed) {
    return Path::build(points, closed).fault;
  };
  EXPECT_EQ(fault({{}}, false), PathFault::too_few_points);
  EXPECT_EQ(fault({{}, {{1_m, {}, {}}}}, true), PathFault::too_few_points);
  EXPECT_EQ(fault({{}, {{0.001_m, {}, {}}}}, false), PathFault::chord_out_of_range);
  EXPECT_EQ(fault({{}, {{200_m, {}, {}}}}, false), PathFault::chord_out_of_range);
  EXPECT_EQ(fault({{}, {{{}, 5_m, {}}}}, false), PathFault::no_direction_up);
  EXPECT_EQ(fault({{}, {{600_m, {}, {}}}}, false), PathFault::chord_out_of_range);
  EXPECT_EQ(fault({{}, {{1_m, {}, {}}, {}}}, false), PathFault::no_direction_up);
  EXPECT_EQ(fault({{}, {{1_m, {}, {}}}, {{0.1_m, {}, {}}}}, false), PathFault::too_sharp);
  EXPECT_EQ(fault(std::vector<PathPoint>(5000), false), PathFault::too_many_points);
  std::vector<PathPoint> helix;
  for (int i = 0; i < 60; ++i)  // turns of 60 m of a helix
    helix.push_back(test::path_point(60 * std::cos(i), 2 * i, 60 * std::sin(i)));
  EXPECT_EQ(fault(helix, false), PathFault::too_long);
}

}  // namespace
}  // namespace lockstone
