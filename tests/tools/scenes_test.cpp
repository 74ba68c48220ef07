// Every scene: builds, repeats itself, and is saved whole.
#include <string>
#include <vector>

#include <gtest/gtest.h>

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

class EveryScene : public testing::TestWithParam<std::string> {
 protected:
  [[nodiscard]] std::unique_ptr<ScenePlay> play() const {
    return make_play(GetParam(), k_seed).value();
  }
  void SetUp() override {
    for (const SceneSummary& scene : list_scenes()) {
      if (scene.name == GetParam()) golden_ticks_ = scene.golden_ticks;
    }
    ASSERT_GT(golden_ticks_, 0U);
  }

  std::uint32_t golden_ticks_ = 0;
};

TEST_P(EveryScene, RepeatsItself) {
  const auto first = play(), second = play();
  for (std::uint32_t tick = 0; tick < golden_ticks_; ++tick) {
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
  for (std::uint32_t tick = 0; tick < golden_ticks_; ++tick) {
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
  for (std::uint32_t tick = 0; tick < golden_ticks_; ++tick) {
    if (tick % 16 == 15) sweep->drop_derived();
    tree->step();
    sweep->step();
    ASSERT_EQ(tree->simulation().hash(), sweep->simulation().hash()) << "after tick " << tick;
    ASSERT_EQ(tree->last_report().pairs, sweep->last_report().pairs) << "at tick " << tick;
  }
}

TEST_P(EveryScene, KeepsItsBodiesInTheWorld) {
  const auto scene = play();
  for (std::uint32_t tick = 0; tick < golden_ticks_; ++tick)
    scene->step();
  const World& world = scene->world();
  for (std::uint32_t index = 0; index < world.body_limit(); ++index) {
    const BodyHandle body = world.body_at(index);
    if (body.is_null()) continue;
    EXPECT_LT(abs(world.position(body).y), Position::from_integer(200)) << "body " << index;
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EveryScene, testing::ValuesIn(names()),
                         [](const auto& name) { return name.param; });

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

TEST(Scenes, TheCharacterStandsAndTheCapsuleFalls) {
  const auto play = make_play("capsule", k_seed).value();
  for (int tick = 0; tick < 200; ++tick)
    play->step();
  EXPECT_GT(place(*play, 1).y, Position::from_ratio(88, 100));
  EXPECT_LT(place(*play, 2).y, Position::from_ratio(45, 100));
}

TEST(Scenes, TheZonesCountWhatCrossesThem) {
  const auto play = make_play("trigger", k_seed).value();
  for (int tick = 0; tick < 240; ++tick)
    play->step();
  const World& world = play->world();
  const std::uint64_t first = world.body(world.body_at(1)).user_data;
  const std::uint64_t last = world.body(world.body_at(3)).user_data;
  EXPECT_EQ(first & 0xffffffff, 5U);         // all entered the first zone
  EXPECT_EQ(last & 0xffffffff, last >> 32);  // whoever got to the last one left it
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

}  // namespace
}  // namespace lockstone::scenes
