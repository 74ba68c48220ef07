// Surfaces: combine rules, rolling resistance, surfaces that move in place, tags.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/testing/floating.h>

#include "core/dynamics/state/surface.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

TEST(CombineRules, GiveOnePropertyOfTwo) {
  Surface a{0.25_r, 0.25_r, 0.25_r}, b{1_r, 1_r, 1_r};
  EXPECT_EQ(combined_friction(a, b), Coefficient(0.5_r));
  EXPECT_EQ(combined_restitution(a, b), Coefficient(1_r));
  EXPECT_EQ(combined_rolling(a, b), Coefficient(1_r));
  const auto with = [&](CombineRule rule) {
    a.friction_rule = rule;
    return combined_friction(a, b);
  };
  EXPECT_EQ(with(CombineRule::average), Coefficient(0.625_r));
  EXPECT_EQ(with(CombineRule::geometric_mean), Coefficient(0.5_r));
  EXPECT_EQ(with(CombineRule::minimum), Coefficient(0.25_r));
  EXPECT_EQ(with(CombineRule::multiply), Coefficient(0.25_r));
  EXPECT_EQ(with(CombineRule::maximum), Coefficient(1_r));
}

TEST(CombineRules, TheLaterOfTheListDecidesFromEitherSide) {
  Surface a{0.25_r}, b{1_r};
  a.friction_rule = CombineRule::minimum;
  b.friction_rule = CombineRule::average;
  EXPECT_EQ(combined_friction(a, b), Coefficient(0.25_r));
  EXPECT_EQ(combined_friction(b, a), Coefficient(0.25_r));
  b.friction_rule = CombineRule::maximum;
  EXPECT_EQ(combined_friction(a, b), Coefficient(1_r));
}

TEST(CombineRules, AProductSaturates) {
  Surface a{1.99_r};
  a.friction_rule = CombineRule::multiply;
  EXPECT_EQ(combined_friction(a, a), Coefficient::max());
}

// How far a ball goes that starts to roll at 2 m/s, after some seconds.
double rolled(Coefficient resistance, int ticks) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef ball = test::dynamic_body(Shape::sphere(0.25_m), 0_m, 0.25_m, 0_m);
  ball.material.rolling_resistance = resistance;
  ball.velocity = {2_mps, {}, {}};
  ball.angular_velocity = {{}, {}, -8_rps};
  const BodyHandle handle = test::add(world, ball);
  test::step(world, ticks);
  return to_double(world.position(handle).x);
}

TEST(RollingResistance, StopsABallWhereTheTorqueSays) {
  // a = C·g / (1 + 2/5)
  const double deceleration = 0.05 * 9.81 / 1.4;
  EXPECT_NEAR(rolled(0.05_r, 420), 2 * 2 / (2 * deceleration), 0.03);
}

TEST(RollingResistance, IsNoneUnlessAskedFor) {
  EXPECT_NEAR(rolled(Coefficient{}, 420), 14, 0.01);
}

// A ball on a slope of 0.1 rad, gravity turned.
double crept(Coefficient resistance) {
  WorldDef def{.body_capacity = 8, .pair_capacity = 64, .contact_capacity = 64};
  def.gravity = {0.979_mps2, -9.76_mps2, {}};
  World world = test::make_world(def);
  test::add_ground(world);
  BodyDef ball = test::dynamic_body(Shape::sphere(0.25_m), 0_m, 0.25_m, 0_m);
  ball.material.rolling_resistance = resistance;
  const BodyHandle handle = test::add(world, ball);
  test::step(world, 300);
  return to_double(world.position(handle).x);
}

TEST(RollingResistance, HoldsABallOnASlopeBelowItsCoefficient) {
  EXPECT_LT(std::abs(crept(0.12_r)), 1e-3);
  EXPECT_GT(crept(0.08_r), 0.1);
}

TEST(SurfaceMotion, ABeltCarriesBodiesOnIt) {
  World world = test::make_world();
  BodyDef belt;
  belt.motion = MotionType::static_body;
  belt.shape = Shape::box(20_m, 0.5_m, 2_m);
  belt.position = {{}, -0.5_m, {}};
  belt.orientation =
      from_axis_angle({{}, Unit::from_integer(1), {}}, Angle::from_ratio(157079633, 100000000));
  belt.surface_motion.velocity = {3_mps, {}, {}};  // along the belt's own x: the world's −z
  test::add(world, belt);
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), 0_m, 0.5_m, 0_m));
  test::step(world, 120);
  const Vec3<Velocity> v = world.velocity(box);
  EXPECT_NEAR(to_double(v.z), -3, 1e-4);
  EXPECT_NEAR(to_double(v.x), 0, 1e-4);
  // Accelerated by μg up to the belt's speed, then carried.
  const double meanwhile = 3 / (0.5 * 9.81);
  EXPECT_NEAR(to_double(world.position(box).z), -(3 * 2 - 3 * meanwhile / 2), 0.02);
}

TEST(SurfaceMotion, IsNotForDynamicBodies) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::sphere(0.25_m), 0_m, 1_m, 0_m);
  const BodyHandle body = test::add(world, def);
  EXPECT_EQ(world.apply(SetSurfaceMotion{body, {}}), Status::invalid_argument);
  def.surface_motion.turning = {{}, 1_rps, {}};
  EXPECT_EQ(world.create_body(def).status(), Status::invalid_argument);
}

