// Rounded boxes in the world: stacked, rolling, on triangles, too fast for a tick, as parts, saved.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/flat_terrain.h"
#include "tests/world/thin_wall.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

const Shape k_die = Shape::rounded_box(0.4_m, 0.4_m, 0.4_m, 0.1_m);

TEST(RoundedBoxBodies, StandInAStack) {
  World world = test::make_world({.body_capacity = 16, .sleep_ms = 0});
  test::add_ground(world);
  std::vector<BodyHandle> dice;
  for (int i = 0; i < 6; ++i)
    dice.push_back(
        test::add(world, test::dynamic_body(k_die, {}, Position::from_ratio(1 + 2 * i, 2), {})));
  test::step(world, 1200);
  for (std::size_t i = 0; i < dice.size(); ++i) {
    const BodyView view = world.body(dice[i]);
    EXPECT_NEAR(metres(view.position.x), 0, 1e-3);
    EXPECT_NEAR(metres(view.position.y), 0.5 + static_cast<double>(i), 5e-3);
    EXPECT_NEAR(metres(view.position.z), 0, 1e-3);
  }
}

// Whose core is a needle: nearly a capsule, and it rolls as one.
TEST(RoundedBoxBodies, RollOnTheirEdgesAsCapsulesDo) {
  double way[2] = {};
  const Shape needle = Shape::rounded_box(k_min_shape_size, 0.5_m, k_min_shape_size, 0.3_m);
  for (const bool rounded : {false, true}) {
    World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
    BodyDef slope;
    slope.motion = MotionType::static_body;
    slope.shape = Shape::half_space();
    slope.orientation = from_axis_angle({{}, {}, Unit::from_integer(1)}, -0.2_rad);
    test::add(world, slope);
    const Shape shape = rounded ? needle : Shape::capsule(0.5_m, 0.3_m);
    BodyDef def = test::dynamic_body(shape, {}, 0.306_m, {});
    def.orientation = from_axis_angle({Unit::from_integer(1), {}, {}}, 1.5707963268_rad);
    const BodyHandle body = test::add(world, def);
    test::step(world, 120);
    way[rounded ? 1 : 0] = metres(world.position(body).x);
  }
  EXPECT_GT(way[0], 2);
  EXPECT_NEAR(way[1] / way[0], 1, 0.03);
}

TEST(RoundedBoxBodies, SlideOverTheSeamsOfTriangles) {
  for (const bool mesh : {true, false}) {
    World world = test::world_on_triangles(mesh);
    BodyDef def = test::dynamic_body(k_die, -2_m, 0.5_m, 0.1_m);
    def.material.friction = {};
    def.velocity.x = 1.5_mps;
    const BodyHandle body = test::add(world, def);
    for (int tick = 0; tick < 120; ++tick) {
      test::step(world, 1);
      ASSERT_NEAR(metres(world.position(body).y), 0.5, 2e-3) << mesh << " " << tick;
    }
    EXPECT_NEAR(metres(world.position(body).x), 1, 2e-3) << mesh;
    EXPECT_GT(to_matrix(world.body(body).orientation).y.y, 0.99999_r);
  }
}

TEST(RoundedBoxBodies, ComeToRestOnTriangles) {
  for (const bool mesh : {true, false}) {
    World world = test::world_on_triangles(mesh);
    test::Random random(test::run_seed());
    std::vector<BodyHandle> bodies;
    for (int i = 0; i < 12; ++i) {
      const auto length = [&] { return Length::from_ratio(random.between(5, 30), 100); };
      const Length x = length(), y = length(), z = length(), radius = length();
      BodyDef def = test::dynamic_body(
          Shape::rounded_box(x, y, z, radius), Position::from_ratio(i % 4 * 10 - 15, 10),
          Position::from_ratio(10 + i, 10), Position::from_ratio(i / 4 * 10 - 10, 10));
      def.orientation = from_axis_angle({Unit::from_integer(1), {}, {}},
                                        Angle::from_ratio(random.between(-300, 300), 100));
      def.material.rolling_resistance = Coefficient::from_ratio(1, 20);
      bodies.push_back(test::add(world, def));
    }
    test::step(world, 900);
    for (const BodyHandle body : bodies) {
      const BodyView view = world.body(body);
      const bool fell_off =
          metres(abs(view.position.x)) > 2.9 || metres(abs(view.position.z)) > 2.9;
      if (fell_off) continue;
      EXPECT_GT(metres(view.position.y), 0.09);
      EXPECT_LT(std::abs(test::metres_per_second(view.velocity.y)), 0.05);
    }
  }
}

TEST(RoundedBoxBodies, NonePassesAWallOfOneCentimetre) {
  test::expect_none_passes_a_thin_wall([](test::Random& random) {
    const Length x = test::bullet_size(random), y = test::bullet_size(random);
    const Length z = test::bullet_size(random), radius = test::bullet_size(random);
    return Shape::rounded_box(x, y, z, radius);
  });
}

