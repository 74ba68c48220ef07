// Tapered capsules in the world: at rest, rolling, on triangles, too fast for a tick, as parts.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/mesh.h>

#include "core/geometry/shapes/tapered_ends.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

const Shape k_club = Shape::tapered_capsule(1_m, 0.4_m, 0.2_m);

double fine_metres(geometry::Fine x) {
  return std::ldexp(static_cast<double>(x), -geometry::k_fine_bits);
}

struct Point {
  double x, y, z;
};

/// A point of the body's y axis.
Point on_axis(const BodyView& view, double height) {
  const Vec3<Unit> axis = to_matrix(view.orientation).y;
  const auto lane = [&](Position at, Unit a) {
    return metres(at) + height * std::ldexp(static_cast<double>(a.raw), -Unit::frac_bits);
  };
  return {lane(view.position.x, axis.x), lane(view.position.y, axis.y),
          lane(view.position.z, axis.z)};
}

double club_gap(const Point& a, const Point& b) {
  return std::hypot(a.x - b.x, a.y - b.y, a.z - b.z);
}

/// On its side on the plane y = 0, the thick end at the left.
BodyDef lying_club() {
  const double low = fine_metres(geometry::tapered_ends(k_club.size).low);
  const double tilt = std::asin(0.2);
  BodyDef def = test::dynamic_body(k_club, {}, {}, {});
  const double angle = -(std::acos(-1.0) / 2 + tilt);
  def.orientation = from_axis_angle(
      {{}, {}, Unit::from_integer(1)},
      Angle::from_raw(static_cast<std::int32_t>(std::lround(std::ldexp(angle, Angle::frac_bits)))));
  // The lower centre is 0.4 m high, and the axis falls towards the thin end.
  const double height = 0.4 + low * std::sin(tilt);
  def.position.y.raw = std::llround(std::ldexp(height, Position::frac_bits));
  return def;
}

// The line that touches the ground is along x: the body turns about it.
BodyDef rolling_club() {
  BodyDef def = lying_club();
  def.material.friction = Coefficient::from_integer(1);
  def.angular_velocity.x.raw = std::int64_t{1} << AngularVelocity::frac_bits;
  def.velocity.z.raw = std::llround(std::ldexp(metres(def.position.y), Velocity::frac_bits));
  return def;
}

TEST(TaperedCapsuleBodies, LieStillOnTheirSide) {
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
  test::add_ground(world);
  const BodyHandle body = test::add(world, lying_club());
  test::step(world, 30);
  const BodyView first = world.body(body);
  test::step(world, 1200);
  const BodyView last = world.body(body);
  EXPECT_LT(club_gap(on_axis(first, -1), on_axis(last, -1)), 1e-4);
  EXPECT_LT(club_gap(on_axis(first, 1), on_axis(last, 1)), 1e-4);
  EXPECT_NEAR(metres(last.position.y), metres(lying_club().position.y), 1e-4);
}

// The side is a part of a cone, whose apex stays where it is while the cone rolls around it.
TEST(TaperedCapsuleBodies, RollAroundTheirApex) {
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
  test::add_ground(world);
  const BodyDef def = rolling_club();
  const BodyHandle body = test::add(world, def);
  const double apex = fine_metres(geometry::tapered_ends(k_club.size).low) + 0.4 / 0.2;
  const Point start = on_axis(world.body(body), apex);
  EXPECT_NEAR(start.y, 0, 1e-3);
  double travelled = 0;
  Point before = on_axis(world.body(body), 0);
  for (int tick = 0; tick < 600; ++tick) {
    test::step(world, 1);
    const Point here = on_axis(world.body(body), 0);
    travelled += club_gap(here, before);
    before = here;
    ASSERT_LT(club_gap(on_axis(world.body(body), apex), start), 0.02) << tick;
  }
  EXPECT_NEAR(travelled, 10 * metres(def.position.y), 0.05);
}

