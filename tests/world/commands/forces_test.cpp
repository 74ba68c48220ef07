// Forces, torques, locks, limits and kinematic targets.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

constexpr Vec3<Unit> k_up{{}, Unit::from_integer(1), {}};
constexpr Angle k_quarter = Angle::from_ratio(157079633, 100000000);

World empty_space() {
  WorldDef def{.body_capacity = 8, .pair_capacity = 64, .contact_capacity = 64};
  def.gravity = {};
  return test::make_world(def);
}

// One cubic metre: 1000 kg.
BodyDef cube() {
  return test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), 0_m, 0_m, 0_m);
}

void order(World& world, const Command& command) {
  ASSERT_EQ(world.apply(command), Status::ok);
}

TEST(Forces, MoveABodyAsGravityDoes) {
  World world = empty_space();
  const BodyHandle body = test::add(world, cube());
  for (int tick = 0; tick < 60; ++tick) {
    order(world, ApplyForce{body, {600_N, {}, {}}});
    order(world, ApplyForce{body, {400_N, {}, {}}});
    test::step(world, 1);
  }
  EXPECT_NEAR(to_double(world.velocity(body).x), 1, 1e-7);
  EXPECT_NEAR(to_double(world.position(body).x), 0.5, 1e-7);
}

TEST(Forces, LastForOneTick) {
  World world = empty_space();
  const BodyHandle body = test::add(world, cube());
  order(world, ApplyForce{body, {6000_N, {}, {}}});
  test::step(world, 3);
  EXPECT_NEAR(to_double(world.velocity(body).x), 0.1, 1e-8);
}

TEST(Forces, BelowTheLimitOfFrictionMoveNothing) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = cube();
  def.position.y = 0.5_m;
  const BodyHandle body = test::add(world, def);
  test::step(world, 60);
  const double start = to_double(world.position(body).x);
  for (int tick = 0; tick < 120; ++tick) {
    order(world, ApplyForce{body, {4400_N, {}, {}}});  // μmg = 4905 N
    test::step(world, 1);
  }
  EXPECT_LT(std::abs(to_double(world.position(body).x) - start), 5e-4);
}

TEST(Forces, OfTheBodysFrameTurnWithIt) {
  World world = empty_space();
  BodyDef def = cube();
  def.orientation = from_axis_angle(k_up, k_quarter);
  const BodyHandle body = test::add(world, def);
  order(world, ApplyForce{body, {1000_N, {}, {}}, Frame::body});
  test::step(world, 1);
  EXPECT_NEAR(to_double(world.velocity(body).x), 0, 1e-7);
  EXPECT_NEAR(to_double(world.velocity(body).z), -1.0 / 60, 1e-7);
}

TEST(Forces, AtAPointTurnTheBody) {
  World world = empty_space();
  const BodyHandle body = test::add(world, cube());
  order(world, ApplyForceAt{body, {{}, {}, 1000_N}, {0.5_m, {}, {}}});
  test::step(world, 1);
  // ω = r × F·dt / I, I = 1000/6
  EXPECT_NEAR(to_double(world.body(body).angular_velocity.y), -500.0 / 60 * 6 / 1000, 1e-6);
  BodyDef def = cube();
  def.orientation = from_axis_angle(k_up, k_quarter);
  def.position.x = 5_m;
  const BodyHandle turned = test::add(world, def);
  order(world, ApplyForceAt{turned, {{}, {}, 1000_N}, {0.5_m, {}, {}}, Frame::body});
  test::step(world, 1);
  EXPECT_NEAR(to_double(world.body(turned).angular_velocity.y), -500.0 / 60 * 6 / 1000, 1e-6);
  EXPECT_EQ(world.apply(ApplyForceAt{turned, {}, {5_m, {}, {}}}), Status::invalid_argument);
}

TEST(Forces, TorquesAndAngularImpulsesAgree) {
  World world = empty_space();
  const BodyHandle a = test::add(world, cube());
  BodyDef def = cube();
  def.position.x = 5_m;
  const BodyHandle b = test::add(world, def);
  order(world, ApplyAngularImpulse{a, {{}, AngularImpulse::from_integer(10), {}}});
  order(world, ApplyTorque{b, {{}, Torque::from_integer(600), {}}});
  test::step(world, 1);
  EXPECT_NEAR(to_double(world.body(a).angular_velocity.y), 0.06, 1e-7);
  EXPECT_NEAR(to_double(world.body(b).angular_velocity.y), 0.06, 1e-7);
}

TEST(Forces, AreStateUntilTheyHaveWorked) {
  World world = empty_space();
  const BodyHandle body = test::add(world, cube());
  const std::uint64_t before = world.hash().total;
  order(world, ApplyForce{body, {1000_N, {}, {}}});
  EXPECT_NE(world.hash().total, before);
  World copy = empty_space();
  ASSERT_EQ(copy.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
            Status::ok);
  test::step(world, 1);
  test::step(copy, 1);
  EXPECT_EQ(copy.hash().total, world.hash().total);
  EXPECT_GT(to_double(copy.velocity(body).x), 0.01);
}

