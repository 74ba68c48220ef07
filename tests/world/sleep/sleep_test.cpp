// Islands fall asleep, cost nothing, and wake as they were.

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/sleep/sleepers.h"

namespace lockstone {
namespace {

using namespace literals;
using test::add_stack;
using test::all_asleep;
using test::asleep;
using test::Sleepers;
using test::unit_box;

TEST(Sleep, ComesAfterTheTimeOfRestAndNotBefore) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle box = add_stack(world, {}, 1).front();
  int ticks = 0;
  for (; ticks < 120 && !asleep(world, box); ++ticks)
    (void)world.step();
  EXPECT_GE(ticks, 30);  // half a second
  EXPECT_LE(ticks, 35);
}

// A ball of 0.25 m that rolls along x on a surface at this height.
BodyHandle add_rolling_ball(World& world, Position surface) {
  BodyDef ball = test::dynamic_body(Shape::sphere(0.25_m), {}, surface + 0.25_m, {});
  ball.velocity.x = Velocity::from_ratio(1, 10);
  ball.angular_velocity.z = AngularVelocity::from_ratio(-4, 10);
  return test::add(world, ball);
}

TEST(Sleep, BrakesABallThatRollsOnABodyThatRests) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle table =
      test::add(world, test::dynamic_body(Shape::box(2_m, 0.5_m, 2_m), {}, 0.5_m, {}));
  const BodyHandle ball = add_rolling_ball(world, 1_m);
  test::step(world, 300);
  EXPECT_TRUE(asleep(world, table));
  EXPECT_TRUE(asleep(world, ball));
  EXPECT_LT(world.position(ball).x, 0.25_m);
}

TEST(Sleep, LeavesABallThatRollsByItself) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle ball = add_rolling_ball(world, {});
  test::step(world, 300);
  EXPECT_FALSE(asleep(world, ball));
  EXPECT_GT(world.position(ball).x, Position::from_ratio(499, 1000));
}

// Nothing holds a ball on a point against turning about it.
TEST(Sleep, BrakesABallThatSpinsInItsPlaceOnABodyThatRests) {
  World world = test::make_world();
  test::add_ground(world);
  test::add(world, test::dynamic_body(Shape::box(2_m, 0.5_m, 2_m), {}, 0.5_m, {}));
  BodyDef ball = test::dynamic_body(Shape::sphere(0.1_m), {}, 1.1_m, {});
  ball.angular_velocity.y = 2_rps;
  const BodyHandle top = test::add(world, ball);
  test::step(world, 360);
  EXPECT_TRUE(asleep(world, top));
}

TEST(Sleep, TakesAWholeIslandInOneTickAndTellsByEvents) {
  World world = test::make_world();
  test::add_ground(world);
  const std::vector<BodyHandle> stack = add_stack(world, {}, 5);
  std::vector<BodyHandle> told;
  for (int tick = 0; tick < 120 && told.empty(); ++tick) {
    (void)world.step();
    for (const ContactEvent& event : world.events())
      if (event.kind == EventKind::sleep) told.push_back(event.a);
  }
  EXPECT_EQ(told, stack);
  EXPECT_TRUE(all_asleep(world, stack));
}

// Where an island is not solved to convergence, and the boxes settle on each other little by
// little, the lower boxes sink under the weight before their contacts' impulses have grown, and
// come up again. A plate that may move makes one island of the stacks.
TEST(Sleep, WaitsForBodiesThatArePushedOut) {
  World world = test::make_world({.body_capacity = 256, .converged_contacts = 0});
  test::add_ground(world);
  test::add(world, test::dynamic_body(Shape::box(32_m, 0.5_m, 1_m), {}, 0.5_m, {}));
  std::vector<BodyHandle> stack;
  for (int i = 0; i < 200; ++i) {
    const Position y = Position::from_ratio(1005 * (i % 10) + 1505, 1000);
    const Position x = Position::from_integer(i / 10 * 3 - 30);
    const BodyHandle box = test::add(world, test::dynamic_body(unit_box(), x, y, {}));
    if (i < 10) stack.push_back(box);
  }
  test::step(world, 120);
  EXPECT_FALSE(asleep(world, stack[0]));
}