AssetPtr flat_mesh() {
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  constexpr int k_cells = 12;
  for (int x = 0; x <= k_cells; ++x)
    for (int z = 0; z <= k_cells; ++z)
      vertices.push_back(
          {Length::from_ratio(x * 5 - 30, 10), {}, Length::from_ratio(z * 5 - 30, 10)});
  const auto at = [](int x, int z) { return static_cast<std::uint32_t>(x * (k_cells + 1) + z); };
  for (int x = 0; x < k_cells; ++x) {
    for (int z = 0; z < k_cells; ++z) {
      triangles.push_back({at(x, z), at(x, z + 1), at(x + 1, z)});
      triangles.push_back({at(x + 1, z), at(x, z + 1), at(x + 1, z + 1)});
    }
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

AssetPtr level_field() {
  const std::vector<Length> heights(13 * 13);
  HeightFieldDef def;
  def.columns = def.rows = 13;
  def.heights = heights;
  return HeightField::build(def).height_field;
}

/// A world with one static asset, whose middle is over the origin's axis.
World world_of_asset(const AssetPtr& asset, Position shift) {
  const WorldDef def{.body_capacity = 64, .sleep_ms = 0};
  World world =
      std::move(World::create(def, std::make_shared<AssetSet>(std::vector{asset}))).value();
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = asset->shape();
  ground.position = {-shift, {}, -shift};
  test::add(world, ground);
  return world;
}

TEST(TaperedCapsuleBodies, LieAndRollOnTrianglesAsOnABox) {
  for (const bool mesh : {true, false}) {
    World world = mesh ? world_of_asset(flat_mesh(), {}) : world_of_asset(level_field(), 6_m);
    const BodyDef def = rolling_club();
    const BodyHandle body = test::add(world, def);
    const double apex = fine_metres(geometry::tapered_ends(k_club.size).low) + 0.4 / 0.2;
    const Point start = on_axis(world.body(body), apex);
    for (int tick = 0; tick < 240; ++tick) {
      test::step(world, 1);
      ASSERT_NEAR(metres(world.position(body).y), metres(def.position.y), 2e-3)
          << mesh << " " << tick;
      ASSERT_LT(club_gap(on_axis(world.body(body), apex), start), 0.05) << mesh << " " << tick;
    }
  }
}

TEST(TaperedCapsuleBodies, ComeToRestOnTriangles) {
  for (const bool mesh : {true, false}) {
    World world = mesh ? world_of_asset(flat_mesh(), {}) : world_of_asset(level_field(), 6_m);
    test::Random random(test::run_seed());
    std::vector<BodyHandle> bodies;
    for (int i = 0; i < 12; ++i) {
      BodyDef def = test::dynamic_body(
          Shape::tapered_capsule(Length::from_ratio(random.between(20, 80), 100),
                                 Length::from_ratio(random.between(10, 30), 100),
                                 Length::from_ratio(random.between(10, 30), 100)),
          Position::from_ratio(i % 4 * 10 - 15, 10), Position::from_ratio(10 + i, 10),
          Position::from_ratio(i / 4 * 10 - 10, 10));
      def.orientation = from_axis_angle({Unit::from_integer(1), {}, {}},
                                        Angle::from_ratio(random.between(-300, 300), 100));
      def.material.rolling_resistance = Coefficient::from_ratio(1, 20);
      bodies.push_back(test::add(world, def));
    }
    test::step(world, 900);
    for (const BodyHandle body : bodies) {
      const BodyView view = world.body(body);
      EXPECT_GT(metres(view.position.y), 0.09);
      EXPECT_LT(std::abs(test::metres_per_second(view.velocity.y)), 0.05);
    }
  }
}

TEST(TaperedCapsuleBodies, NonePassesAWallOfOneCentimetre) {
  test::Random random(test::run_seed());
  for (int run = 0; run < test::share_of(600); ++run) {
    World world = test::make_world({.body_capacity = 16, .gravity = {}});
    BodyDef wall;
    wall.motion = MotionType::static_body;
    wall.shape = Shape::box(0.005_m, 20_m, 20_m);
    test::add(world, wall);
    const auto size = [&] {
      return Length::from_raw(static_cast<std::int32_t>(random.between(1 << 14, 1 << 17)));
    };
    const Length height = size(), bottom = size();
    BodyDef def = test::dynamic_body(Shape::tapered_capsule(height, bottom, size()), {}, {}, {});
    def.position.x.raw =
        -random.between(std::int64_t{1} << 30, std::int64_t{20} << 32) - (std::int64_t{1} << 31);
    def.velocity.x.raw = random.between(std::int64_t{20} << 32, std::int64_t{400} << 32);
    def.velocity.y.raw = random.between(-(std::int64_t{100} << 32), std::int64_t{100} << 32);
    for (int axis = 0; axis < 3; ++axis)
      def.angular_velocity[axis].raw =
          random.between(-(std::int64_t{100} << 32), std::int64_t{100} << 32);
    const BodyHandle bullet = test::add(world, def);
    for (int tick = 0; tick < 30; ++tick) {
      test::step(world, 1);
      const BodyView view = world.body(bullet);
      if (metres(abs(view.position.y)) > 19 || metres(abs(view.position.z)) > 19) break;
      ASSERT_LT(metres(view.position.x), 0.0) << "run " << run << " tick " << tick;
    }
  }
}

// Two clubs side by side are one body, which stands on its three lowest points or lies.
TEST(TaperedCapsuleBodies, ArePartsOfCompounds) {
  std::array<CompoundChild, 3> children;
  for (std::size_t i = 0; i < children.size(); ++i) {
    children[i].shape = Shape::tapered_capsule(0.6_m, 0.2_m, 0.1_m);
    children[i].position = {
        Length::from_ratio(static_cast<int>(i) - 1, 2), {}, i == 1 ? 0.5_m : Length{}};
  }
  const AssetPtr stool = Compound::build(children).compound;
  ASSERT_NE(stool, nullptr);
  World world = std::move(World::create({.body_capacity = 8, .sleep_ms = 0},
                                        std::make_shared<AssetSet>(std::vector{stool})))
                    .value();
  test::add_ground(world);
  const BodyHandle body = test::add(world, test::dynamic_body(stool->shape(), {}, 1_m, {}));
  test::step(world, 600);
  const double low = fine_metres(geometry::tapered_ends(children[0].shape.size).low);
  EXPECT_NEAR(metres(world.position(body).y), 0.2 - low, 1e-3);
  EXPECT_LT(std::abs(to_matrix(world.body(body).orientation).y.x.raw), 1 << 18);
}

TEST(TaperedCapsuleBodies, AreFoundByQueries) {
  World world = test::make_world({.body_capacity = 8});
  BodyDef def = test::dynamic_body(k_club, {}, {}, {});
  def.motion = MotionType::static_body;
  const BodyHandle body = test::add(world, def);
  const double low = fine_metres(geometry::tapered_ends(k_club.size).low);
  const RayHit hit = world.cast_ray({{}, -5_m, {}}, {{}, 10_m, {}});
  EXPECT_EQ(hit.body, body);
  EXPECT_NEAR(std::ldexp(static_cast<double>(hit.fraction.raw), -Unit::frac_bits),
              (5 + low - 0.4) / 10, 1e-6);
  BodyHandle found[2];
  const Position height = Position::from_raw(std::llround(std::ldexp(low, Position::frac_bits)));
  EXPECT_EQ(world.overlap_sphere({0.45_m, height, {}}, 0.06_m, found), 1U);
  EXPECT_EQ(world.overlap_sphere({0.47_m, height, {}}, 0.06_m, found), 0U);
}

}  // namespace
}  // namespace lockstone
