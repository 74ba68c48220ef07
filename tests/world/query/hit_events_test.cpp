// Hits: impacts above a threshold, with place and impulses, by each of the ways in which a world
// solves an impact.
#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/mesh.h>
#include <lockstone/rollback_history.h>
#include <lockstone/testing/floating.h>
#include <lockstone/thread_pool.h>

#include "tests/support/workload.h"
#include "tests/world/random_commands.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

BodyDef hitting(const Shape& shape, Position x, Position y, Position z) {
  BodyDef def = test::dynamic_body(shape, x, y, z);
  def.events.hit_speed = SolverVelocity::from_integer(1);
  return def;
}

// Eight metres square, of 32 triangles.
AssetPtr make_grid() {
  std::vector<Vec3<Length>> vertices;
  for (int x = 0; x < 5; ++x)
    for (int z = 0; z < 5; ++z)
      vertices.push_back({Length::from_integer(2 * x - 4), {}, Length::from_integer(2 * z - 4)});
  std::vector<TriangleIndices> triangles;
  for (std::uint32_t x = 0; x < 4; ++x) {
    for (std::uint32_t z = 0; z < 4; ++z) {
      const std::uint32_t corner = 5 * x + z;
      triangles.push_back({corner, corner + 1, corner + 5});
      triangles.push_back({corner + 1, corner + 6, corner + 5});
    }
  }
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

AssetPtr make_pair_of_balls() {
  CompoundChild children[2];
  children[0].shape = children[1].shape = Shape::sphere(0.4_m);
  children[0].position = {-0.8_m, {}, {}};
  children[1].position = {0.8_m, {}, {}};
  return Compound::build(children).compound;
}

struct Hit {
  HitEvent event;
  double momentum = 0;  // of the body, before the tick, and after, against gravity: N·s upwards
};

// Steps until the first hit, at most `ticks`; the change of the body's momentum in that tick
// without gravity's part, along y.
Hit first_hit(World& world, BodyHandle body, int ticks) {
  for (int i = 0; i < ticks; ++i) {
    const double before = to_double(world.velocity(body).y);
    (void)world.step();
    if (hit_events(world).empty()) continue;
    const double gain = to_double(world.velocity(body).y) - before + 9.81 / 60;
    return {hit_events(world).front(), gain * to_double(world.mass(body))};
  }
  ADD_FAILURE() << "no hit";
  return {};
}

void expect_lands(World& world, BodyHandle body, BodyHandle ground, double reach) {
  const Hit hit = first_hit(world, body, 120);
  EXPECT_EQ(hit.event.a, body);
  EXPECT_EQ(hit.event.b, ground);
  EXPECT_NEAR(to_double(hit.event.approach_speed), 4.43, 0.2);  // one metre: √(2g)
  EXPECT_NEAR(to_double(hit.event.normal.y), -1, 1e-6);
  EXPECT_NEAR(to_double(hit.event.point.x), 0, reach);
  EXPECT_NEAR(to_double(hit.event.point.y), 0, 1e-3);
  EXPECT_NEAR(to_double(hit.event.point.z), 0, reach);
  EXPECT_NEAR(to_double(hit.event.normal_impulse) / hit.momentum, 1, 1e-4);
  EXPECT_FALSE(hit.event.was_stopped);
}

TEST(HitEvents, TellTheImpulseThatABodyTookInTheTick) {
  World world = test::make_world();
  const BodyHandle ground = test::add_ground(world);
  const BodyHandle box = test::add(world, hitting(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 1.5_m, {}));
  expect_lands(world, box, ground, 1e-3);
}

TEST(HitEvents, TellItOfIteratedIslands) {
  World world = test::make_world(
      {.body_capacity = 16, .pair_capacity = 64, .contact_capacity = 64, .converged_contacts = 0});
  const BodyHandle ground = test::add_ground(world);
  const BodyHandle box = test::add(world, hitting(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 1.5_m, {}));
  expect_lands(world, box, ground, 0.1);  // its corners share the push unevenly
}

TEST(HitEvents, TellItOfBouncesWithinATick) {
  for (const Shape& shape : {Shape::sphere(0.5_m), Shape::box(0.5_m, 0.5_m, 0.5_m)}) {
    World world = test::make_world();
    const BodyHandle ground = test::add_ground(world);
    BodyDef def = hitting(shape, {}, 1.5_m, {});
    def.material.restitution = 0.8_r;
    const BodyHandle body = test::add(world, def);
    expect_lands(world, body, ground, 1e-3);
  }
}

// A ball that rolls along with a contact without restitution is left to the solver, which then
// bounces off balls by itself.
TEST(HitEvents, TellItOfBallsInTheSolver) {
  World world = test::make_world();
  BodyDef floor;
  floor.motion = MotionType::static_body;
  floor.shape = Shape::box(20_m, 1_m, 20_m);
  floor.position.y = -1_m;
  test::add(world, floor);
  BodyDef def = hitting(Shape::sphere(0.5_m), {}, 0.5_m, {});
  def.material.friction = {};
  def.material.restitution = 1_r;
  def.material.restitution_rule = CombineRule::multiply;
  const BodyHandle resting = test::add(world, def);
  def.position.x = -2_m;
  def.velocity.x = 3_mps;
  const BodyHandle rolling = test::add(world, def);
  int hits = 0;
  for (int i = 0; i < 60; ++i) {
    const double before = to_double(world.velocity(resting).x);
    (void)world.step();
    for (const HitEvent& hit : hit_events(world)) {
      ++hits;
      EXPECT_EQ(hit.a, resting);
      EXPECT_EQ(hit.b, rolling);
      const double gain = to_double(world.velocity(resting).x) - before;
      EXPECT_NEAR(to_double(hit.normal_impulse) / (gain * to_double(world.mass(resting))), 1, 1e-3);
      EXPECT_NEAR(to_double(hit.approach_speed), 3, 1e-2);
      EXPECT_NEAR(gain, 3, 1e-2);
    }
  }
  EXPECT_EQ(hits, 1);
}

TEST(HitEvents, TellItOfABodyThatIsStoppedOnItsWay) {
  WorldDef def{.body_capacity = 8, .pair_capacity = 64, .contact_capacity = 64};
  def.gravity = {};
  World world = test::make_world(def);
  BodyDef wall;
  wall.motion = MotionType::static_body;
  wall.shape = Shape::box(0.01_m, 2_m, 2_m);
  wall.material.tag = 7;
  const BodyHandle wall_handle = test::add(world, wall);
  BodyDef shot = hitting(Shape::sphere(0.05_m), -3_m, 0.25_m, {});
  shot.velocity.x = 200_mps;
  shot.material.tag = 9;
  const BodyHandle bullet = test::add(world, shot);
  std::vector<HitEvent> hits;
  for (int i = 0; i < 5; ++i) {
    (void)world.step();
    hits.insert(hits.end(), hit_events(world).begin(), hit_events(world).end());
  }
  ASSERT_EQ(hits.size(), 1U);
  EXPECT_TRUE(hits[0].was_stopped);
  EXPECT_EQ(hits[0].a, bullet);
  EXPECT_EQ(hits[0].b, wall_handle);
  EXPECT_EQ(hits[0].tag_a, 9U);
  EXPECT_EQ(hits[0].tag_b, 7U);
  EXPECT_NEAR(to_double(hits[0].approach_speed), 200, 1e-3);
  EXPECT_NEAR(to_double(hits[0].point.x), -0.01, 2e-3);
  EXPECT_NEAR(to_double(hits[0].point.y), 0.25, 1e-3);
  const double gone = 200 - to_double(world.velocity(bullet).x);
  EXPECT_NEAR(to_double(hits[0].normal_impulse) / (gone * to_double(world.mass(bullet))), 1, 1e-3);
}

// A box that slides as it lands: friction against its motion, at most μ times the push.
TEST(HitEvents, TellTheFrictionThatSlowedABody) {
  for (const std::uint32_t converged : {0U, 2048U}) {
    World world = test::make_world({.body_capacity = 16,
                                    .pair_capacity = 64,
                                    .contact_capacity = 64,
                                    .converged_contacts = converged});
    test::add_ground(world);
    BodyDef def = hitting(Shape::box(1_m, 0.1_m, 1_m), {}, 0.6_m, {});
    def.velocity.x = 8_mps;
    def.material.friction = 0.3_r;
    const BodyHandle box = test::add(world, def);
    for (int i = 0; i < 60; ++i) {
      const double before = to_double(world.velocity(box).x);
      (void)world.step();
      if (hit_events(world).empty()) continue;
      const HitEvent& hit = hit_events(world).front();
      const double lost = (before - to_double(world.velocity(box).x)) * to_double(world.mass(box));
      EXPECT_NEAR(to_double(hit.friction_impulse.x) / lost, 1, 1e-3);  // on the ground
      EXPECT_GT(lost, 0.25 * to_double(hit.normal_impulse));
      break;
    }
  }
}

TEST(HitEvents, AreThoseOfBodiesThatAskForThem) {
  World world = test::make_world();
  test::add_ground(world);
  const BodyHandle mute =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 1.5_m, {}));
  BodyDef def = hitting(Shape::box(0.5_m, 0.5_m, 0.5_m), 3_m, 1.5_m, {});
  def.events.hit_speed = SolverVelocity::from_integer(10);  // more than it will reach
  test::add(world, def);
  for (int i = 0; i < 120; ++i) {
    (void)world.step();
    EXPECT_TRUE(hit_events(world).empty());
  }
  ASSERT_EQ(world.apply(SetEvents{mute, {true, SolverVelocity::from_integer(1)}}), Status::ok);
  EXPECT_EQ(world.body(mute).events.hit_speed, SolverVelocity::from_integer(1));
  ASSERT_EQ(world.apply(Teleport{mute, {{}, 2_m, {}}, {}}), Status::ok);
  (void)first_hit(world, mute, 120);
}