// Twenty stacks are twenty islands, each solved to convergence: nothing sinks under a load that is
// not known yet, so nothing has to be pushed out before it sleeps.
TEST(Sleep, ComesWithinTwoSecondsToManyStacks) {
  World world = test::make_world({.body_capacity = 256});
  test::add_ground(world);
  std::vector<BodyHandle> boxes;
  for (int i = 0; i < 200; ++i) {
    const Position y = Position::from_ratio(1005 * (i % 10) + 505, 1000);
    const Position x = Position::from_integer(i / 10 * 3 - 30);
    boxes.push_back(test::add(world, test::dynamic_body(unit_box(), x, y, {})));
  }
  test::step(world, 120);
  EXPECT_TRUE(all_asleep(world, boxes));
  for (std::size_t top = 9; top < boxes.size(); top += 10)
    EXPECT_NEAR(test::metres(world.position(boxes[top]).y), 9.5, 0.001);
}

TEST(Sleep, LeavesNothingToDo) {
  Sleepers scene;
  const StepReport report = scene.world.step();
  EXPECT_EQ(report.moving_bodies, 0U);
  EXPECT_EQ(report.pairs, 0U);
  EXPECT_EQ(report.contacts, 0U);
  EXPECT_EQ(report.islands, 0U);
  EXPECT_EQ(report.asleep_bodies, 3U);
  (void)scene.world.hash();
  (void)scene.world.step();
  EXPECT_EQ(scene.world.hash().hashed, 1U);  // the header, which holds the tick
  EXPECT_TRUE(scene.world.touching(scene.ground, scene.stack[0]));
  EXPECT_TRUE(scene.world.touching(scene.stack[1], scene.stack[0]));
}

TEST(Sleep, KeepsEveryBitOfItsState) {
  Sleepers scene;
  const StateHash before = scene.world.hash();
  test::step(scene.world, 500);
  const StateHash after = scene.world.hash();
  EXPECT_EQ(after.bodies, before.bodies);
  EXPECT_EQ(after.contacts, before.contacts);
}

