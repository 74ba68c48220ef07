// Speed scenes in plain numbers play as the worlds that they were read from, and engines take turns
// on them.
#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/workload.h"
#include "tools/bench/beside/beside_run.h"
#include "tools/bench/beside/many_islands.h"
#include "tools/bench/beside/scene_of_world.h"
#include "tools/bench/general/watch.h"
#include "tools/fuzz/real.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

std::vector<Triple> places_after(const SpeedScene& scene, int ticks) {
  World world = scene.make(BroadPhaseKind::tree);
  for (int tick = 0; tick < ticks; ++tick) {
    if (scene.drive != nullptr) scene.drive(world);
    EXPECT_EQ(world.step().status, Status::ok);
  }
  std::vector<Triple> places;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (body.is_null() || world.body(body).motion != MotionType::dynamic) continue;
    const fuzz::Real3 at = fuzz::real(world.position(body));
    places.push_back({at.x, at.y, at.z});
  }
  return places;
}

bool is_there_at_end(const GeneralScene& scene, const GeneralBody& body) {
  return body.moves() && body.from < scene.ticks && body.until >= scene.ticks;
}

std::vector<Triple> places_after(const GeneralScene& scene) {
  const auto engine = lockstone_general().make(scene, 4);
  const std::vector<GeneralChange> changes = changes_of(scene);
  for (int tick = 0; tick < scene.ticks; ++tick) {
    begin_tick(*engine, scene, changes, tick);
    engine->step();
  }
  EXPECT_TRUE(engine->had_room());
  std::vector<Triple> places;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i)
    if (is_there_at_end(scene, scene.bodies[i]))
      places.push_back(engine->state(static_cast<int>(i)).position);
  return places;
}

TEST(SceneOfWorld, PlaysAsTheWorldDoes) {
  constexpr int k_ticks = 3;
  constexpr std::array k_names{"joint-grid", "mixed-pile",   "washer",
                               "junkyard",   "ragdoll-rain", "figure-rain"};
  for (const char* name : std::span(k_names).first(test::share_of(k_names.size()))) {
    const SpeedScene& scene = *find_speed_scene(name);
    const SceneOfWorld plain = scene_of_world(scene, k_ticks);
    ASSERT_EQ(plain.lacking, "") << name;
    EXPECT_EQ(places_after(plain.scene), places_after(scene, k_ticks)) << name;
  }
}

// A figure comes every eight ticks and goes after sixteen; a plate under it turns back each time.
World make_changing(BroadPhaseKind broad_phase) {
  WorldDef def = speed_def(broad_phase, 64, 1024, 512);
  def.joint_capacity = 64;
  World world = make_speed_world(def);
  scenes::add_ground(world, 20_m);
  BodyDef plate = scenes::loose(Shape::box(2_m, 0.1_m, 2_m), {{}, 0.4_m, {}});
  plate.motion = MotionType::kinematic;
  scenes::add(world, plate);
  return world;
}

void change_it(World& world) {
  constexpr std::uint64_t k_every = 8;
  if (world.tick() % k_every != 0) return;
  const std::uint64_t round = world.tick() / k_every;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (!body.is_null() && round > 1 && world.body(body).user_data == round - 1)
      scenes::order(world, DestroyBody{body});
    else if (!body.is_null() && world.body(body).motion == MotionType::kinematic)
      scenes::order(world, SetAngularVelocity{body, {{}, round % 2 == 0 ? 1_rps : -1_rps, {}}});
  }
  scenes::add_ragdoll(world, {millimetres(300 * static_cast<int>(round)), 1.6_m, {}}, round + 1);
}

TEST(SceneOfWorld, FollowsBodiesThatComeAndGo) {
  constexpr int k_ticks = 60;
  const SpeedScene scene{"changing", "", k_ticks, make_changing, change_it};
  const SceneOfWorld plain = scene_of_world(scene, k_ticks);
  ASSERT_EQ(plain.lacking, "");
  EXPECT_EQ(plain.scene.joints.size(), 8 * 9U);
  EXPECT_GT(plain.scene.moves.size(), 5U);
  const std::vector<Triple> places = places_after(plain.scene);
  EXPECT_EQ(places.size(), 2 * 10U);
  EXPECT_EQ(places, places_after(scene, k_ticks));
}

World make_sleeping(BroadPhaseKind broad_phase) {
  World world = make_speed_world(speed_def(broad_phase, 8, 64, 64));
  scenes::add_ground(world, 5_m);
  scenes::add(world, scenes::loose(Shape::box(0.5_m, 0.5_m, 0.5_m), {{}, 0.5_m, {}}));
  while (world.step().asleep_bodies == 0)
    LKS_CHECK(world.tick() < 600);
  return world;
}

World make_cone(BroadPhaseKind broad_phase) {
  World world = make_speed_world(speed_def(broad_phase, 8, 64, 64));
  scenes::add(world, scenes::loose(Shape::cone(1_m, 0.5_m), {}));
  return world;
}

TEST(SceneOfWorld, NamesThePartThatPlainNumbersLack) {
  const auto lacking = [](World (*make)(BroadPhaseKind), bool asks) {
    return scene_of_world({"", "", 1, make, nullptr, asks}, 1).lacking;
  };
  EXPECT_EQ(lacking(make_changing, true), "queries");
  EXPECT_EQ(lacking(make_sleeping, false), "bodies that sleep at the beginning");
  EXPECT_EQ(lacking(make_cone, false), "a shape: cone");
  EXPECT_EQ(lacking(make_changing, false), "");
}

TEST(Beside, TakesTurnsOnOneScene) {
  BesideOptions options;
  options.engines = {{lockstone_general(), "a", 4}, {lockstone_general(), "b", 4}};
  options.repeats = 2;
  const SpeedScene speed{"changing", "", 60, make_changing, change_it};
  const GeneralScene scene = scene_of_world(speed, 25).scene;
  const BesideRun run = play_beside(scene, options);
  ASSERT_EQ(run.figures.size(), 2U);
  double height = 0;
  const std::vector<Triple> places = places_after(scene);
  for (const Triple& place : places)
    height += place[1] / static_cast<double>(places.size());
  for (const BesideFigures& figures : run.figures) {
    EXPECT_TRUE(figures.played && figures.had_room);
    EXPECT_EQ(figures.ticks.size(), 25U);
    EXPECT_GT(figures.mean(), 0);
    EXPECT_NEAR(figures.height, height, 1e-12);
  }
}

TEST(Beside, MakesWholeIslandsThatDoNotSleep) {
  for (const IslandKind& kind : island_kinds()) {
    const GeneralScene scene = make_islands(kind, 100);
    const auto moving = std::ranges::count_if(scene.bodies, &GeneralBody::moves);
    EXPECT_EQ(moving, 100) << kind.name;
    EXPECT_FALSE(scene.may_sleep);
    EXPECT_EQ(std::ranges::count_if(make_islands(kind, 1).bodies, &GeneralBody::moves),
              kind.bodies);
  }
}

}  // namespace
}  // namespace lockstone::bench