TEST(AxisLocks, HoldInFreeFlight) {
  World world = test::make_world();
  BodyDef def = cube();
  def.shape = Shape::box(0.2_m, 0.5_m, 0.9_m);
  def.locks = {.move_y = true, .turn_x = true, .turn_z = true};
  def.velocity = {1_mps, 3_mps, {}};
  def.angular_velocity = {2_rps, 3_rps, 4_rps};
  const BodyHandle body = test::add(world, def);
  test::step(world, 60);
  EXPECT_EQ(world.position(body).y, Position{});
  EXPECT_NEAR(to_double(world.position(body).x), 1, 1e-8);
  const Vec3<AngularVelocity> w = world.body(body).angular_velocity;
  EXPECT_EQ(w.x, AngularVelocity{});
  EXPECT_EQ(w.z, AngularVelocity{});
  EXPECT_NEAR(to_double(w.y), 3, 1e-6);
}

// A pile in a plane: nothing leaves it, nothing turns out of it, bit for bit.
TEST(AxisLocks, KeepAHeapInItsPlane) {
  World world = test::make_world();
  test::add_ground(world);
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 12; ++i) {
    BodyDef def = test::dynamic_body(
        i % 2 == 0 ? Shape::box(0.4_m, 0.3_m, 0.5_m) : Shape::sphere(0.35_m),
        Position::from_ratio(i % 4, 2), Position::from_ratio(6 + 7 * i, 10), 0_m);
    def.locks = {.move_z = true, .turn_x = true, .turn_y = true};
    def.velocity = {{}, {}, 2_mps};
    def.material.restitution = 0.5_r;
    bodies.push_back(test::add(world, def));
  }
  test::step(world, 240);
  for (const BodyHandle body : bodies) {
    EXPECT_EQ(world.position(body).z, Position{});
    const Vec3<AngularVelocity> w = world.body(body).angular_velocity;
    EXPECT_EQ(w.x, AngularVelocity{});
    EXPECT_EQ(w.y, AngularVelocity{});
    EXPECT_GT(to_double(world.position(body).y), 0.2);
  }
}

TEST(AxisLocks, HoldAgainstImpactsWithinATick) {
  World world = empty_space();
  BodyDef wall = cube();
  wall.locks = {.move_x = true, .move_y = true, .move_z = true};
  const BodyHandle held = test::add(world, wall);
  BodyDef bullet = test::dynamic_body(Shape::sphere(0.02_m), -2_m, 0.1_m, 0_m);
  bullet.velocity = {300_mps, {}, {}};
  bullet.is_bullet = true;
  bullet.material.restitution = 1_r;
  const BodyHandle fast = test::add(world, bullet);
  test::step(world, 3);
  EXPECT_EQ(world.position(held).x, Position{});
  EXPECT_LT(to_double(world.velocity(fast).x), 0);
}

AxisLocks lock_of(int axis) {
  return {axis == 0, axis == 1, axis == 2, axis == 3, axis == 4, axis == 5};
}

// How fast a body goes along or about an axis.
std::int64_t speed_of(const BodyView& body, int axis) {
  return axis < 3 ? body.velocity[axis].raw : body.angular_velocity[axis - 3].raw;
}

// Pushed off its centre by a ball on a crooked course, in each axis.
TEST(AxisLocks, OfEachAxisHoldAgainstContacts) {
  for (int axis = 0; axis < 6; ++axis) {
    SCOPED_TRACE(axis);
    World world = empty_space();
    BodyDef def = cube();
    def.locks = lock_of(axis);
    const BodyHandle held = test::add(world, def);
    BodyDef ball = test::dynamic_body(Shape::sphere(0.3_m), -1.2_m, -0.9_m, -1.1_m);
    ball.velocity = {3_mps, 2_mps, 2.5_mps};
    test::add(world, ball);
    test::step(world, 60);
    const BodyView after = world.body(held);
    EXPECT_EQ(speed_of(after, axis), 0);
    EXPECT_EQ(axis < 3 ? after.position[axis].raw : 0, 0);
    EXPECT_NE(after.position, Vec3<Position>{});
  }
}

// A heavy pendulum pulls at a held body in all directions: along a locked axis it gives not a bit.
TEST(AxisLocks, OfEachAxisHoldAgainstJoints) {
  for (int axis = 0; axis < 6; ++axis) {
    SCOPED_TRACE(axis);
    World world = test::make_world();
    BodyDef def = cube();
    def.locks = lock_of(axis);
    def.gravity_scale = {};
    const BodyHandle held = test::add(world, def);
    BodyDef bob = test::dynamic_body(Shape::sphere(0.4_m), 2_m, {}, 1_m);
    bob.material.density = Density::from_integer(5000);
    const BodyHandle heavy = test::add(world, bob);
    JointDef joint = JointDef::of(JointKind::ball, held, heavy);
    joint.frame_a.position = {0.2_m, -0.4_m, 0.3_m};
    joint.frame_b.position = {-1.8_m, -0.4_m, -0.7_m};
    ASSERT_TRUE(world.create_joint(joint).ok());
    for (int i = 0; i < 60; ++i) {
      test::step(world, 1);
      const BodyView now = world.body(held);
      ASSERT_EQ(speed_of(now, axis), 0);
      ASSERT_EQ(axis < 3 ? now.position[axis].raw : 0, 0);
    }
    EXPECT_NE(world.position(held), Vec3<Position>{});
  }
}