// With the impulses that it slept with, gravity finds it as balanced as before. It is awake until
// its contacts know their load.
TEST(Sleep, WakesWithoutAJolt) {
  World world = test::make_world();
  test::add_ground(world);
  const std::vector<BodyHandle> stack = add_stack(world, {}, 3);
  ASSERT_EQ(world.apply(SetAllowSleep{stack[0], false}), Status::ok);
  test::step(world, 3000);
  ASSERT_EQ(world.apply(SetAllowSleep{stack[0], true}), Status::ok);
  ASSERT_EQ(world.apply(SleepBody{stack[0]}), Status::ok);
  std::vector<Position> heights;
  for (const BodyHandle body : stack)
    heights.push_back(world.position(body).y);
  test::step(world, 100);
  ASSERT_EQ(world.apply(WakeBody{stack[0]}), Status::ok);
  for (int tick = 0; tick < 20; ++tick) {
    (void)world.step();
    for (std::size_t i = 0; i < stack.size(); ++i) {
      EXPECT_FALSE(asleep(world, stack[i]));
      EXPECT_LT(abs(world.position(stack[i]).y - heights[i]), Position::from_ratio(1, 1'000'000));
      EXPECT_LT(abs(world.velocity(stack[i]).y), Velocity::from_ratio(1, 20'000));
    }
  }
}

TEST(Sleep, TremblingBodiesRestAndCreepingOnesDoNot) {
  WorldDef def{.body_capacity = 8};
  def.gravity = {};
  World world = test::make_world(def);
  const BodyHandle trembler = test::add(world, test::dynamic_body(unit_box(), {}, {}, {}));
  const BodyHandle creeper = test::add(world, test::dynamic_body(unit_box(), 5_m, {}, {}));
  const BodyHandle spinner = test::add(world, test::dynamic_body(unit_box(), 10_m, {}, {}));
  // Fast to and fro within 3.3 mm; slower, but farther than 5 mm in half a second.
  ASSERT_EQ(world.apply(SetVelocity{creeper, {0.012_mps, {}, {}}}), Status::ok);
  ASSERT_EQ(world.apply(SetAngularVelocity{spinner, {{}, 0.02_rps, {}}}), Status::ok);
  for (int tick = 0; tick < 30; ++tick) {
    EXPECT_FALSE(asleep(world, trembler));
    const Velocity speed = tick % 2 == 0 ? Velocity(0.2_mps) : Velocity(-0.2_mps);
    ASSERT_EQ(world.apply(SetVelocity{trembler, {speed, {}, {}}}), Status::ok);
    (void)world.step();
  }
  EXPECT_TRUE(asleep(world, trembler));
  test::step(world, 200);
  EXPECT_FALSE(asleep(world, creeper));
  EXPECT_FALSE(asleep(world, spinner));
  EXPECT_EQ(world.velocity(trembler), Vec3<Velocity>{});
}

TEST(Sleep, IsHeldOffByOneBodyOfTheIslandThatMayNot) {
  World world = test::make_world();
  test::add_ground(world);
  const std::vector<BodyHandle> stack = add_stack(world, {}, 3);
  const std::vector<BodyHandle> other = add_stack(world, 5_m, 2);
  ASSERT_EQ(world.apply(SetAllowSleep{stack[2], false}), Status::ok);
  test::step(world, 120);
  EXPECT_FALSE(asleep(world, stack[0]));
  EXPECT_TRUE(all_asleep(world, other));
  EXPECT_EQ(world.apply(SleepBody{stack[0]}), Status::invalid_argument);
  ASSERT_EQ(world.apply(SetAllowSleep{stack[2], true}), Status::ok);
  test::step(world, 40);
  EXPECT_TRUE(all_asleep(world, stack));
}

// Two bodies that a joint ties sleep and wake as one.
TEST(Sleep, IsSharedByBodiesThatAJointConnects) {
  WorldDef def{.body_capacity = 8};
  def.gravity = {};
  World world = test::make_world(def);
  const BodyHandle a = test::add(world, test::dynamic_body(unit_box(), {}, {}, {}));
  const BodyHandle b = test::add(world, test::dynamic_body(unit_box(), 5_m, {}, {}));
  const BodyHandle alone = test::add(world, test::dynamic_body(unit_box(), 9_m, {}, {}));
  JointDef joint_def = JointDef::of(JointKind::distance, a, b);
  joint_def.linear[0].upper = 50_m;
  joint_def.linear[0].mode = AxisMode::limited;
  const JointHandle joint = world.create_joint(joint_def).value();
  ASSERT_EQ(world.apply(SetAllowSleep{a, false}), Status::ok);
  test::step(world, 60);
  EXPECT_FALSE(asleep(world, b));
  EXPECT_TRUE(asleep(world, alone));
  ASSERT_EQ(world.apply(SetAllowSleep{a, true}), Status::ok);
  test::step(world, 60);
  EXPECT_TRUE(all_asleep(world, {a, b}));
  (void)world.hash();
  (void)world.step();
  EXPECT_EQ(world.hash().hashed, 1U);  // the header: the joint sleeps too
  ASSERT_EQ(world.apply(WakeBody{a}), Status::ok);
  EXPECT_FALSE(asleep(world, b));
  EXPECT_TRUE(asleep(world, alone));
  ASSERT_EQ(world.apply(SleepBody{b}), Status::ok);
  EXPECT_TRUE(asleep(world, a));
  ASSERT_EQ(world.apply(DestroyJoint{joint}), Status::ok);
  EXPECT_FALSE(asleep(world, a));
  EXPECT_FALSE(asleep(world, b));
}

TEST(Sleep, CanBeSwitchedOff) {
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 0});
  test::add_ground(world);
  const std::vector<BodyHandle> stack = add_stack(world, {}, 2);
  test::step(world, 300);
  EXPECT_FALSE(asleep(world, stack[0]));
  EXPECT_EQ(world.apply(SleepBody{stack[0]}), Status::invalid_argument);
}

TEST(Sleep, ByCommandTakesTheIslandAtOnce) {
  World world = test::make_world();
  test::add_ground(world);
  const std::vector<BodyHandle> stack = add_stack(world, {}, 4);
  test::step(world, 5);
  ASSERT_EQ(world.apply(SleepBody{stack[3]}), Status::ok);
  EXPECT_TRUE(all_asleep(world, stack));
  (void)world.step();
  EXPECT_TRUE(all_asleep(world, stack));
  EXPECT_EQ(world.events().size(), 4U);
}

TEST(Sleep, OfAKinematicBodyThatStandsEndsWhenItMoves) {
  World world = test::make_world();
  BodyDef def;
  def.motion = MotionType::kinematic;
  def.shape = Shape::box(3_m, 0.5_m, 3_m);
  const BodyHandle lift = test::add(world, def);
  const BodyHandle box = test::add(world, test::dynamic_body(unit_box(), {}, 1_m, {}));
  test::step(world, 60);
  EXPECT_TRUE(asleep(world, lift));
  EXPECT_TRUE(asleep(world, box));
  ASSERT_EQ(world.apply(SetVelocity{lift, {{}, 0.01_mps, {}}}), Status::ok);
  test::step(world, 300);
  EXPECT_FALSE(asleep(world, box));
  EXPECT_NEAR(test::metres(world.position(box).y), 1.05, 0.002);
}

