#include <algorithm>
#include <array>
#include <cmath>
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

// The extents of a turned box along the world's axes, in floating point.
Vec3<double> extents_of(const Vec3<double>& half, const Quat& turn) {
  const Mat3 m = to_matrix(turn);
  Vec3<double> reach{};
  for (int column = 0; column < 3; ++column) {
    for (int row = 0; row < 3; ++row)
      reach[row] += half[column] * std::abs(testing::to_double(m.column(column)[row]));
  }
  return reach;
}

TEST(BodiesInBox, AreThoseWhoseBoundsOverlapIt) {
  World world = test::make_world();
  test::Random random;
  const auto within = [&](int most) {
    return Position::from_ratio(random.between(-most, most), 64);
  };
  std::vector<Quat> turns;
  const Vec3<double> half{0.5, 1, 1.5};
  for (int i = 0; i < 200; ++i) {
    const Position x = within(640);
    const Position y = within(640);
    const Position z = within(640);
    BodyDef def = test::dynamic_body(Shape::box(0.5_m, 1_m, 1.5_m), x, y, z);
    const auto part = [&] {
      return Unit::from_raw(static_cast<std::int32_t>(random.between(-(1 << 29), 1 << 29)));
    };
    const Unit i_part = part();
    const Unit j_part = part();
    const Unit k_part = part();
    def.orientation = normalized(Quat{i_part, j_part, k_part, Unit::from_ratio(1, 4)});
    turns.push_back(def.orientation);
    test::add(world, def);
  }
  std::size_t found_in_all = 0;
  for (int i = 0; i < 200; ++i) {
    Vec3<Position> lower, upper;
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = within(640);
      upper[axis] = lower[axis] + abs(within(200));
    }
    std::array<BodyHandle, 256> found{};
    const std::size_t count = bodies_in_box(world, lower, upper, found);
    found_in_all += count;
    std::size_t next = 0;
    for (std::uint32_t index = 0; index < 200; ++index) {
      const bool listed = next < count && found[next].index == index;
      next += listed ? 1 : 0;
      const Vec3<double> reach = extents_of(half, turns[index]);
      double apart = -100;
      for (int axis = 0; axis < 3; ++axis) {
        const double at = metres(world.position(world.body_at(index))[axis]);
        apart = std::max(apart, metres(lower[axis]) - (at + reach[axis]));
        apart = std::max(apart, at - reach[axis] - metres(upper[axis]));
      }
      EXPECT_TRUE(apart >= -1e-7 || listed) << apart;
      EXPECT_TRUE(apart <= 1e-5 || !listed) << apart;
    }
    EXPECT_EQ(next, count);  // all of them, in order
  }
  EXPECT_GT(found_in_all, 200u);
}

