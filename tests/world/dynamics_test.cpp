// The motion of bodies: against closed forms, and in scenes that everybody knows.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

double speed_of(World& world, BodyHandle body) {
  const Vec3<Velocity> v = world.velocity(body);
  const auto value = [](Velocity x) { return static_cast<double>(x.raw) / 4294967296.0; };
  return std::hypot(value(v.x), value(v.y), value(v.z));
}

TEST(FreeFall, FollowsTheParabolaWithinAMicrometre) {
  World world = test::make_world();
  const BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), {}, {}, {}));
  test::step(world, 600);
  EXPECT_NEAR(metres(world.position(ball).y), -490.5, 1e-6);
}

TEST(FreeFlight, DriftsTheSameFarFromTheOrigin) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), 100000_m, {}, {});
  def.velocity.x = 1_mps;
  def.gravity_scale = {};
  const BodyHandle ball = test::add(world, def);
  test::step(world, 600);
  EXPECT_NEAR(metres(world.position(ball).x - 100000_m), 10.0, 1e-8);
}

TEST(FreeRotation, KeepsSpeedAndAxisOfASphere) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), {}, {}, {});
  def.gravity_scale = {};
  def.angular_velocity = {{}, 3_rps, {}};
  const BodyHandle ball = test::add(world, def);
  test::step(world, 60);
  const Quat q = world.body(ball).orientation;
  // Three radians about y: half angle 1.5.
  EXPECT_NEAR(static_cast<double>(q.y.raw) / 1073741824.0, std::sin(1.5), 1e-7);
  EXPECT_NEAR(static_cast<double>(q.w.raw) / 1073741824.0, std::cos(1.5), 1e-7);
}

void expect_stack_stands_for_a_minute(int count, double sunk, double aside) {
  World world = test::make_world({.body_capacity = 64, .sleep_ms = 0});
  test::add_ground(world);
  BodyHandle top;
  for (int i = 0; i < count; ++i) {
    top = test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {},
                                              Position::from_ratio(2 * i + 1, 2), {}));
  }
  test::step(world, test::share_of(3600));
  const Vec3<Position> at = world.position(top);
  EXPECT_NEAR(metres(at.x), 0.0, aside);
  EXPECT_NEAR(metres(at.z), 0.0, aside);
  EXPECT_NEAR(metres(at.y), count - 0.5, sunk);
  EXPECT_LT(speed_of(world, top), 1e-4);
}

TEST(Stack, OfTenBoxesStandsForAMinute) {
  expect_stack_stands_for_a_minute(10, 3e-4, 1e-6);
}

// All impulses of an island share one unit, 2^-27 of the greatest: the lowest box carries forty,
// and rounding turns it by 4e-9 rad a second.
TEST(Stack, OfFortyBoxesLosesNoMillimetreInAMinute) {
  expect_stack_stands_for_a_minute(40, 1e-3, 2e-5);
}

/// How far a box of a metre sinks at most in ten seconds on `legs` boxes of which it weighs `ratio`
/// times one, from `height` above them.
double sunk_on_light_boxes(int legs, int ratio, Position height) {
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
  test::add_ground(world);
  for (int i = 0; i < legs; ++i) {
    const Shape leg = Shape::box(0.5_m, 0.5_m, 0.5_m);
    const Position x = Position::from_integer(2 * i), z = Position::from_integer(i % 2 * 2);
    BodyDef light = test::dynamic_body(leg, legs == 1 ? Position{} : x, 0.5_m, z);
    light.material.density = Density::from_integer(1);
    test::add(world, light);
  }
  const Length half = legs == 1 ? Length(0.5_m) : Length(5_m);
  const Position x = Position::from_integer(legs - 1), z = legs == 1 ? Position{} : Position(1_m);
  BodyDef def = test::dynamic_body(Shape::box(half, 0.5_m, half), x, height + Position(1.5_m), z);
  def.material.density = Density::from_integer(legs == 1 ? ratio : ratio / 100);
  const BodyHandle heavy = test::add(world, def);
  double sunk = 0;
  for (int tick = 0; tick < 600; ++tick) {
    test::step(world, 1);
    sunk = std::max(sunk, 1.5 - metres(world.position(heavy).y));
  }
  EXPECT_LT(speed_of(world, heavy), 1e-4);
  return sunk;
}