TEST(Sleep, EndsTheStayOfATriggerUntilItEnds) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef zone;
  zone.motion = MotionType::static_body;
  zone.is_trigger = true;
  test::add(world, zone);
  const BodyHandle box = add_stack(world, {}, 1).front();
  test::step(world, 60);
  ASSERT_TRUE(asleep(world, box));
  (void)world.step();
  EXPECT_TRUE(world.events().empty());
  ASSERT_EQ(world.apply(WakeBody{box}), Status::ok);
  (void)world.step();
  ASSERT_EQ(world.events().size(), 2U);
  EXPECT_EQ(world.events()[0].kind, EventKind::trigger_stay);
}

// Pushes, ends and adds bodies of a world in which most sleep most of the time.
void disturb_sleepers(World& world, test::Random& random) {
  const std::int64_t what = random.between(0, 59);
  const auto index = static_cast<std::uint32_t>(random.between(1, world.body_limit() - 1));
  const BodyHandle body = world.body_at(index);
  if (body.is_null()) return;
  const auto speed = Velocity::from_integer(random.between(1, 6));
  if (what == 0) (void)world.apply(SetVelocity{body, {speed, speed, {}}});
  if (what == 1) (void)world.apply(Teleport{body, {{}, 4_m, {}}, {}});
  if (what == 2) (void)world.apply(SleepBody{body});
  if (what == 3) (void)world.apply(SetAllowSleep{body, random.between(0, 1) == 0});
  if (what == 4) (void)world.apply(DestroyBody{body});
  if (what == 5) (void)world.create_body(test::dynamic_body(unit_box(), {}, 5_m, {}));
}

World drowsy_world(BroadPhaseKind broad_phase) {
  World world = test::make_world({.body_capacity = 512,
                                  .pair_capacity = 8192,
                                  .contact_capacity = 4096,
                                  .sleep_ms = 100,
                                  .broad_phase = broad_phase});
  test::add_ground(world);
  for (int i = 0; i < 12; ++i)
    (void)add_stack(world, Position::from_integer(2 * i - 12), 1 + i % 4);
  BodyDef zone;
  zone.motion = MotionType::static_body;
  zone.is_trigger = true;
  zone.shape = Shape::box(20_m, 0.2_m, 2_m);
  test::add(world, zone);
  BodyDef sweeper;
  sweeper.motion = MotionType::kinematic;
  sweeper.position = {-14_m, 1_m, {}};
  sweeper.velocity = {0.5_mps, {}, {}};
  test::add(world, sweeper);
  return world;
}

TEST(Sleep, FollowsFromTheStateAlone) {
  const std::uint64_t seed = test::run_seed();
  World plain = drowsy_world(BroadPhaseKind::tree);
  World dropped = drowsy_world(BroadPhaseKind::tree);
  World swept = drowsy_world(BroadPhaseKind::sweep_and_prune);
  World loaded = drowsy_world(BroadPhaseKind::tree);
  std::uint32_t most = 0;
  const auto turn = [&](World& world, int tick) {
    test::Random random(seed + static_cast<std::uint64_t>(tick));
    for (int i = 0; i < 4; ++i)
      disturb_sleepers(world, random);
    most = std::max(most, world.step().asleep_bodies);
  };
  constexpr int k_ticks = LKS_SANITIZED ? 200 : 400;  // many sleep after 200
  for (int tick = 0; tick < k_ticks; ++tick) {
    dropped.drop_derived();
    const SnapshotKind kind = tick % 2 == 0 ? SnapshotKind::native : SnapshotKind::canonical;
    World fresh = test::make_world(loaded.def());
    ASSERT_EQ(fresh.load(kind, test::save(loaded, kind)), Status::ok) << "tick " << tick;
    loaded = std::move(fresh);
    for (World* world : {&plain, &dropped, &swept, &loaded})
      turn(*world, tick);
    const std::uint64_t expected = plain.hash().total;
    ASSERT_EQ(dropped.hash().total, expected) << "tick " << tick;
    ASSERT_EQ(swept.hash().total, expected) << "tick " << tick;
    ASSERT_EQ(loaded.hash().total, expected) << "tick " << tick;
  }
  EXPECT_GT(most, 15U);
}

}  // namespace
}  // namespace lockstone