TEST(SurfaceMotion, ATurntableTurnsABodyAtItsCentre) {
  World world = test::make_world();
  BodyDef table;
  table.motion = MotionType::static_body;
  table.shape = Shape::box(5_m, 0.5_m, 5_m);
  table.position = {{}, -0.5_m, {}};
  table.surface_motion.turning = {{}, 2_rps, {}};
  test::add(world, table);
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), 0_m, 0.5_m, 0_m));
  test::step(world, 120);
  EXPECT_NEAR(to_double(world.body(box).angular_velocity.y), 2, 1e-3);
}

// For 4π s at 1 m: at 1 rad/s the tangent of each tick alone would lead outwards by 0.1 m.
void expect_to_ride_at_its_radius(bool is_kinematic, int rate) {
  World world = test::make_world();
  BodyDef table;
  table.motion = is_kinematic ? MotionType::kinematic : MotionType::static_body;
  table.shape = Shape::box(5_m, 0.5_m, 5_m);
  table.position = {{}, -0.5_m, {}};
  if (is_kinematic)
    table.angular_velocity.y = AngularVelocity::from_integer(rate);
  else
    table.surface_motion.turning.y = Rate::from_integer(rate);
  test::add(world, table);
  BodyDef box = test::dynamic_body(Shape::box(0.25_m, 0.25_m, 0.25_m), 1_m, 0.25_m, 0_m);
  box.velocity.z = Velocity::from_integer(-rate);
  box.angular_velocity.y = AngularVelocity::from_integer(rate);
  const BodyHandle rider = test::add(world, box);
  for (int i = 0; i < 754; ++i) {
    test::step(world, 1);
    const double x = to_double(world.position(rider).x), z = to_double(world.position(rider).z);
    ASSERT_NEAR(std::hypot(x, z), 1, 1e-4) << i;
  }
}

TEST(SurfaceMotion, ATurntableCarriesAlongACircle) {
  expect_to_ride_at_its_radius(false, 1);
}

TEST(SurfaceMotion, AKinematicTableCarriesAlongACircle) {
  expect_to_ride_at_its_radius(true, 1);
}

// 4 m/s² of the 4.9 that friction holds: a substep's friction holds the turn of one substep, but
// not that of a tick.
TEST(SurfaceMotion, ATurntableCarriesNearTheLimitOfFriction) {
  expect_to_ride_at_its_radius(false, 2);
  expect_to_ride_at_its_radius(true, 2);
}

TEST(SurfaceMotion, TurnsAboutTheOriginOfAnAssetsFrame) {
  // A disc whose centre of mass is 2 m beside its frame.
  std::array<CompoundChild, 1> children{};
  children[0].shape = Shape::box(5_m, 0.5_m, 5_m);
  children[0].position = {2_m, {}, {}};
  const AssetPtr disc = Compound::build(children).compound;
  World world = World::create({.body_capacity = 4, .pair_capacity = 16, .contact_capacity = 16},
                              std::make_shared<const AssetSet>(std::vector<AssetPtr>{disc}))
                    .value();
  BodyDef table;
  table.motion = MotionType::static_body;
  table.shape = disc->shape();
  table.position = {{}, -0.5_m, {}};
  table.surface_motion.turning = {{}, 1_rps, {}};
  test::add(world, table);
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.25_m, 0.25_m, 0.25_m), 0_m, 0.25_m, 0_m));
  test::step(world, 120);
  EXPECT_LT(std::abs(to_double(world.position(box).x)), 1e-3);
  EXPECT_NEAR(to_double(world.body(box).angular_velocity.y), 1, 1e-3);
}

TEST(Tags, OfBothSidesAreInEvents) {
  World world = test::make_world();
  const BodyHandle ground = test::add_ground(world);
  Surface surface;
  surface.tag = 7;
  ASSERT_EQ(world.apply(SetMaterial{ground, surface}), Status::ok);
  BodyDef ball = test::dynamic_body(Shape::sphere(0.25_m), 0_m, 0.3_m, 0_m);
  ball.material.tag = 9;
  const BodyHandle handle = test::add(world, ball);
  EXPECT_EQ(world.body(handle).surface.tag, 9U);
  std::array<ShapeContact, 2> found;
  const Transform near_ball{{{}, 0.8_m, {}}, {}};
  ASSERT_EQ(world.contacts_of_shape(Shape::sphere(0.25_m), near_ball, 0.1_m, found), 1U);
  EXPECT_EQ(found[0].surface.tag, 9U);
  bool seen = false;
  for (int tick = 0; tick < 30 && !seen; ++tick) {
    test::step(world, 1);
    for (const ContactEvent& event : world.events()) {
      EXPECT_EQ(event.tag_a, event.a == ground ? 7U : 9U);
      EXPECT_EQ(event.tag_b, event.b == ground ? 7U : 9U);
      seen = true;
    }
  }
  EXPECT_TRUE(seen);
}

}  // namespace
}  // namespace lockstone
