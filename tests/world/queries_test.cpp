#include <array>

#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

TEST(CastRay, FindsTheNearestBody) {
  World world = test::make_world();
  const BodyHandle far = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 8_m, {}, {}));
  const BodyHandle near = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 4_m, {}, {}));
  const RayHit hit = world.cast_ray({}, {16_m, {}, {}});
  EXPECT_EQ(hit.body, near);
  EXPECT_NEAR(metres(hit.point.x), 3.5, 1e-5);
  EXPECT_EQ(hit.normal.x, Unit::from_integer(-1));
  EXPECT_EQ(world.cast_ray({}, {16_m, {}, {}}, {.ignore = near}).body, far);
  EXPECT_TRUE(world.cast_ray({}, {-16_m, {}, {}}).body.is_null());
}

TEST(CastRay, SeesOnlyTheMaskAndTriggersWhenAsked) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), 4_m, {}, {});
  def.is_trigger = true;
  def.filter.category = 4;
  const BodyHandle zone = test::add(world, def);
  EXPECT_TRUE(world.cast_ray({}, {16_m, {}, {}}).body.is_null());
  EXPECT_EQ(world.cast_ray({}, {16_m, {}, {}}, {.triggers = true}).body, zone);
  EXPECT_TRUE(world.cast_ray({}, {16_m, {}, {}}, {.mask = 3, .triggers = true}).body.is_null());
}

TEST(CastRay, SeesABodyWhereTheLastCommandPutIt) {
  World world = test::make_world();
  const BodyHandle ball = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 4_m, {}, {}));
  ASSERT_EQ(world.apply(Teleport{ball, {-4_m, {}, {}}, Quat{}}), Status::ok);
  EXPECT_EQ(world.cast_ray({}, {-16_m, {}, {}}).body, ball);
  ASSERT_EQ(world.apply(DestroyBody{ball}), Status::ok);
  EXPECT_TRUE(world.cast_ray({}, {-16_m, {}, {}}).body.is_null());
}

TEST(CastRay, GivesTheSameAnswerAfterDerivedDataIsRebuilt) {
  World world = test::make_world();
  test::fill_with_random_bodies(world, test::run_seed(), 150);
  test::step(world, 60);
  World copy = test::make_world();
  ASSERT_EQ(copy.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
            Status::ok);
  test::Random random;
  const auto coordinate = [&] {
    return Length::from_raw(static_cast<std::int32_t>(random.between(-(8 << 20), 8 << 20)));
  };
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3<Length> ray{coordinate(), coordinate(), coordinate()};
    const Vec3<Position> from{rounded<Position>(coordinate()), 6_m,
                              rounded<Position>(coordinate())};
    const RayHit a = world.cast_ray(from, ray), b = copy.cast_ray(from, ray);
    EXPECT_EQ(a.body, b.body);
    EXPECT_EQ(a.fraction, b.fraction);
    hits += a.body.is_null() ? 0 : 1;
  }
  EXPECT_GT(hits, 50);
}

TEST(OverlapSphere, GivesTheLowestIndicesInOrder) {
  World world = test::make_world();
  std::vector<BodyHandle> balls;
  for (int i = 0; i < 8; ++i) {
    balls.push_back(test::add(
        world, test::dynamic_body(Shape::sphere(0.5_m), Position::from_integer(i), {}, {})));
  }
  std::array<BodyHandle, 3> few{};
  ASSERT_EQ(world.overlap_sphere({}, 4.2_m, few), 3U);
  EXPECT_EQ(few[0], balls[0]);
  EXPECT_EQ(few[2], balls[2]);
  std::array<BodyHandle, 16> many{};
  EXPECT_EQ(world.overlap_sphere({}, 4.2_m, many), 5U);  // centres to 4.7 m
}

// A mixed world after some steps and some commands since.
World world_in_motion(BroadPhaseKind broad_phase) {
  World world = test::make_world({.body_capacity = 512,
                                  .pair_capacity = 8192,
                                  .contact_capacity = 4096,
                                  .broad_phase = broad_phase});
  test::Random random;
  test::fill_with_random_bodies(world, random.next(), 100);
  test::step(world, 30);
  for (std::uint32_t index = 1; index < 60; ++index) {
    const BodyHandle body = world.body_at(index);
    const auto category = 1U << random.between(0, 3);
    EXPECT_EQ(world.apply(SetFilter{body, {.category = category}}), Status::ok);
    if (index % 3 != 0) continue;
    const Position x = Position::from_ratio(random.between(-400, 400), 100);
    EXPECT_EQ(world.apply(Teleport{body, {x, 1_m, {}}, {}}), Status::ok);
    if (index % 2 != 0) continue;
    EXPECT_EQ(world.apply(DestroyBody{body}), Status::ok);
  }
  return world;
}

TEST(Queries, AnswerTheSameFromBothBroadPhases) {
  const World tree = world_in_motion(BroadPhaseKind::tree);
  const World sweep = world_in_motion(BroadPhaseKind::sweep_and_prune);
  test::Random random;
  int hits = 0;
  for (int round = 0; round < 500; ++round) {
    const auto place = [&] { return Position::from_ratio(random.between(-500, 500), 100); };
    const auto reach = [&] { return Length::from_ratio(random.between(-800, 800), 100); };
    const QueryFilter filter{.mask = static_cast<std::uint32_t>(random.between(0, 15))};
    const Position x = place(), y = place(), z = place();
    const Length u = reach(), v = reach(), w = reach();
    const RayHit one = tree.cast_ray({x, y, z}, {u, v, w}, filter);
    const RayHit other = sweep.cast_ray({x, y, z}, {u, v, w}, filter);
    ASSERT_EQ(one.body, other.body);
    ASSERT_EQ(one.fraction, other.fraction);
    hits += one.body.is_null() ? 0 : 1;
    std::array<BodyHandle, 5> found{}, others{};
    ASSERT_EQ(tree.overlap_sphere({x, y, z}, 2_m, found, filter),
              sweep.overlap_sphere({x, y, z}, 2_m, others, filter));
    ASSERT_EQ(found, others);
  }
  EXPECT_GT(hits, 0);
}

}  // namespace
}  // namespace lockstone
