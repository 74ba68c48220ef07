#include <array>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

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
  for (int i = 0; i < 2000; ++i) {
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

Vec3<Position> random_place(test::Random& random) {
  const auto place = [&] { return Position::from_ratio(random.between(-500, 500), 100); };
  const Position x = place(), y = place(), z = place();
  return {x, y, z};
}

Vec3<Length> random_way(test::Random& random) {
  const auto reach = [&] { return Length::from_ratio(random.between(-800, 800), 100); };
  const Length x = reach(), y = reach(), z = reach();
  return {x, y, z};
}

// Asked by two threads at once, and each ray by itself.
TEST(Queries, OfManyRaysAnswerAsOneByOne) {
  const World world = world_in_motion(BroadPhaseKind::tree);
  test::Random random;
  std::vector<Ray> rays(300);
  for (Ray& ray : rays) {
    ray.origin = random_place(random);
    ray.translation = random_way(random);
  }
  std::vector<RayHit> met(rays.size()), again(rays.size());
  std::thread other([&] { world.cast_rays(rays, again); });
  world.cast_rays(rays, met);
  other.join();
  int hits = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const RayHit one = world.cast_ray(rays[i].origin, rays[i].translation);
    hits += one.body.is_null() ? 0 : 1;
    for (const RayHit& hit : {met[i], again[i]}) {
      ASSERT_EQ(hit.body, one.body);
      ASSERT_EQ(hit.fraction, one.fraction);
      ASSERT_EQ(hit.point, one.point);
    }
  }
  EXPECT_GT(hits, 0);
}

TEST(Queries, OfManyCastsAnswerAsOneByOne) {
  const World world = world_in_motion(BroadPhaseKind::tree);
  test::Random random;
  std::vector<ShapeCast> casts(100);
  for (ShapeCast& cast : casts) {
    cast.shape = Shape::box(0.1_m, 0.3_m, 0.2_m);
    cast.start.position = random_place(random);
    cast.translation = random_way(random);
  }
  std::vector<ShapeHit> met(casts.size());
  world.cast_shapes(casts, met);
  int hits = 0;
  for (std::size_t i = 0; i < casts.size(); ++i) {
    const ShapeHit one = world.cast_shape(casts[i]);
    hits += one.body.is_null() ? 0 : 1;
    ASSERT_EQ(met[i].body, one.body);
    ASSERT_EQ(met[i].fraction, one.fraction);
    ASSERT_EQ(met[i].point, one.point);
  }
  EXPECT_GT(hits, 0);
}

World world_of_three() {
  World world = test::make_world();
  test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), 4_m, {}, {}));
  test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 8_m, {}, {}));
  BodyDef ground;
  ground.motion = MotionType::static_body;
  ground.shape = Shape::half_space();
  ground.position.y = -2_m;
  test::add(world, ground);
  return world;
}

TEST(CastShape, StopsWhereTheShapesTouch) {
  const World world = world_of_three();
  const ShapeCast cast{Shape::sphere(0.25_m), {}, {10_m, {}, {}}};
  const ShapeHit hit = world.cast_shape(cast);
  EXPECT_EQ(hit.body, world.body_at(0));
  EXPECT_NEAR(testing::to_double(hit.fraction) * 10, 4 - 0.5 - 0.25, 4e-6);
  EXPECT_EQ(hit.normal.x, Unit::from_integer(-1));
  EXPECT_NEAR(metres(hit.point.x), 3.5, 4e-6);
  ShapeHit all[4];
  ASSERT_EQ(world.cast_shape_all(cast, all), 2U);
  EXPECT_EQ(all[0].body, world.body_at(0));
  EXPECT_EQ(all[1].body, world.body_at(1));
  EXPECT_TRUE(world.cast_shape({Shape::sphere(0.25_m), {}, {2_m, {}, {}}}).body.is_null());
}

TEST(CastShape, MeetsAHalfSpaceWhereTheLowestPointDoes) {
  const World world = world_of_three();
  const ShapeHit hit =
      world.cast_shape({Shape::box(1_m, 0.5_m, 1_m), {{{}, {}, 10_m}, {}}, {64_m, -6_m, {}}});
  EXPECT_EQ(hit.body, world.body_at(2));
  EXPECT_NEAR(testing::to_double(hit.fraction), 1.5 / 6, 1e-6);
  EXPECT_EQ(hit.normal.y, Unit::from_integer(1));
}

TEST(CastShape, HitsAtOnceWhereItStartsInside) {
  const World world = world_of_three();
  const ShapeHit hit =
      world.cast_shape({Shape::sphere(0.25_m), {{4_m, {}, {}}, {}}, {1_m, {}, {}}});
  EXPECT_EQ(hit.body, world.body_at(0));
  EXPECT_EQ(hit.fraction, Unit{});
}

TEST(CastRay, ListsAllBodiesNearestFirstAndTellsWhetherAnyIsInTheWay) {
  const World world = world_of_three();
  RayHit all[3];
  ASSERT_EQ(world.cast_ray_all({12_m, {}, {}}, {-12_m, {}, {}}, all), 2U);
  EXPECT_EQ(all[0].body, world.body_at(1));
  EXPECT_EQ(all[1].body, world.body_at(0));
  ASSERT_EQ(world.cast_ray_all({12_m, {}, {}}, {-12_m, {}, {}}, std::span(all).first(1)), 1U);
  EXPECT_EQ(all[0].body, world.body_at(1));
  EXPECT_TRUE(world.is_ray_blocked({12_m, {}, {}}, {-12_m, {}, {}}));
  EXPECT_FALSE(world.is_ray_blocked({12_m, 5_m, {}}, {-12_m, {}, {}}));
}

TEST(CastRay, AsksTheCallerAboutEachBody) {
  const World world = world_of_three();
  BodyHandle refused = world.body_at(0);
  const auto accept = [](void* context, BodyHandle body) {
    return body != *static_cast<BodyHandle*>(context);
  };
  const RayHit hit = world.cast_ray({}, {12_m, {}, {}}, {.accept = accept, .context = &refused});
  EXPECT_EQ(hit.body, world.body_at(1));
}

TEST(ClosestPoint, IsTheNearestOfAllBodiesWithinReach) {
  const World world = world_of_three();
  const ClosestHit hit = world.closest_point({6.5_m, {}, {}}, 3_m);
  EXPECT_EQ(hit.body, world.body_at(1));
  EXPECT_NEAR(testing::to_double(hit.distance), 1, 2e-6);
  EXPECT_NEAR(metres(hit.point.x), 7.5, 2e-6);
  EXPECT_EQ(world.closest_point({5.5_m, {}, {}}, 3_m).body, world.body_at(0));
  EXPECT_EQ(world.closest_point({4_m, {}, {}}, 1_m).distance, Length{});
  EXPECT_TRUE(world.closest_point({6_m, 4_m, {}}, 1_m).body.is_null());
  EXPECT_EQ(world.closest_point({100_m, -1.5_m, {}}, 1_m).body, world.body_at(2));
}

TEST(BodiesAt, HoldThePoint) {
  const World world = world_of_three();
  BodyHandle found[2];
  ASSERT_EQ(world.bodies_at({8.25_m, {}, {}}, found), 1U);
  EXPECT_EQ(found[0], world.body_at(1));
  EXPECT_EQ(world.bodies_at({6_m, {}, {}}, found), 0U);
  ASSERT_EQ(world.bodies_at({500_m, -3_m, {}}, found), 1U);
  EXPECT_EQ(found[0], world.body_at(2));
}

}  // namespace
}  // namespace lockstone