// A table of a rounded board on two rounded walls stands on their eight corners.
TEST(RoundedBoxBodies, ArePartsOfCompounds) {
  std::array<CompoundChild, 3> children;
  children[0].shape = Shape::rounded_box(0.5_m, 0.04_m, 0.3_m, 0.01_m);
  children[0].position = {{}, 0.55_m, {}};
  for (std::size_t i = 1; i < 3; ++i) {
    children[i].shape = Shape::rounded_box(0.03_m, 0.48_m, 0.2_m, 0.02_m);
    children[i].position = {i == 1 ? -0.4_m : 0.4_m, {}, {}};
  }
  const auto table = Compound::build(children).compound;
  ASSERT_NE(table, nullptr);
  const auto again = Compound::from_bytes(table->canonical_bytes(), {});
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again.value()->id(), table->id());
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0},
                                 std::make_shared<AssetSet>(std::vector<AssetPtr>{table}));
  test::add_ground(world);
  const BodyHandle body = test::add(world, test::dynamic_body(table->shape(), {}, 0.6_m, {}));
  test::step(world, 600);
  EXPECT_NEAR(metres(world.position(body).y), 0.5, 1e-3);
  EXPECT_GT(to_matrix(world.body(body).orientation).y.y, 0.99999_r);
}

TEST(RoundedBoxBodies, AreFoundByQueries) {
  World world = test::make_world({.body_capacity = 8});
  BodyDef def = test::dynamic_body(k_die, {}, {}, {});
  def.motion = MotionType::static_body;
  const BodyHandle body = test::add(world, def);
  const RayHit hit = world.cast_ray({{}, -5_m, {}}, {{}, 10_m, {}});
  EXPECT_EQ(hit.body, body);
  EXPECT_NEAR(std::ldexp(static_cast<double>(hit.fraction.raw), -Unit::frac_bits), 0.45, 1e-6);
  // Beside the corner of the bounds the round corner leaves room.
  EXPECT_TRUE(world.cast_ray({0.49_m, -5_m, 0.49_m}, {{}, 10_m, {}}).body.is_null());
  BodyHandle found[2];
  const Position corner = Position::from_ratio(47, 100);
  EXPECT_EQ(world.overlap_sphere({corner, corner, corner}, 0.03_m, found), 1U);
  EXPECT_EQ(world.overlap_sphere({corner, corner, corner}, 0.02_m, found), 0U);
}

TEST(RoundedBoxBodies, AreSavedWithTheirRadius) {
  World world = test::make_world({.body_capacity = 8});
  test::add_ground(world);
  const BodyHandle body = test::add(world, test::dynamic_body(k_die, {}, 2_m, {}));
  test::step(world, 10);
  World loaded = test::make_world({.body_capacity = 8});
  ASSERT_EQ(loaded.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
            Status::ok);
  EXPECT_EQ(loaded.body(body).shape, k_die);
  EXPECT_EQ(loaded.body(body).shape.fourth_size(), 0.1_m);
  EXPECT_FALSE(loaded.find_fault()) << loaded.find_fault().what;
  test::step(world, 120);
  test::step(loaded, 120);
  EXPECT_EQ(loaded.hash().total, world.hash().total);
  const Shape rounder = Shape::rounded_box(0.4_m, 0.4_m, 0.4_m, 0.11_m);
  ASSERT_EQ(loaded.apply(SetShape{body, rounder, {}}), Status::ok);
  EXPECT_NE(loaded.hash().total, world.hash().total);
}

TEST(RoundedBoxBodies, AreRefusedByTheNameOfTheWrongSize) {
  World world = test::make_world({.body_capacity = 8});
  BodyDef def = test::dynamic_body(Shape::rounded_box(0.4_m, 0.4_m, 0.4_m, {}), {}, {}, {});
  EXPECT_FALSE(world.create_body(def).ok());
  EXPECT_EQ(world.explain(def).field, "body.shape.radius");
  def.shape = Shape::rounded_box(0.4_m, 510_m, 0.4_m, 3_m);
  EXPECT_FALSE(world.create_body(def).ok());
  EXPECT_EQ(world.explain(def).field, "body.shape.radius");
  def.shape = Shape::rounded_box({}, 0.4_m, 0.4_m, 0.1_m);
  EXPECT_EQ(world.explain(def).field, "body.shape.half_x");
}

// Rounded hulls ----------------------------------------------------------------------------------