TEST(Stack, OfFortyBoxesOutOfLineStands) {
  World world = test::make_world({.body_capacity = 64, .sleep_ms = 0});
  test::add_ground(world);
  std::vector<BodyHandle> boxes;
  for (int i = 0; i < 40; ++i) {
    const Position x = Position::from_ratio(i * 37 % 41 - 20, 5000);
    const Position z = Position::from_ratio(i * 23 % 41 - 20, 5000);
    boxes.push_back(test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), x,
                                                        Position::from_ratio(2 * i + 1, 2), z)));
  }
  const Vec3<Position> start = world.position(boxes.back());
  test::step(world, test::share_of(900));
  const Vec3<Position> end = world.position(boxes.back());
  EXPECT_NEAR(metres(end.x - start.x), 0.0, 1e-4);
  EXPECT_NEAR(metres(end.y - start.y), 0.0, 1e-3);
  EXPECT_NEAR(metres(end.z - start.z), 0.0, 1e-4);
}

TEST(Stack, CarriesTenThousandTimesItsWeight) {
  for (const int ratio : {10, 100, 1000, 10000})
    EXPECT_LT(sunk_on_light_boxes(1, ratio, {}), 1e-3) << ratio;
}

TEST(Stack, OfALightBoxWithstandsAFallOfAHeavyOne) {
  for (const int ratio : {10, 100, 1000})
    EXPECT_LT(sunk_on_light_boxes(1, ratio, 0.5_m), 0.005) << ratio;
}

TEST(Stack, OfLegsCarriesATableOfThousandTimesTheirWeight) {
  EXPECT_LT(sunk_on_light_boxes(4, 1000, {}), 1e-4);
}

TEST(Spin, OfABoxOnItsFaceEndsByFriction) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {});
  def.angular_velocity.y = 5_rps;
  const BodyHandle box = test::add(world, def);
  const auto turning = [&] {
    return static_cast<double>(world.body(box).angular_velocity.y.raw) / 4294967296.0;
  };
  // Four corners at √½ m: ω′ = −μg√½ / (1/6) = −20.8 /s².
  test::step(world, 12);
  EXPECT_NEAR(turning(), 5 - 20.8 * 12 / 60, 0.1);
  test::step(world, 12);
  EXPECT_NEAR(turning(), 0.0, 1e-5);
}

TEST(Capsule, WithFixedRotationStands) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::capsule(0.5_m, 0.3_m), {}, 0.8_m, {});
  def.fixed_rotation = true;
  const BodyHandle capsule = test::add(world, def);
  test::step(world, 600);
  EXPECT_NEAR(metres(world.position(capsule).y), 0.8, 0.01);
  EXPECT_EQ(world.body(capsule).orientation, Quat{});
  EXPECT_LT(speed_of(world, capsule), 1e-3);
}

TEST(Ball, RollsWithoutSlippingAfterAThrow) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), {}, 0.5_m, {});
  def.velocity.x = 7_mps;
  def.material.friction = 0.3_r;
  const BodyHandle ball = test::add(world, def);
  test::step(world, 120);
  const BodyView view = world.body(ball);
  const double v = static_cast<double>(view.velocity.x.raw) / 4294967296.0;
  const double w = static_cast<double>(view.angular_velocity.z.raw) / 4294967296.0;
  EXPECT_NEAR(v, 5.0, 0.02);  // 5/7 of the throw
  EXPECT_NEAR(w, -v / 0.5, 0.02);
}

TEST(Box, SlidesAsFarAsFrictionLets) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {});
  def.velocity.x = 5_mps;
  const BodyHandle box = test::add(world, def);
  test::step(world, 180);
  EXPECT_NEAR(metres(world.position(box).x), 25.0 / (2 * 0.5 * 9.81), 0.03);
  EXPECT_LT(speed_of(world, box), 1e-4);
}

TEST(Box, StaysOnASlopeBelowTheFrictionAngle) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {}));
  // Gravity tilted by 20°.
  ASSERT_EQ(world.apply(SetGravity{{3.355_mps2, -9.218_mps2, {}}}), Status::ok);
  test::step(world, 60);
  const double start = metres(world.position(box).x);
  test::step(world, 600);
  EXPECT_NEAR(metres(world.position(box).x), start, 1e-3);
}

TEST(Bounce, ReachesTheSquareOfTheRestitution) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::sphere(0.25_m), {}, 1.25_m, {});
  def.material.restitution = 0.8_r;
  const BodyHandle ball = test::add(world, def);
  double apex = 0;
  for (int tick = 0; tick < 70; ++tick) {
    (void)world.step();
    if (tick > 35) apex = std::max(apex, metres(world.position(ball).y) - 0.25);
  }
  EXPECT_NEAR(apex, 0.64, 0.05);
}

