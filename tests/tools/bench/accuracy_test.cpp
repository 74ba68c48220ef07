// The rows of accuracy and their references.
#include "tools/bench/accuracy/accuracy.h"

#include <gtest/gtest.h>

#include <lockstone/literals.h>

#include "tools/bench/accuracy/reference_mass.h"
#include "tools/support/for_blocks.h"

namespace lockstone::bench {
namespace {

using namespace literals;

TEST(MassReference, OfABoxOfPointsIsThatOfTheShape) {
  const Shape shape = Shape::box(1_m, 2_m, 0.5_m);
  std::vector<Vec3<Length>> corners;
  for (int i = 0; i < 8; ++i) {
    corners.push_back(shape.size);
    for (int axis = 0; axis < 3; ++axis)
      if ((i >> axis & 1) != 0) corners.back()[axis] = -shape.size[axis];
  }
  corners.push_back({});
  corners.push_back({1_m, {}, {}});
  const MassReference points = mass_of_hull(corners), box = mass_of_primitive(shape);
  EXPECT_NEAR(static_cast<double>(points.volume), 8, 1e-15);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(static_cast<double>(points.centre[i]), 0, 1e-15);
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(static_cast<double>(points.second[i][j]), static_cast<double>(box.second[i][j]),
                  1e-15);
  }
}

TEST(MassReference, OfACompoundIsThatOfTheWhole) {
  std::vector<CompoundChild> halves(2);
  for (CompoundChild& half : halves)
    half.shape = Shape::box(0.5_m, 1_m, 1_m);
  halves[0].position.x = -0.5_m;
  halves[1].position.x = 0.5_m;
  const MassReference whole = mass_of_primitive(Shape::box(1_m, 1_m, 1_m));
  const MassReference sum = mass_of_compound(halves);
  EXPECT_NEAR(static_cast<double>(sum.volume), static_cast<double>(whole.volume), 1e-15);
  EXPECT_NEAR(static_cast<double>(sum.second[0][0]), static_cast<double>(whole.second[0][0]),
              1e-15);
}

TEST(Accuracy, CoversEveryTryOnce) {
  std::vector<int> seen(1000);
  tool::for_blocks(seen.size(), 64, 3, [&](std::uint64_t first, std::uint64_t count) {
    for (std::uint64_t i = first; i < first + count; ++i)
      ++seen[i];
  });
  EXPECT_EQ(seen, std::vector<int>(1000, 1));
}

// A sliver at 400 m/s and 15,000 rad/s that sinks in beside a rim of the sheet's triangles.
TEST(Accuracy, OnceTunnelledNoMore) {
  const auto results = measure_tunnels({.seed = 1, .tries = 1, .first = 69'914, .threads = 1});
  EXPECT_FALSE(results.empty());
  for (const AccuracyResult& result : results)
    EXPECT_EQ(result.worst, 0) << result.name;
}

TEST(Accuracy, OfHullsMeetsTheGoal) {
  int rows = 0;
  for (const AccuracyResult& result : measure_masses({.seed = 7, .tries = 100, .threads = 2})) {
    if (!result.name.starts_with("hulls")) continue;
    EXPECT_TRUE(result.met()) << result.name << " " << result.worst;
    ++rows;
  }
  EXPECT_GT(rows, 0);
}

TEST(Accuracy, OfQueriesMeetsTheGoalNearby) {
  int rows = 0;
  for (const AccuracyResult& result : measure_queries({.seed = 7, .tries = 5000, .threads = 2})) {
    EXPECT_GT(result.tries, 500U);
    if (!result.name.ends_with("within 20 m")) continue;
    EXPECT_TRUE(result.met()) << result.name << " " << result.worst;
    ++rows;
  }
  EXPECT_GT(rows, 0);
}

}  // namespace
}  // namespace lockstone::bench
