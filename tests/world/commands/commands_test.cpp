#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

double value(Velocity v) {
  return static_cast<double>(v.raw) / 4294967296.0;
}

TEST(CreateBody, RefusesValuesOutsideTheirRange) {
  World world = test::make_world();
  const auto refused = [&](auto&& change) {
    BodyDef def;
    change(def);
    const std::uint64_t before = world.hash().total;
    const Status status = world.create_body(def).status();
    EXPECT_EQ(world.hash().total, before);
    return status;
  };
  EXPECT_EQ(refused([](BodyDef& d) { d.shape = Shape::sphere({}); }), Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.shape = Shape::box(513_m, 1_m, 1_m); }),
            Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.position.z = 1048577_m; }), Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.velocity.x = -501_mps; }), Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.angular_velocity.x = 2000000_rps; }),
            Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.orientation.w = {}; }), Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.material.friction = -0.1_r; }), Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.material.restitution = 1.1_r; }), Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.material.density = {}; }), Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.linear_damping = Rate::from_raw(-1); }),
            Status::invalid_argument);
  EXPECT_EQ(refused([](BodyDef& d) { d.motion = static_cast<MotionType>(0); }),
            Status::invalid_argument);
}

TEST(CreateBody, SaysWhenTheWorldIsFull) {
  World world = test::make_world({.body_capacity = 2, .pair_capacity = 8, .contact_capacity = 8});
  test::add(world, {});
  test::add(world, {});
  EXPECT_EQ(world.create_body({}).status(), Status::capacity_exhausted);
  EXPECT_EQ(world.apply(CreateBody{}), Status::capacity_exhausted);
}

TEST(Handle, OfADestroyedBodyNeverNamesAnother) {
  World world = test::make_world();
  const BodyHandle first = test::add(world, {});
  ASSERT_EQ(world.apply(DestroyBody{first}), Status::ok);
  const BodyHandle second = test::add(world, {});
  EXPECT_EQ(second.index, first.index);
  EXPECT_FALSE(world.exists(first));
  EXPECT_TRUE(world.exists(second));
  EXPECT_EQ(world.apply(DestroyBody{first}), Status::stale_handle);
  EXPECT_EQ(world.apply(SetVelocity{first, {}}), Status::stale_handle);
  EXPECT_EQ(world.apply(SetVelocity{BodyHandle{}, {}}), Status::stale_handle);
  EXPECT_EQ(world.apply(SetVelocity{BodyHandle{999999, 1}, {}}), Status::stale_handle);
}

TEST(Handle, SlotsAreReusedLowestFirst) {
  World world = test::make_world();
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < 5; ++i)
    bodies.push_back(test::add(world, {}));
  ASSERT_EQ(world.apply(DestroyBody{bodies[3]}), Status::ok);
  ASSERT_EQ(world.apply(DestroyBody{bodies[1]}), Status::ok);
  EXPECT_EQ(test::add(world, {}).index, 1U);
  EXPECT_EQ(test::add(world, {}).index, 3U);
  EXPECT_EQ(test::add(world, {}).index, 5U);
}

TEST(ApplyImpulse, ChangesVelocityByImpulseOverMass) {
  World world = test::make_world();
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, {}, {}));
  EXPECT_NEAR(static_cast<double>(world.mass(box).raw) / 4294967296.0, 1000.0, 1e-6);
  ASSERT_EQ(world.apply(ApplyImpulse{box, {2500_Ns, {}, -500_Ns}}), Status::ok);
  EXPECT_NEAR(value(world.velocity(box).x), 2.5, 1e-8);
  EXPECT_NEAR(value(world.velocity(box).z), -0.5, 1e-8);
}

TEST(ApplyImpulseAt, TurnsTheBodyByLeverTimesImpulse) {
  World world = test::make_world();
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, {}, {}));
  ASSERT_EQ(world.apply(ApplyImpulseAt{box, {{}, 1000_Ns, {}}, {0.5_m, {}, {}}}), Status::ok);
  // I = m/6 for the unit cube: ω = r·J/I = 0.5·1000/(1000/6) = 3.
  const auto omega = world.body(box).angular_velocity.z;
  EXPECT_NEAR(static_cast<double>(omega.raw) / 4294967296.0, 3.0, 1e-6);
  EXPECT_EQ(world.apply(ApplyImpulseAt{box, {}, {9_m, {}, {}}}), Status::invalid_argument);
}

TEST(ApplyAngularImpulse, ChangesAngularVelocityByImpulseOverInertia) {
  World world = test::make_world();
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, {}, {}));
  const AngularImpulse l = AngularImpulse::from_integer(500);
  ASSERT_EQ(world.apply(ApplyAngularImpulse{box, {{}, l, {}}}), Status::ok);
  EXPECT_NEAR(static_cast<double>(world.body(box).angular_velocity.y.raw) / 4294967296.0, 3.0,
              1e-6);
}

