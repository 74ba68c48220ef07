#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

struct Counts {
  int begin = 0, end = 0, persist = 0, enter = 0, stay = 0, exit = 0;
};

Counts step_and_count(World& world, int ticks) {
  Counts counts;
  for (int i = 0; i < ticks; ++i) {
    (void)world.step();
    for (const ContactEvent& event : world.events()) {
      counts.begin += event.kind == EventKind::contact_begin ? 1 : 0;
      counts.end += event.kind == EventKind::contact_end ? 1 : 0;
      counts.persist += event.kind == EventKind::contact_persist ? 1 : 0;
      counts.enter += event.kind == EventKind::trigger_enter ? 1 : 0;
      counts.stay += event.kind == EventKind::trigger_stay ? 1 : 0;
      counts.exit += event.kind == EventKind::trigger_exit ? 1 : 0;
    }
  }
  return counts;
}

TEST(Events, ABallThatLandsBeginsOneContact) {
  World world = test::make_world();
  const BodyHandle ground = test::add_ground(world);
  const BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), {}, 1.5_m, {}));
  bool found = false;
  for (int i = 0; i < 120 && !found; ++i) {
    (void)world.step();
    for (const ContactEvent& event : world.events()) {
      found = event.kind == EventKind::contact_begin;
      EXPECT_EQ(event.a, ball);
      EXPECT_EQ(event.b, ground);
      // Fell one metre: √(2g) = 4.43 m/s.
      EXPECT_NEAR(static_cast<double>(event.approach_speed.raw) / 4294967296.0, 4.43, 0.2);
    }
  }
  EXPECT_TRUE(found);
  EXPECT_TRUE(world.touching(ground, ball));
  const Counts later = step_and_count(world, 120);
  EXPECT_EQ(later.begin, later.end);
}

TEST(Events, ABallThatLeavesEndsItsContact) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), {}, 0.5_m, {}));
  EXPECT_EQ(step_and_count(world, 10).begin, 1);
  ASSERT_EQ(world.apply(SetVelocity{ball, {{}, 10_mps, {}}}), Status::ok);
  const Counts counts = step_and_count(world, 20);
  EXPECT_EQ(counts.end, 1);
  EXPECT_EQ(counts.begin, 0);
}

TEST(Events, PersistInEveryTickOfAContactOfBodiesThatAsk) {
  WorldDef world_def;
  world_def.sleep_ms = 0;
  World world = test::make_world(world_def);
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {});
  def.material.tag = 4;
  test::add(world, def);
  def.position.x = 3_m;
  def.events.persist = true;
  const BodyHandle asking = test::add(world, def);
  def.position.y = 1.5_m;
  def.events = {.contacts = false, .persist = true};
  test::add(world, def);  // upon the other, without contact events
  EXPECT_EQ(step_and_count(world, 1).persist, 0);
  // Until the island stands still, and then too.
  for (int i = 0; i < 60; ++i) {
    const Counts counts = step_and_count(world, 1);
    EXPECT_EQ(counts.persist, 1);
    EXPECT_EQ(counts.begin + counts.end, 0);
    ASSERT_EQ(world.events().size(), 1U);
    EXPECT_TRUE(world.events()[0].a == asking || world.events()[0].b == asking);
    EXPECT_EQ(world.events()[0].tag_a + world.events()[0].tag_b, 4U);
  }
  ASSERT_EQ(world.apply(SetEvents{asking, {}}), Status::ok);
  EXPECT_EQ(step_and_count(world, 60).persist, 0);
}

TEST(Events, PersistUntilTheContactEnds) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), {}, 0.5_m, {});
  def.events.persist = true;
  const BodyHandle ball = test::add(world, def);
  const Counts rest = step_and_count(world, 10);
  EXPECT_EQ(rest.begin, 1);
  EXPECT_EQ(rest.persist, 9);
  ASSERT_EQ(world.apply(SetVelocity{ball, {{}, 10_mps, {}}}), Status::ok);
  const Counts flight = step_and_count(world, 20);
  EXPECT_EQ(flight.end, 1);
  EXPECT_LE(flight.persist, 1);  // it touches at the beginning of the first tick
}

TEST(Events, PersistNotWhileBothSleep) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 0.5_m, {});
  def.events.persist = true;
  const BodyHandle box = test::add(world, def);
  (void)step_and_count(world, 120);
  ASSERT_TRUE(world.body(box).is_asleep);
  EXPECT_EQ(step_and_count(world, 10).persist, 0);
  ASSERT_EQ(world.apply(WakeBody{box}), Status::ok);
  const Counts woken = step_and_count(world, 5);
  EXPECT_EQ(woken.persist, 5);
  EXPECT_EQ(woken.begin, 0);
}

TEST(Trigger, IsEnteredStayedInAndLeftAndPushesNothing) {
  World world = test::make_world();
  BodyDef zone;
  zone.motion = MotionType::static_body;
  zone.shape = Shape::box(1_m, 1_m, 1_m);
  zone.is_trigger = true;
  test::add(world, zone);
  BodyDef def = test::dynamic_body(Shape::sphere(0.25_m), -3_m, {}, {});
  def.velocity.x = 4_mps;
  def.gravity_scale = {};
  const BodyHandle ball = test::add(world, def);
  const Counts counts = step_and_count(world, 90);
  EXPECT_EQ(counts.enter, 1);
  EXPECT_EQ(counts.exit, 1);
  // Inside for 2.5 m at 4 m/s: 37 or 38 ticks.
  EXPECT_NEAR(counts.stay, 37, 1);
  EXPECT_EQ(counts.begin, 0);
  EXPECT_EQ(world.velocity(ball).x, Velocity::from_integer(4));
}

TEST(Trigger, SensesAKinematicBody) {
  World world = test::make_world();
  BodyDef zone;
  zone.motion = MotionType::static_body;
  zone.is_trigger = true;
  test::add(world, zone);
  BodyDef door;
  door.motion = MotionType::kinematic;
  test::add(world, door);
  EXPECT_EQ(step_and_count(world, 1).enter, 1);
}

TEST(Events, ComeInOrderOfPairs) {
  World world = test::make_world();
  test::add_ground(world);
  for (int i = 0; i < 20; ++i) {
    test::add(world, test::dynamic_body(Shape::sphere(0.5_m),
                                        Position::from_integer(37 * i % 40 * 2 - 40), 0.5_m, {}));
  }
  (void)world.step();
  const auto events = world.events();
  ASSERT_EQ(events.size(), 20U);
  for (std::size_t i = 1; i < events.size(); ++i) {
    EXPECT_LT(std::pair(events[i - 1].a.index, events[i - 1].b.index),
              std::pair(events[i].a.index, events[i].b.index));
  }
}

}  // namespace
}  // namespace lockstone
