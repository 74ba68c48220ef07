// Every scene: builds, repeats itself, and is saved whole.
#include <array>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/parameter_name.h"
#include "tests/support/workload.h"
#include "tools/scenes/play.h"
#include "tools/scenes/scene.h"
#include "tools/scenes/scene_simulation.h"

namespace lockstone::scenes {
namespace {

constexpr std::uint64_t k_seed = 1;

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const SceneSummary& scene : list_scenes())
    result.emplace_back(scene.name);
  return result;
}

class EveryScene : public ::testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] std::unique_ptr<ScenePlay> play() const {
    return make_play(GetParam(), k_seed).value();
  }
  void SetUp() override {
    for (const SceneSummary& scene : list_scenes()) {
      if (scene.name == GetParam()) ticks_ = test::share_of(scene.golden_ticks);
    }
    ASSERT_GT(ticks_, 0U);
  }

  std::uint32_t ticks_ = 0;
};

TEST_P(EveryScene, RepeatsItself) {
  const auto first = play(), second = play();
  for (std::uint32_t tick = 0; tick < ticks_; ++tick) {
    first->step();
    second->step();
    ASSERT_EQ(first->simulation().hash(), second->simulation().hash()) << "after tick " << tick;
    ASSERT_EQ(first->last_report().status, Status::ok) << "at tick " << tick;
  }
}

// The second copy knows nothing but the bytes that the first one saved before the tick.
TEST_P(EveryScene, IsSavedWhole) {
  const auto first = play(), second = play();
  std::vector<std::byte> bytes(first->simulation().snapshot_bytes_max(SnapshotKind::canonical));
  for (std::uint32_t tick = 0; tick < ticks_; ++tick) {
    const std::size_t size = first->simulation().save(SnapshotKind::canonical, bytes);
    ASSERT_EQ(second->simulation().load(SnapshotKind::canonical, ByteView(bytes).first(size)),
              Status::ok);
    first->drop_derived();
    first->step();
    second->step();
    ASSERT_EQ(first->simulation().hash(), second->simulation().hash()) << "after tick " << tick;
  }
}

TEST_P(EveryScene, ComesOutTheSameFromBothBroadPhases) {
  const auto tree = make_play(GetParam(), k_seed, BroadPhaseKind::tree).value();
  const auto sweep = make_play(GetParam(), k_seed, BroadPhaseKind::sweep_and_prune).value();
  ASSERT_EQ(sweep->world().def().broad_phase, BroadPhaseKind::sweep_and_prune);
  EXPECT_EQ(tree->simulation().info(), sweep->simulation().info());
  for (std::uint32_t tick = 0; tick < ticks_; ++tick) {
    if (tick % 16 == 15) sweep->drop_derived();
    tree->step();
    sweep->step();
    ASSERT_EQ(tree->simulation().hash(), sweep->simulation().hash()) << "after tick " << tick;
    ASSERT_EQ(tree->last_report().pairs, sweep->last_report().pairs) << "at tick " << tick;
  }
}

