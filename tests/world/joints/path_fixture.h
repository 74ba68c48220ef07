// Shared by the tests of paths and path joints.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/path.h>

namespace lockstone::test {

inline PathPoint path_point(double x, double y, double z) {
  const auto length = [](double v) {
    return Length::from_raw(static_cast<std::int32_t>(std::lround(v * 1048576)));
  };
  return {{length(x), length(y), length(z)}};
}

inline AssetPtr built_path(const std::vector<PathPoint>& points, bool closed) {
  const PathResult result = Path::build(points, closed);
  EXPECT_TRUE(result.ok()) << to_string(result.fault) << " at " << result.point;
  return result.path;
}

/// Level, about the origin, from x towards −z, y up.
inline AssetPtr circle(int count, double radius) {
  std::vector<PathPoint> points;
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * 3.14159265358979 * i / count;
    points.push_back(path_point(radius * std::cos(angle), 0, -radius * std::sin(angle)));
  }
  return built_path(points, true);
}

}  // namespace lockstone::test