AssetPtr rounded_test_hull(Length half, Length radius) {
  std::vector<Vec3<Length>> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(
        {(i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half, (i & 4) != 0 ? half : -half});
  return Hull::build(corners, HullOptions::rounded(radius)).hull;
}

World rounded_hull_world(const std::vector<AssetPtr>& assets) {
  const WorldDef def{.body_capacity = 64, .sleep_ms = 0};
  return test::make_world(def, std::make_shared<AssetSet>(assets));
}

TEST(RoundedHullBodies, StandInAStackAsRoundedBoxesDo) {
  const AssetPtr hull = rounded_test_hull(0.4_m, 0.1_m);
  World world = rounded_hull_world({hull});
  test::add_ground(world);
  std::vector<BodyHandle> dice;
  for (int i = 0; i < 5; ++i) {
    const Shape shape = i % 2 == 0 ? hull->shape() : k_die;
    dice.push_back(
        test::add(world, test::dynamic_body(shape, {}, Position::from_ratio(1 + 2 * i, 2), {})));
  }
  test::step(world, 900);
  for (std::size_t i = 0; i < dice.size(); ++i) {
    EXPECT_NEAR(metres(world.position(dice[i]).x), 0, 1e-3);
    EXPECT_NEAR(metres(world.position(dice[i]).y), 0.5 + static_cast<double>(i), 5e-3);
  }
}

TEST(RoundedHullBodies, ComeToRestOnTrianglesAndOnHulls) {
  const AssetPtr hull = rounded_test_hull(0.15_m, 0.1_m);
  std::vector<Vec3<Length>> points{
      {}, {0.4_m, {}, {}}, {{}, 0.3_m, {}}, {{}, {}, 0.3_m}, {0.2_m, 0.2_m, 0.2_m}};
  const AssetPtr stone = Hull::build(points, HullOptions::rounded(0.05_m)).hull;
  const AssetPtr mesh = test::flat_mesh();
  World world = rounded_hull_world({hull, stone, mesh});
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = mesh->shape();
  test::add(world, ground);
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 12; ++i) {
    const AssetPtr& asset = i % 2 == 0 ? hull : stone;
    BodyDef def = test::dynamic_body(asset->shape(), Position::from_ratio(i % 3 * 6 - 6, 10),
                                     Position::from_ratio(5 + 4 * i, 10),
                                     Position::from_ratio(i % 2 * 5, 10));
    def.material.rolling_resistance = Coefficient::from_ratio(1, 20);
    bodies.push_back(test::add(world, def));
  }
  test::step(world, 900);
  for (const BodyHandle body : bodies) {
    const BodyView view = world.body(body);
    if (metres(abs(view.position.x)) > 2.8 || metres(abs(view.position.z)) > 2.8) continue;
    EXPECT_GT(metres(view.position.y), 0.0);
    EXPECT_LT(std::abs(test::metres_per_second(view.velocity.y)), 0.05);
  }
}

TEST(RoundedHullBodies, NonePassesAWallOfOneCentimetre) {
  test::Random random(test::run_seed());
  const AssetPtr hull = rounded_test_hull(0.02_m, 0.02_m);
  for (int run = 0; run < test::share_of(300); ++run) {
    World world = rounded_hull_world({hull});
    BodyDef wall;
    wall.motion = MotionType::static_body;
    wall.shape = Shape::box(0.005_m, 20_m, 20_m);
    test::add(world, wall);
    BodyDef def = test::dynamic_body(hull->shape(), {}, {}, {});
    def.position.x.raw =
        -random.between(std::int64_t{1} << 30, std::int64_t{20} << 32) - (std::int64_t{1} << 31);
    def.velocity.x.raw = random.between(std::int64_t{20} << 32, std::int64_t{400} << 32);
    for (int axis = 0; axis < 3; ++axis)
      def.angular_velocity[axis].raw =
          random.between(-(std::int64_t{100} << 32), std::int64_t{100} << 32);
    const BodyHandle bullet = test::add(world, def);
    for (int tick = 0; tick < 30; ++tick) {
      test::step(world, 1);
      if (metres(abs(world.position(bullet).y)) > 19) break;
      ASSERT_LT(metres(world.position(bullet).x), 0.0) << "run " << run << " tick " << tick;
    }
  }
}

TEST(RoundedHullBodies, ArePartsOfCompoundsAndFoundByQueries) {
  const AssetPtr hull = rounded_test_hull(0.2_m, 0.1_m);
  std::array<CompoundChild, 2> children;
  for (std::size_t i = 0; i < 2; ++i) {
    children[i].shape = hull->shape();
    children[i].asset = hull;
    children[i].position = {i == 0 ? -0.5_m : 0.5_m, {}, {}};
  }
  const auto pair = Compound::build(children).compound;
  ASSERT_NE(pair, nullptr);
  World world = rounded_hull_world({hull, pair});
  test::add_ground(world);
  const BodyHandle body = test::add(world, test::dynamic_body(pair->shape(), {}, 0.5_m, {}));
  test::step(world, 300);
  EXPECT_NEAR(metres(world.position(body).y), 0.3, 1e-3);
  const RayHit hit = world.cast_ray({0.5_m, 5_m, {}}, {{}, -10_m, {}});
  EXPECT_EQ(hit.body, body);
  EXPECT_NEAR(metres(hit.point.y), 0.6, 2e-3);
  BodyHandle found[2];
  EXPECT_EQ(world.overlap_sphere({0.5_m, 0.67_m, {}}, 0.08_m, found), 1U);
  EXPECT_EQ(world.overlap_sphere({0.5_m, 0.67_m, {}}, 0.06_m, found), 0U);
}

}  // namespace
}  // namespace lockstone