TEST_P(EveryScene, KeepsItsBodiesInTheWorld) {
  const auto scene = play();
  for (std::uint32_t tick = 0; tick < ticks_; ++tick)
    scene->step();
  const World& world = scene->world();
  for (std::uint32_t index = 0; index < world.body_limit(); ++index) {
    const BodyHandle body = world.body_at(index);
    if (body.is_null()) continue;
    EXPECT_LT(abs(world.position(body).y), Position::from_integer(200)) << "body " << index;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, ::testing::ValuesIn(names()), test::parameter_name);

TEST(Scenes, AreMadeFromTheirConfiguration) {
  const auto play = make_play("pile", 7).value();
  const auto made = make_simulation(encode_config("pile", 7));
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(made.value()->info(), play->simulation().info());
  EXPECT_NE(make_play("pile", 8).value()->simulation().info(), play->simulation().info());
}

TEST(Scenes, RefuseUnknownConfigurations) {
  EXPECT_EQ(make_simulation(encode_config("nothing", 1)).status(), Status::not_found);
  EXPECT_EQ(make_simulation({}).status(), Status::truncated);
  const auto bytes = encode_config("pile", 1);
  EXPECT_EQ(make_simulation(ByteView(bytes).first(20)).status(), Status::truncated);
  EXPECT_EQ(make_play("nothing", 1).status(), Status::not_found);
}

std::vector<std::int32_t> values_of(std::string_view scene, std::int32_t SceneParameter::*which) {
  std::vector<std::int32_t> values;
  for (const SceneParameter& one : parameters_of(scene))
    values.push_back(one.*which);
  return values;
}

Result<std::unique_ptr<ScenePlay>> make_with(std::string_view scene,
                                             std::span<const std::int32_t> values) {
  return make_play(scene, k_seed, BroadPhaseKind::tree, 0, values);
}

TEST(SceneParameters, AtTheirUsualValuesMakeTheSceneItself) {
  for (const Scene& scene : world_scenes()) {
    const auto usual = values_of(scene.name, &SceneParameter::usual);
    ASSERT_GE(usual.size(), 2U);
    const auto play = make_with(scene.name, usual).value();
    EXPECT_EQ(play->simulation().info(), make_play(scene.name, k_seed).value()->simulation().info())
        << scene.name;
  }
}

TEST(SceneParameters, AtTheirBoundsMakeAWorldThatSteps) {
  for (const Scene& scene : world_scenes()) {
    if (parameters_of(scene).size() == 2) continue;  // those of every scene alone
    for (const auto which : {&SceneParameter::least, &SceneParameter::most}) {
      const auto play = make_with(scene.name, values_of(scene.name, which)).value();
      for (int tick = 0; tick < 3; ++tick)
        play->step();
      EXPECT_EQ(play->last_report().status, Status::ok) << scene.name;
    }
  }
}

TEST(SceneParameters, SayHowManyBodiesThereAre) {
  EXPECT_EQ(make_with("stack", std::array{20}).value()->world().body_count(), 21U);
  EXPECT_EQ(make_with("wall", std::array{44}).value()->world().body_count(), 991U);
  EXPECT_EQ(make_with("bridge", std::array{20, 7}).value()->world().body_count(), 29U);
  const auto moon = make_with("stack", std::array{10, 8, 162}).value();
  EXPECT_EQ(moon->world().def().substeps, 8);
  EXPECT_EQ(moon->world().def().gravity.y, Acceleration::from_ratio(-162, 100));
}

TEST(SceneParameters, RefuseValuesOutOfTheirRange) {
  EXPECT_EQ(make_with("stack", std::array{0}).status(), Status::invalid_argument);
  EXPECT_EQ(make_with("stack", std::array{41}).status(), Status::invalid_argument);
  EXPECT_EQ(make_with("stack", std::array{10, 4, 981, 1}).status(), Status::invalid_argument);
  EXPECT_EQ(make_with("arena", std::array{1}).status(), Status::invalid_argument);
  EXPECT_TRUE(parameters_of("arena").empty());
  EXPECT_TRUE(parameters_of("nothing").empty());
}

// Bodies of a scene, found by their order of creation.
Vec3<Position> place(const ScenePlay& play, std::uint32_t index) {
  return play.world().position(play.world().body_at(index));
}

TEST(Scenes, TheStackStands) {
  const auto play = make_play("stack", k_seed).value();
  for (int tick = 0; tick < 600; ++tick)
    play->step();
  const Vec3<Position> top = place(*play, 10);
  EXPECT_GT(top.y, Position::from_ratio(94, 10));
  EXPECT_LT(abs(top.x), Position::from_ratio(1, 100));
  EXPECT_LT(abs(top.z), Position::from_ratio(1, 100));
}

TEST(Scenes, TheBallRollsDownTheRamp) {
  const auto play = make_play("rolling", k_seed).value();
  for (int tick = 0; tick < 240; ++tick)
    play->step();
  EXPECT_GT(place(*play, 3).x, Position::from_integer(3));
  EXPECT_LT(abs(place(*play, 3).z), Position::from_ratio(1, 1000));
}

Position foot_of(const BodyView& character) {
  const ShapeKind kind = character.shape.kind;
  const int decimetres = kind == ShapeKind::sphere ? 4 : kind == ShapeKind::capsule ? 8 : 7;
  return character.position.y - Position::from_ratio(decimetres, 10);
}

// The least separation from bodies that never move.
Displacement clearance_of(const World& world, const BodyView& character) {
  std::array<ShapeContact, 32> contacts;
  const std::size_t count = world.contacts_of_shape(
      character.shape, {character.position, character.orientation}, {}, contacts, {.mask = 1});
  Displacement least = Displacement::max();
  for (const ShapeContact& contact : std::span(contacts).first(count)) {
    const bool still = world.body(contact.body).motion == MotionType::static_body;
    if (still) least = min(least, contact.separation);
  }
  return least;
}

TEST(Scenes, TheCharactersStayOutOfEverythingClimbAndAreCarried) {
  const auto play = make_play("characters", k_seed).value();
  const World& world = play->world();
  unsigned looked_at = 0, high = 0, on_ferries = 0;
  for (int tick = 0; tick < 240; ++tick) {
    play->step();
    for (std::uint32_t index = 0; index < world.body_limit(); ++index) {
      const BodyView view = world.body(world.body_at(index));
      if (view.user_data != 1) continue;
      ++looked_at;
      EXPECT_GT(foot_of(view), Position::from_ratio(-1, 10000))
          << "body " << index << " at tick " << tick;
      EXPECT_GT(clearance_of(world, view), Displacement::from_ratio(-1, 1000))
          << "body " << index << " at tick " << tick;
      if (tick < 120) continue;
      const Vec3<Length> down{{}, Length::from_integer(-1), {}};
      const RayHit below = world.cast_ray(view.position, down, {.mask = 1});
      if (below.body.is_null()) continue;
      high += foot_of(view) > Position::from_ratio(6, 10) ? 1U : 0U;
      on_ferries += world.body(below.body).user_data == 3 ? 1U : 0U;
    }
  }
  EXPECT_EQ(looked_at, 48U * 240);
  EXPECT_GT(high, 240U);
  EXPECT_GT(on_ferries, 60U);
}

TEST(Scenes, TheCharacterStandsAndTheCapsuleFalls) {
  const auto play = make_play("capsule", k_seed).value();
  for (int tick = 0; tick < 200; ++tick)
    play->step();
  EXPECT_GT(place(*play, 1).y, Position::from_ratio(88, 100));
  EXPECT_LT(place(*play, 2).y, Position::from_ratio(45, 100));
}

TEST(Scenes, TheZonesCountCrossingBodies) {
  const auto play = make_play("trigger", k_seed).value();
  for (int tick = 0; tick < 240; ++tick)
    play->step();
  const World& world = play->world();
  const std::uint64_t first = world.body(world.body_at(1)).user_data;
  const std::uint64_t last = world.body(world.body_at(3)).user_data;
  EXPECT_EQ(first & 0xffffffff, 5U);         // all entered the first zone
  EXPECT_EQ(last & 0xffffffff, last >> 32);  // a ball that reached the last one left it
  EXPECT_GE(last & 0xffffffff, 2U);
}

TEST(Scenes, ThePlatformCarriesItsBoxes) {
  const auto play = make_play("kinematic", k_seed).value();
  for (int tick = 0; tick < 300; ++tick)
    play->step();
  for (std::uint32_t box = 2; box <= 4; ++box) {
    EXPECT_GT(place(*play, box).y, Position::from_ratio(15, 10)) << "box " << box;
  }
}

TEST(Scenes, AssetsArePartOfTheConfiguration) {
  // The hulls of another seed are other hulls: peers with them refuse each other.
  const auto one = make_play("hulls", 1).value(), two = make_play("hulls", 2).value();
  EXPECT_NE(one->world().assets()->hash(), two->world().assets()->hash());
  EXPECT_NE(one->world().assets()->hash(), 0U);
  EXPECT_NE(one->simulation().info(), two->simulation().info());
  const auto made = make_simulation(encode_config("hulls", 2));
  ASSERT_TRUE(made.ok());
  EXPECT_EQ(made.value()->info(), two->simulation().info());
}

TEST(Scenes, TheFurnitureStands) {
  const auto play = make_play("compounds", k_seed).value();
  for (int tick = 0; tick < 25; ++tick)
    play->step();
  EXPECT_GT(place(*play, 3).y, Position::from_ratio(155, 100));  // a chair, before the hammers land
  for (int tick = 25; tick < 300; ++tick)
    play->step();
  EXPECT_LT(abs(place(*play, 1).y), Position::from_ratio(5, 1000));  // a table
  EXPECT_GT(place(*play, 2).y, Position::from_ratio(77, 100));       // on which another one
}

TEST(Scenes, SomeFallThroughTheHolesOfTheTerrainAndNoneElsewhere) {
  const auto play = make_play("terrain", k_seed).value();
  for (int tick = 0; tick < 300; ++tick)
    play->step();
  int fallen = 0;
  for (std::uint32_t body = 2; body < 42; ++body)
    fallen += place(*play, body).y < Position::from_integer(-2) ? 1 : 0;
  EXPECT_GE(fallen, 1);
  EXPECT_LE(fallen, 20);
}

// Twelve shots each at the wall, the mesh and the hillside: none is behind its target, where it has
// not flown around it.
TEST(Scenes, NoShotPassesItsTarget) {
  const auto play = make_play("bullets", k_seed).value();
  constexpr std::uint32_t k_first = 8;
  ASSERT_EQ(play->world().body(play->world().body_at(k_first - 1)).motion, MotionType::static_body);
  for (int tick = 0; tick < 60; ++tick) {
    play->step();
    for (std::uint32_t shot = 0; shot < 24; ++shot) {
      const Vec3<Position> at = place(*play, k_first + shot);
      const Position aside = abs(at.z - Position::from_ratio(45 * (shot / 12), 10));
      const bool at_target = aside < Position::from_integer(2) && at.y < Position::from_integer(3);
      EXPECT_TRUE(!at_target || at.x < Position::from_ratio(1, 100))
          << "shot " << shot << " tick " << tick;
    }
    for (std::uint32_t shot = 0; shot < 36; ++shot)
      EXPECT_GT(place(*play, k_first + shot).y, Position{}) << "shot " << shot << " tick " << tick;
  }
}

// Each sieve lets two of four categories of balls pass.
TEST(Scenes, TheSievesSort) {
  const auto play = make_play("layers", k_seed).value();
  for (int tick = 0; tick < 120; ++tick)
    play->step();
  int high = 0, middle = 0, low = 0;
  for (std::uint32_t ball = 4; ball < 16; ++ball) {
    const Position y = place(*play, ball).y;
    high += y > Position::from_ratio(35, 10) ? 1 : 0;
    middle += y > Position::from_ratio(23, 10) && y < Position::from_ratio(35, 10) ? 1 : 0;
    low += y > Position::from_ratio(11, 10) && y < Position::from_ratio(23, 10) ? 1 : 0;
  }
  EXPECT_GT(high, 0);
  EXPECT_GT(middle, 0);
  EXPECT_GT(low, 0);
}

// Every zone that a ball falls through, the mesh among them, counts it once in and once out.
TEST(Scenes, ZonesOfEveryShapeCountTheirBalls) {
  const auto play = make_play("layers", k_seed).value();
  for (int tick = 0; tick < 300; ++tick)
    play->step();
  const World& world = play->world();
  int zones = 0;
  for (std::uint32_t index = 0; index < world.body_limit(); ++index) {
    const BodyView view = world.body(world.body_at(index));
    if (!view.is_trigger || view.shape.kind == ShapeKind::half_space) continue;
    ++zones;
    EXPECT_GE(view.user_data & 0xffffffff, 1U) << "body " << index;
  }
  EXPECT_EQ(zones, 11);
}

}  // namespace
}  // namespace lockstone::scenes