TEST(Collision, ConservesMomentumExactlyBetweenEqualMasses) {
  World world = test::make_world();
  std::vector<BodyHandle> balls;
  for (int i = 0; i < 60; ++i) {
    BodyDef def =
        test::dynamic_body(Shape::sphere(0.3_m), Position::from_ratio(i % 4, 2),
                           Position::from_ratio(i / 4 % 4, 2), Position::from_ratio(i / 16, 2));
    def.gravity_scale = {};
    def.velocity = {Velocity::from_ratio(i % 7 - 3, 2), Velocity::from_ratio(i % 5 - 2, 2),
                    Velocity::from_ratio(i % 3 - 1, 2)};
    balls.push_back(test::add(world, def));
  }
  const auto momentum = [&] {
    Vec3<Velocity> sum;
    for (const BodyHandle ball : balls)
      sum += world.velocity(ball);
    return sum;
  };
  const Vec3<Velocity> before = momentum();
  test::step(world, 300);
  EXPECT_EQ(momentum(), before);
}

TEST(Collision, MirroredSceneGivesTheMirroredResult) {
  const auto run = [](int sign) {
    World world = test::make_world();
    test::add_ground(world);
    std::vector<BodyHandle> balls;
    for (int i = 0; i < 12; ++i) {
      BodyDef def =
          test::dynamic_body(Shape::sphere(0.3_m), Position::from_ratio(sign * (i % 3), 3),
                             Position::from_ratio(3 + 2 * i, 4), Position::from_ratio(i % 2, 5));
      def.velocity = {Velocity::from_ratio(sign * (i % 5), 3), {}, {}};
      balls.push_back(test::add(world, def));
    }
    test::step(world, 120);
    std::vector<Vec3<Position>> result;
    for (const BodyHandle ball : balls) {
      Vec3<Position> at = world.position(ball);
      if (sign < 0) at.x = -at.x;
      result.push_back(at);
    }
    return result;
  };
  EXPECT_EQ(run(1), run(-1));
}

TEST(World, IsTheSameAnywhere) {
  const auto run = [](Position east) {
    World world = test::make_world();
    BodyDef ground;
    ground.motion = MotionType::static_body;
    ground.shape = Shape::box(50_m, 1_m, 50_m);
    ground.position = {east, -1_m, {}};
    test::add(world, ground);
    BodyHandle last;
    for (int i = 0; i < 8; ++i) {
      BodyDef def =
          test::dynamic_body(Shape::box(0.4_m, 0.3_m, 0.5_m), east + Position::from_ratio(i, 10),
                             Position::from_ratio(4 + 7 * i, 10), {});
      def.orientation = {0.1_r, 0.2_r, 0.1_r, 0.9_r};
      last = test::add(world, def);
    }
    test::step(world, 200);
    Vec3<Position> at = world.position(last);
    at.x -= east;
    return at;
  };
  const Vec3<Position> here = run({});
  EXPECT_EQ(run(1000_m), here);
  EXPECT_EQ(run(-900000_m), here);
}

TEST(World, ReportsPairsThatDoNotFitAndStaysDeterministic) {
  const auto run = [] {
    World world =
        test::make_world({.body_capacity = 64, .pair_capacity = 100, .contact_capacity = 50});
    for (int i = 0; i < 60; ++i) {
      test::add(world,
                test::dynamic_body(Shape::sphere(0.5_m), Position::from_ratio(i, 100), {}, {}));
    }
    const StepReport report = world.step();
    EXPECT_EQ(report.status, Status::capacity_exhausted);
    EXPECT_EQ(report.contacts, 50U);
    test::step(world, 20);
    return world.hash().total;
  };
  EXPECT_EQ(run(), run());
}

TEST(World, KeepsBodiesInsideItsLimit) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), 1048570_m, {}, {});
  def.velocity.x = 500_mps;
  def.gravity_scale = {};
  const BodyHandle ball = test::add(world, def);
  test::step(world, 10);
  EXPECT_EQ(world.position(ball).x, k_world_limit);
  EXPECT_EQ(world.velocity(ball).x, Velocity{});
}

TEST(Kinematic, CarriesABoxOnTop) {
  World world = test::make_world();
  BodyDef platform;
  platform.motion = MotionType::kinematic;
  platform.shape = Shape::box(2_m, 0.25_m, 2_m);
  platform.velocity.x = 1_mps;
  const BodyHandle floor = test::add(world, platform);
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.4_m, 0.4_m, 0.4_m), {}, 0.65_m, {}));
  test::step(world, 300);
  EXPECT_NEAR(metres(world.position(floor).x), 5.0, 1e-6);
  EXPECT_NEAR(metres(world.position(box).x), 5.0 - 1.0 / (2 * 0.5 * 9.81), 0.005);  // slips first
  EXPECT_NEAR(metres(world.position(box).y), 0.65, 0.02);
}

}  // namespace
}  // namespace lockstone