TEST(HitEvents, NoneComeFromRest) {
  World world = test::make_world();
  test::add_ground(world);
  for (int i = 0; i < 5; ++i)
    test::add(world,
              hitting(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, Position::from_ratio(1 + 2 * i, 2), {}));
  for (int i = 0; i < 200; ++i) {
    (void)world.step();
    EXPECT_TRUE(hit_events(world).empty());
  }
}

TEST(HitEvents, NameTheTriangleAndTheChild) {
  const AssetPtr grid = make_grid(), pair = make_pair_of_balls();
  auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{grid, pair});
  World world = test::make_world({}, assets);
  BodyDef floor;
  floor.motion = MotionType::static_body;
  floor.shape = grid->shape();
  const BodyHandle mesh = test::add(world, floor);
  test::add(world, hitting(pair->shape(), 1.3_m, 2_m, 0.4_m));
  unsigned children = 0;
  for (int i = 0; i < 120; ++i) {
    (void)world.step();
    for (const HitEvent& hit : hit_events(world)) {
      EXPECT_EQ(hit.b, mesh);
      const ClosestHit nearest = world.closest_point(hit.point, 1_m, {.ignore = hit.a});
      EXPECT_EQ(nearest.body, mesh);
      EXPECT_EQ(nearest.part, hit.part_b);
      EXPECT_NE(hit.part_b, 0U);
      children |= 1U << hit.part_a;
    }
  }
  EXPECT_EQ(children, 3U);  // both landed
}

