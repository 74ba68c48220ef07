#include "core/collision/narrow_phase/placed_shape.h"

#include <gtest/gtest.h>

#include <lockstone/hull.h>

#include "tests/geometry/assets/asset_parts.h"

namespace lockstone::test {
namespace {

AssetPtr random_hull(Dice& dice) {
  std::vector<Vec3<Length>> points(static_cast<std::size_t>(dice.between(4, 40)));
  for (Vec3<Length>& point : points)
    point = metres(dice.uniform(-2, 3), dice.uniform(-1, 1), dice.uniform(-0.3, 0.2));
  return Hull::build(points).hull;
}

// The bounds that the broad phase sees are the vertices' own, not that of a box about them.
TEST(WorldBox, OfAHullIsThatOfItsVertices) {
  Dice dice;
  int hulls = 0;
  for (int round = 0; round < 300; ++round) {
    const AssetPtr hull = random_hull(dice);
    if (hull == nullptr) continue;
    ++hulls;
    const Vec3<Position> origin =
        rounded<Position>(metres(dice.uniform(-9, 9), dice.uniform(-9, 9), dice.uniform(-9, 9)));
    const PlacedShape placed{hull->shape(), &hull->geometry(), origin,
                             to_matrix(dice.orientation()), origin};
    const WorldBox box = world_box(placed);
    WorldBox exact{origin, origin};
    bool first = true;
    for (const Vec3<Length>& vertex : hull->geometry().polytope()->vertices) {
      const Vec3<Position> at = origin + rotate(placed.rotation, rounded<Position>(vertex));
      for (int i = 0; i < 3; ++i) {
        exact.lower[i] = first ? at[i] : min(exact.lower[i], at[i]);
        exact.upper[i] = first ? at[i] : max(exact.upper[i], at[i]);
      }
      first = false;
    }
    for (int i = 0; i < 3; ++i) {
      constexpr Position k_about = Position::from_ratio(1, 100'000);
      ASSERT_LE(box.lower[i], exact.lower[i]) << "round " << round;
      ASSERT_GE(box.upper[i], exact.upper[i]) << "round " << round;
      ASSERT_GE(box.lower[i], exact.lower[i] - k_about) << "round " << round;
      ASSERT_LE(box.upper[i], exact.upper[i] + k_about) << "round " << round;
    }
  }
  EXPECT_GT(hulls, 250);
}

}  // namespace
}  // namespace lockstone::test
