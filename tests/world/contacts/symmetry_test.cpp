// How far a symmetric scene leaves its symmetry: docs/explanation/solver.md, "Symmetry".

#include <cmath>

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

struct Aside {
  double x = 0, z = 0;  // µm

  [[nodiscard]] double size() const { return std::hypot(x, z); }
};

// How far a plate comes to rest from the middle of side × side static tiles of a metre on which it
// falls.
Aside dropped_on_tiles(int side, Position height) {
  World world =
      test::make_world({.body_capacity = 512, .pair_capacity = 8192, .contact_capacity = 4096});
  BodyDef tile;
  tile.motion = MotionType::static_body;
  tile.shape = Shape::box(0.5_m, 0.25_m, 0.5_m);
  for (int i = 0; i < side * side; ++i) {
    tile.position = {Position::from_ratio(2 * (i / side) - side + 1, 2), -0.25_m,
                     Position::from_ratio(2 * (i % side) - side + 1, 2)};
    test::add(world, tile);
  }
  const Shape shape = Shape::box(Length::from_ratio(side, 2), 0.1_m, Length::from_ratio(side, 2));
  const Position middle = height + Position(0.1_m);
  const BodyHandle plate = test::add(world, test::dynamic_body(shape, {}, middle, {}));
  for (int tick = 0; tick < 300 && !world.body(plate).is_asleep; ++tick)
    (void)world.step();
  EXPECT_TRUE(world.body(plate).is_asleep);
  const Vec3<Position> end = world.position(plate);
  return {test::metres(end.x) * 1e6, test::metres(end.z) * 1e6};
}

TEST(Symmetry, OfAPlateOnTilesIsKeptToATenthOfAMicrometre) {
  for (const int side : {1, 2, 6, 20}) {
    EXPECT_LT(dropped_on_tiles(side, 0.5_m).size(), 0.1) << side;
    EXPECT_LT(dropped_on_tiles(side, 0.1_m).size(), 0.1) << side;
    EXPECT_LT(dropped_on_tiles(side, {}).size(), 0.1) << side;
  }
}

}  // namespace
}  // namespace lockstone
