// Tapered capsules in the world: at rest, rolling, on triangles, too fast for a tick, as parts.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/compound.h>

#include "core/geometry/shapes/tapered_ends.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/flat_terrain.h"
#include "tests/world/thin_wall.h"

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

TEST(TaperedCapsuleBodies, LieAndRollOnTrianglesAsOnABox) {
  for (const bool mesh : {true, false}) {
    World world = test::world_on_triangles(mesh);
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
    World world = test::world_on_triangles(mesh);
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
  test::expect_none_passes_a_thin_wall([](test::Random& random) {
    const Length height = test::bullet_size(random), bottom = test::bullet_size(random);
    return Shape::tapered_capsule(height, bottom, test::bullet_size(random));
  });
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
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0},
                                 std::make_shared<AssetSet>(std::vector{stool}));
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