TEST(ApplyForce, ActsForOneTick) {
  World world = test::make_world();
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, {}, {}));
  ASSERT_EQ(world.apply(ApplyForce{box, {6000_N, {}, {}}}), Status::ok);
  EXPECT_EQ(world.velocity(box).x, Velocity{});
  test::step(world, 2);
  EXPECT_NEAR(value(world.velocity(box).x), 0.1, 1e-7);
}

TEST(ApplyImpulse, IsBoundedByTheSpeedLimit) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::sphere(0.01_m), {}, {}, {});
  def.gravity_scale = {};
  const BodyHandle ball = test::add(world, def);
  ASSERT_EQ(world.apply(ApplyImpulse{ball, {Impulse::max(), Impulse::max(), Impulse::min()}}),
            Status::ok);
  test::step(world, 2);
  const Vec3<Velocity> v = world.velocity(ball);
  EXPECT_LE(value(v.x) * value(v.x) + value(v.y) * value(v.y) + value(v.z) * value(v.z),
            500.001 * 500.001);
}

TEST(Impulse, IsRefusedForBodiesThatCannotBePushed) {
  World world = test::make_world();
  const BodyHandle ground = test::add_ground(world);
  EXPECT_EQ(world.apply(ApplyImpulse{ground, {}}), Status::invalid_argument);
  EXPECT_EQ(world.apply(SetVelocity{ground, {}}), Status::invalid_argument);
  EXPECT_EQ(world.mass(ground), Mass{});
}

TEST(Teleport, MovesTheBodyAndDropsItsContacts) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), {}, 0.5_m, {}));
  EXPECT_EQ(world.step().contacts, 1U);
  ASSERT_EQ(world.apply(Teleport{ball, {{}, 30_m, {}}, Quat{}}), Status::ok);
  EXPECT_EQ(world.position(ball).y, Position::from_integer(30));
  EXPECT_EQ(world.step().contacts, 0U);
}

TEST(SetFilter, LetsBodiesPass) {
  World world = test::make_world();
  const BodyHandle ground = test::add_ground(world);
  const BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), {}, 0.5_m, {}));
  ASSERT_EQ(world.apply(SetFilter{ball, {.category = 2, .mask = 2, .group = 0}}), Status::ok);
  EXPECT_EQ(world.step().contacts, 0U);
  ASSERT_EQ(world.apply(SetFilter{ball, {.category = 1, .mask = 1, .group = 7}}), Status::ok);
  ASSERT_EQ(world.apply(SetFilter{ground, {.category = 2, .mask = 2, .group = 7}}), Status::ok);
  EXPECT_EQ(world.step().contacts, 1U);
  ASSERT_EQ(world.apply(SetFilter{ball, {.group = -7}}), Status::ok);
  ASSERT_EQ(world.apply(SetFilter{ground, {.group = -7}}), Status::ok);
  EXPECT_EQ(world.step().contacts, 0U);
}

// The least number has no magnitude: one that took it would find it small.
TEST(Commands, RefuseTheLeastNumbers) {
  World world = test::make_world();
  const BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), {}, 1_m, {}));
  for (int axis = 0; axis < 3; ++axis) {
    Vec3<Acceleration> gravity;
    gravity[axis] = Acceleration::min();
    EXPECT_EQ(world.apply(SetGravity{gravity}), Status::invalid_argument);
    Vec3<Velocity> velocity;
    velocity[axis] = Velocity::min();
    EXPECT_EQ(world.apply(SetVelocity{ball, velocity}), Status::invalid_argument);
  }
  EXPECT_EQ(world.apply(SetGravityScale{ball, Number::min()}), Status::invalid_argument);
}

TEST(WorldDef, IsCheckedAndHashed) {
  EXPECT_EQ(World::create({.body_capacity = 0}).status(), Status::invalid_argument);
  EXPECT_EQ(World::create({.tick_rate = 9}).status(), Status::invalid_argument);
  EXPECT_EQ(World::create({.substeps = 17}).status(), Status::invalid_argument);
  WorldDef changed;
  changed.substeps = 8;
  EXPECT_NE(config_hash(changed), config_hash({}));
  EXPECT_EQ(World::create({.broad_phase = static_cast<BroadPhaseKind>(2)}).status(),
            Status::invalid_argument);
}

TEST(WorldDef, LeavesTheBroadPhaseToEachPeer) {
  EXPECT_EQ(config_hash({.broad_phase = BroadPhaseKind::sweep_and_prune}), config_hash({}));
}

}  // namespace
}  // namespace lockstone
