// The contact solver where its colours run out and where values are extreme: the same on every
// target, and physical.

#include <vector>

#include <gtest/gtest.h>

#include "core/kernels/target.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

// A plate of 8 m on a bed of 100 balls: one body in more contacts than there are colours.
World plate_on_balls() {
  World world = test::make_world();
  test::add_ground(world);
  for (int i = 0; i < 100; ++i) {
    const Position x = Position::from_ratio(2 * (i % 10) - 9, 2);
    const Position z = Position::from_ratio(2 * (i / 10) - 9, 2);
    test::add(world, test::dynamic_body(Shape::sphere(0.25_m), x, 0.25_m, z));
  }
  test::add(world, test::dynamic_body(Shape::box(5_m, 0.1_m, 5_m), {}, 0.6_m, {}));
  return world;
}

TEST(Overflow, LeavesAPlateLevelOnItsBalls) {
  World world = plate_on_balls();
  StepReport report = world.step();
  EXPECT_EQ(report.colors, 32U);
  EXPECT_EQ(report.overflow_contacts, 100U - 32U + 1U);
  test::step(world, 300);
  const BodyView plate = world.body(world.body_at(101));
  EXPECT_NEAR(metres(plate.position.y), 0.6, 1e-3);
  EXPECT_NEAR(metres(plate.position.x), 0.0, 1e-3);
  EXPECT_NEAR(static_cast<double>(plate.orientation.w.raw) / 1073741824.0, 1.0, 1e-6);
}

TEST(Overflow, IsTheSameOnEveryTarget) {
  const auto run = [](std::string_view target) {
    EXPECT_EQ(lanes::set_target(target), Status::ok);
    World world = plate_on_balls();
    test::step(world, 60);
    return world.hash().total;
  };
  const std::uint64_t expected = run("scalar");
  for (const std::string_view target : lanes::supported_targets())
    EXPECT_EQ(run(target), expected) << target;
}

TEST(RandomScenes, AreTheSameOnEveryTarget) {
  const auto run = [](std::string_view target) {
    EXPECT_EQ(lanes::set_target(target), Status::ok);
    World world = test::make_world();
    test::fill_with_random_bodies(world, test::run_seed(), 120);
    test::step(world, 90);
    return world.hash().total;
  };
  const std::uint64_t expected = run("scalar");
  for (const std::string_view target : lanes::supported_targets())
    EXPECT_EQ(run(target), expected) << target;
}

// A wheel of balls in a row of wheels: hubs of 40 spokes, more than there are colours, in a ring of
// balls that are tied to each other, hung from one that stands still.
World wheels_of_balls() {
  World world = test::make_world({.body_capacity = 256, .joint_capacity = 512});
  const auto tie = [&](BodyHandle a, BodyHandle b, const Vec3<Length>& on_a,
                       const Vec3<Length>& on_b) {
    JointDef joint = JointDef::of(JointKind::ball, a, b);
    joint.frame_a.position = on_a;
    joint.frame_b.position = on_b;
    EXPECT_TRUE(world.create_joint(joint).ok());
  };
  constexpr int k_spokes = 40;
  for (int wheel = 0; wheel < 2; ++wheel) {
    const Position x = Position::from_integer(8 * wheel);
    const BodyHandle hub = test::add(world, test::dynamic_body(Shape::sphere(2_m), x, 20_m, {}));
    std::vector<BodyHandle> rim;
    for (int i = 0; i < k_spokes; ++i) {
      const Length turn = Length::from_ratio(2 * i - k_spokes, k_spokes);  // from −1 to 1
      const Vec3<Length> at{turn, Length::from_integer(i % 2 == 0 ? 1 : -1), turn / 2};
      BodyDef ball = test::dynamic_body(Shape::box(0.2_m, 0.1_m, 0.15_m), x, 20_m, {});
      for (int axis = 0; axis < 3; ++axis)
        ball.position[axis] += rounded<Position>(at[axis]);
      if (i == 0) ball.motion = MotionType::static_body;
      rim.push_back(test::add(world, ball));
      tie(hub, rim.back(), at, {});
      if (i > 1) tie(rim[static_cast<std::size_t>(i) - 2], rim.back(), {0.1_m, {}, {}}, {});
    }
  }
  return world;
}

TEST(NetsOfBalls, AreTheSameOnEveryTarget) {
  const auto run = [](std::string_view target) {
    EXPECT_EQ(lanes::set_target(target), Status::ok);
    World world = wheels_of_balls();
    test::step(world, test::share_of(60));
    return world.hash().total;
  };
  const std::uint64_t expected = run("scalar");
  for (const std::string_view target : lanes::supported_targets())
    EXPECT_EQ(run(target), expected) << target;
}

// Two hundred boxes in one place push each other out without exploding.
TEST(DeepOverlap, SeparatesAtABoundedSpeed) {
  World world = test::make_world({.pair_capacity = 40000, .contact_capacity = 20000});
  std::vector<BodyHandle> boxes;
  for (int i = 0; i < 150; ++i) {
    BodyDef def =
        test::dynamic_body(Shape::box(0.3_m, 0.2_m, 0.25_m), Position::from_ratio(i % 7, 50),
                           Position::from_ratio(i % 11, 50), Position::from_ratio(i % 13, 50));
    def.gravity_scale = {};
    boxes.push_back(test::add(world, def));
  }
  test::step(world, test::share_of(120));
  for (const BodyHandle box : boxes) {
    const Vec3<Velocity> v = world.velocity(box);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_LT(abs(v[axis]), 60_mps);
  }
}

}  // namespace
}  // namespace lockstone