TEST(ContactEvents, AreThoseOfBodiesThatHaveThem) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef def = test::dynamic_body(Shape::sphere(0.5_m), {}, 0.5_m, {});
  const BodyHandle loud = test::add(world, def);
  def.position.x = 3_m;
  def.events.contacts = false;
  test::add(world, def);
  (void)world.step();
  ASSERT_EQ(world.events().size(), 1U);
  EXPECT_EQ(world.events()[0].a, loud);
}

TEST(EventSettings, AreCheckedSavedAndForgottenWithTheBody) {
  World world = test::make_world();
  BodyDef def = hitting(Shape::sphere(0.5_m), {}, {}, {});
  def.events.hit_speed = SolverVelocity::from_integer(501);
  EXPECT_EQ(world.create_body(def).status(), Status::invalid_argument);
  EXPECT_EQ(world.explain(def).field, "body.events.hit_speed");
  def.events = {false, SolverVelocity::from_integer(2), true};
  const BodyHandle body = test::add(world, def);
  const SetEvents wrong{body, {true, SolverVelocity::from_raw(-1)}};
  EXPECT_EQ(world.apply(wrong), Status::invalid_argument);
  EXPECT_EQ(world.explain(Command(wrong)).field, "SetEvents.hit_speed");
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::canonical);
  ASSERT_EQ(world.apply(SetEvents{body, {}}), Status::ok);
  ASSERT_EQ(world.load(SnapshotKind::canonical, saved), Status::ok);
  EXPECT_EQ(world.body(body).events, def.events);
  EXPECT_EQ(world.apply(DestroyBody{body}), Status::ok);
  EXPECT_FALSE(world.find_fault());
  EXPECT_EQ(world.apply(SetEvents{body, {}}), Status::stale_handle);
}