TEST(BodiesInBox, AreTheFirstThatFitAndPassTheFilter) {
  World world = test::make_world();
  for (int i = 0; i < 4; ++i)
    test::add(world, test::dynamic_body(Shape::sphere(0.5_m), Position::from_integer(i), {}, {}));
  const Vec3<Position> corner{10_m, 10_m, 10_m};
  std::array<BodyHandle, 2> found{};
  ASSERT_EQ(bodies_in_box(world, -corner, corner, found), 2U);
  EXPECT_EQ(found[1], world.body_at(1));
  const BodyHandle first = world.body_at(0);
  ASSERT_EQ(bodies_in_box(world, -corner, corner, found, {.ignore = first}), 2U);
  EXPECT_EQ(found[0], world.body_at(1));
  // The corner of the bounds of a ball holds nothing of it.
  const Vec3<Position> beside{-0.49_m, 0.49_m, 0.49_m};
  ASSERT_EQ(bodies_in_box(world, beside, beside, found), 1U);
  EXPECT_EQ(found[0], first);
  EXPECT_EQ(world.bodies_at(beside, found), 0U);
  EXPECT_EQ(bodies_in_box(world, beside, beside, {}), 0U);
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

// Every query with a filter as data, beside the same one with a callback that decides alike.
TEST(Queries, FilterByTagAndListAsACallbackDoes) {
  World world = world_in_motion(BroadPhaseKind::tree);
  test::Random random;
  std::vector<std::uint32_t> tags(world.body_limit());
  for (std::uint32_t index = 1; index < 100; ++index) {
    const BodyHandle body = world.body_at(index);
    if (body.is_null()) continue;
    Surface surface;
    surface.tag = tags[index] = static_cast<std::uint32_t>(random.between(0, 7));
    ASSERT_EQ(world.apply(SetMaterial{body, surface}), Status::ok);
  }
  struct Rule {
    const std::vector<std::uint32_t>& tags;
    const QueryFilter& filter;
  };
  const auto accept = [](void* context, BodyHandle body) {
    const Rule& rule = *static_cast<Rule*>(context);
    const std::uint32_t tag = rule.tags[body.index];
    const bool listed = std::ranges::find(rule.filter.bodies, body) != rule.filter.bodies.end();
    return (tag & rule.filter.tag_mask) == (rule.filter.tag & rule.filter.tag_mask) &&
           listed == rule.filter.only_listed;
  };
  std::size_t all = 0;
  std::size_t some = 0;
  for (int i = 0; i < 200; ++i) {
    std::vector<BodyHandle> list;
    for (int k = 0; k < 20; ++k)
      list.push_back(world.body_at(static_cast<std::uint32_t>(random.between(0, 99))));
    QueryFilter data;
    data.tag_mask = static_cast<std::uint32_t>(random.between(0, 3));
    data.tag = static_cast<std::uint32_t>(random.between(0, 7));
    data.bodies = list;
    data.only_listed = random.between(0, 1) == 1;
    Rule rule{tags, data};
    const QueryFilter asked{.accept = accept, .context = &rule};
    const Vec3<Position> low{-20_m, -20_m, -20_m};
    std::array<BodyHandle, 128> a{}, b{};
    const std::size_t count = world.overlap_sphere({}, 8_m, a, data);
    EXPECT_EQ(count, world.overlap_sphere({}, 8_m, b, asked));
    EXPECT_EQ(a, b);
    EXPECT_EQ(bodies_in_box(world, low, -low, a, data), bodies_in_box(world, low, -low, b, asked));
    EXPECT_EQ(a, b);
    const Position x = Position::from_ratio(random.between(-400, 400), 100);
    const Vec3<Length> down{{}, -20_m, {}};
    EXPECT_EQ(world.cast_ray({x, 10_m, {}}, down, data).body,
              world.cast_ray({x, 10_m, {}}, down, asked).body);
    const ShapeCast cast{Shape::sphere(0.5_m), {{x, 10_m, {}}, {}}, down};
    EXPECT_EQ(world.cast_shape(cast, data).body, world.cast_shape(cast, asked).body);
    EXPECT_EQ(world.closest_point({x, 1_m, {}}, 9_m, data).body,
              world.closest_point({x, 1_m, {}}, 9_m, asked).body);
    some += count;
    all += world.overlap_sphere({}, 8_m, a);
  }
  EXPECT_GT(some, 500u);
  EXPECT_GT(all, 2 * some);
}

TEST(Queries, ThatLookAtAnEmptyListAloneSeeNothing) {
  const World world = world_of_three();
  EXPECT_TRUE(world.cast_ray({}, {12_m, {}, {}}, {.only_listed = true}).body.is_null());
  const BodyHandle first = world.body_at(0);
  const std::array listed{world.body_at(1), first};
  EXPECT_EQ(world.cast_ray({}, {12_m, {}, {}}, {.bodies = listed, .only_listed = true}).body,
            first);
  EXPECT_TRUE(world.cast_ray({}, {12_m, {}, {}}, {.bodies = listed}).body.is_null());
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
