// Convex hulls of random points.
#pragma once

#include <vector>

#include <lockstone/hull.h>

#include "tests/geometry/assets/asset_parts.h"

namespace lockstone::test {

/// The hull of `count` points in a box of these half lengths, m.
inline AssetPtr random_rock(Dice& dice, int count, double x, double y, double z) {
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < count; ++i)
    points.push_back(metres(dice.uniform(-x, x), dice.uniform(-y, y), dice.uniform(-z, z)));
  return Hull::build(points).hull;
}

}  // namespace lockstone::test