// To a joint, a body with all axes locked is as good as static.
TEST(AxisLocks, OfAllAxesCarryAPendulumAsAStaticBodyDoes) {
  const auto swing = [](bool is_static) {
    World world = test::make_world();
    BodyDef def = cube();
    def.locks = {true, true, true, true, true, true};
    if (is_static) def.motion = MotionType::static_body;
    const BodyHandle held = test::add(world, def);
    const BodyHandle bob = test::add(world, test::dynamic_body(Shape::sphere(0.4_m), 2_m, {}, {}));
    JointDef joint = JointDef::of(JointKind::ball, held, bob);
    joint.frame_b.position = {-2_m, {}, {}};
    EXPECT_TRUE(world.create_joint(joint).ok());
    test::step(world, 90);
    EXPECT_EQ(world.position(held), Vec3<Position>{});
    return world.position(bob);
  };
  const Vec3<Position> locked = swing(false), fixed = swing(true);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(test::metres(locked[i]), test::metres(fixed[i]), 1e-4);
}

TEST(AxisLocks, ACommandStopsTheBody) {
  World world = empty_space();
  BodyDef def = cube();
  def.velocity = {1_mps, 2_mps, {}};
  const BodyHandle body = test::add(world, def);
  order(world, SetAxisLocks{body, {.move_x = true}});
  EXPECT_EQ(world.velocity(body).x, Velocity{});
  order(world, SetAxisLocks{body, {}});
  order(world, SetVelocity{body, {3_mps, {}, {}}});
  test::step(world, 60);
  EXPECT_NEAR(to_double(world.position(body).x), 3, 1e-8);
}

TEST(SpeedLimits, HoldABodyAndAWorld) {
  WorldDef def{.body_capacity = 8, .pair_capacity = 64, .contact_capacity = 64};
  def.speed_limit = 20_mps;
  World world = test::make_world(def);
  const BodyHandle free = test::add(world, cube());
  BodyDef slow = cube();
  slow.position.x = 10_m;
  slow.speed_limit = {5_mps, 3_rps};
  slow.angular_velocity = {{}, 30_rps, {}};
  const BodyHandle held = test::add(world, slow);
  test::step(world, 240);
  EXPECT_NEAR(to_double(world.velocity(free).y), -20, 1e-6);
  EXPECT_NEAR(to_double(world.velocity(held).y), -5, 1e-5);
  EXPECT_NEAR(to_double(world.body(held).angular_velocity.y), 3, 1e-4);
}

TEST(Settings, ChangeGravityScaleAndDamping) {
  World world = test::make_world();
  const BodyHandle a = test::add(world, cube());
  order(world, SetGravityScale{a, Number::from_ratio(1, 2)});
  test::step(world, 60);
  EXPECT_NEAR(to_double(world.position(a).y), -9.81 / 4, 1e-6);
  order(world, SetGravityScale{a, {}});
  order(world, SetDamping{a, 60_rps, {}});
  const double before = to_double(world.velocity(a).y);
  test::step(world, 1);
  EXPECT_NEAR(to_double(world.velocity(a).y), before * std::exp(-1.0), 1e-6);
  EXPECT_EQ(world.apply(SetDamping{a, -1_rps, {}}), Status::invalid_argument);
}

TEST(MoveKinematic, ReachesItsTargetInOneTick) {
  World world = test::make_world();
  BodyDef def = cube();
  def.motion = MotionType::kinematic;
  const BodyHandle body = test::add(world, def);
  const Quat quarter = from_axis_angle(k_up, Angle::from_ratio(1, 10));
  order(world, MoveKinematic{body, {0.5_m, 1_m, -0.25_m}, quarter});
  test::step(world, 1);
  EXPECT_NEAR(to_double(world.position(body).x), 0.5, 1e-9);
  EXPECT_NEAR(to_double(world.position(body).y), 1, 1e-9);
  EXPECT_NEAR(to_double(world.body(body).orientation.y), to_double(quarter.y), 1e-7);
  EXPECT_EQ(world.apply(MoveKinematic{body, {100_m, {}, {}}, {}}), Status::invalid_argument);
  const BodyHandle other = test::add(world, cube());
  EXPECT_EQ(world.apply(MoveKinematic{other, {}, {}}), Status::invalid_argument);
}

}  // namespace
}  // namespace lockstone