// The same hits whatever steps the world: another broad phase, threads, derived data dropped, a
// replay from the start, a rollback with memory.
TEST(HitEvents, AreTheSameOnEveryPath) {
  const auto make = [](BroadPhaseKind broad_phase) {
    World world = test::make_world({.body_capacity = 128,
                                    .pair_capacity = 4096,
                                    .contact_capacity = 2048,
                                    .broad_phase = broad_phase});
    test::fill_with_random_bodies(world, 11, 60);
    for (std::uint32_t i = 0; i < world.body_limit(); i += 2)
      EXPECT_EQ(world.apply(SetEvents{world.body_at(i),
                                      {i % 4 != 0, SolverVelocity::from_ratio(1, 2), i % 6 == 0}}),
                Status::ok);
    return world;
  };
  World plain = make(BroadPhaseKind::tree), sweeping = make(BroadPhaseKind::sweep_and_prune);
  World dropping = make(BroadPhaseKind::tree), shared = make(BroadPhaseKind::tree);
  World rolled = make(BroadPhaseKind::tree);
  RollbackHistory history(rolled, 8);
  ThreadPool pool(3);
  shared.set_task_runner(&pool, TaskPieces::smallest);
  std::vector<std::byte> start(rolled.snapshot_bytes_max(SnapshotKind::native));
  std::size_t hits = 0, persisting = 0;
  for (int tick = 0; tick < test::share_of(240); ++tick) {
    const std::size_t size = rolled.save(SnapshotKind::native, start);
    (void)rolled.apply(ApplyImpulse{rolled.body_at(5), {{}, 900_Ns, {}}});
    for (int i = 0; i < 3; ++i)
      (void)history.step();
    ASSERT_EQ(rolled.load(SnapshotKind::native, ByteView(start).first(size)), Status::ok);
    (void)history.step();
    dropping.drop_derived();
    for (World* world : {&plain, &sweeping, &dropping, &shared})
      (void)world->step();
    hits += hit_events(plain).size();
    persisting += static_cast<std::size_t>(
        std::ranges::count(plain.events(), EventKind::contact_persist, &ContactEvent::kind));
    for (const World* world : {&sweeping, &dropping, &shared, &rolled}) {
      ASSERT_EQ(test::told_by(plain), test::told_by(*world)) << "at tick " << tick;
      ASSERT_EQ(plain.hash().total, world->hash().total);
    }
  }
  EXPECT_GE(hits, static_cast<std::size_t>(test::share_of(21)));
  EXPECT_GE(persisting,
            static_cast<std::size_t>(test::share_of(60)));  // most come late, when bodies lie
}

}  // namespace
}  // namespace lockstone
