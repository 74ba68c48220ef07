// Boxes of half extents down to 0.1 mm: at rest, stacked, carrying others, too fast for a tick.
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/thin_wall.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::Random;

const Shape k_sheet = Shape::box(0.1_m, k_min_box_extent, 0.06_m);

BodyDef sheet_at(Position height, Angle angle = {}) {
  BodyDef def = test::dynamic_body(k_sheet, {}, height, {});
  def.orientation = from_axis_angle({Unit::from_ratio(8, 10), {}, Unit::from_ratio(6, 10)}, angle);
  return def;
}

TEST(ThinBoxes, FallAndRestOnEachOfTheirFloors) {
  for (const bool on_a_box : {false, true}) {
    for (const Angle angle : {Angle{}, Angle{0.5_rad}, Angle{1_rad}, Angle{1.5_rad}}) {
      World world = test::make_world({.body_capacity = 8});
      BodyDef floor;
      floor.motion = MotionType::static_body;
      floor.shape = on_a_box ? Shape::box(10_m, 1_m, 10_m) : Shape::half_space();
      floor.position.y = on_a_box ? Position::from_integer(-1) : Position{};
      test::add(world, floor);
      const BodyHandle sheet = test::add(world, sheet_at(0.5_m, angle));
      test::step(world, 600);
      EXPECT_TRUE(world.body(sheet).is_asleep) << angle.raw;
      EXPECT_NEAR(metres(world.position(sheet).y), 1e-4, 2e-5) << angle.raw;
    }
  }
}

TEST(ThinBoxes, LieInAStackOfFourMillimetres) {
  World world = test::make_world({.body_capacity = 32, .contact_capacity = 256});  // any two touch
  test::add_ground(world);
  std::vector<BodyHandle> sheets;
  for (int i = 0; i < 20; ++i)
    sheets.push_back(test::add(world, sheet_at(Position::from_ratio(1 + 2 * i, 10'000))));
  test::step(world, 600);
  for (std::size_t i = 0; i < sheets.size(); ++i) {
    const BodyView view = world.body(sheets[i]);
    EXPECT_TRUE(view.is_asleep);
    EXPECT_NEAR(metres(view.position.x), 0, 1e-3);
    EXPECT_NEAR(metres(view.position.y), 1e-4 * (1 + 2 * static_cast<double>(i)), 2e-4);
    EXPECT_TRUE(i == 0 || view.position.y > world.position(sheets[i - 1]).y);
  }
}

TEST(ThinBoxes, CarryTenCratesAsAShelf) {
  World world = test::make_world({.body_capacity = 16});
  BodyDef shelf;
  shelf.motion = MotionType::static_body;
  shelf.shape = Shape::box(0.5_m, k_min_box_extent, 0.5_m);
  test::add(world, shelf);
  std::vector<BodyHandle> crates;
  for (int i = 0; i < 10; ++i)
    crates.push_back(
        test::add(world, test::dynamic_body(Shape::box(0.1_m, 0.1_m, 0.1_m), {},
                                            Position::from_ratio(1001 + 2000 * i, 10'000), {})));
  test::step(world, 900);
  for (std::size_t i = 0; i < crates.size(); ++i) {
    EXPECT_TRUE(world.body(crates[i]).is_asleep);
    EXPECT_NEAR(metres(world.position(crates[i]).y), 0.1001 + 0.2 * static_cast<double>(i), 2e-3);
  }
}

Shape any_bullet(Random& random) {
  const Length a = test::bullet_size(random), b = test::bullet_size(random);
  const Length c = test::bullet_size(random);
  const std::array<Shape, 3> shapes{Shape::sphere(a), Shape::capsule(a, b), Shape::box(a, b, c)};
  return shapes[static_cast<std::size_t>(random.between(0, 2))];
}

Shape thin_bullet(Random& random) {
  const Length a = test::bullet_size(random), b = test::bullet_size(random);
  return Shape::box(a, k_min_box_extent, b);
}

TEST(ThinBoxes, LetNothingPassAsAWall) {
  test::expect_none_passes_a_thin_wall(any_bullet, k_min_box_extent);
}

TEST(ThinBoxes, PassNoWall) {
  test::expect_none_passes_a_thin_wall(thin_bullet);
  test::expect_none_passes_a_thin_wall(thin_bullet, k_min_box_extent);
}

}  // namespace
}  // namespace lockstone
