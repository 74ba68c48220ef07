// Every scene, rolled back with a history, takes the course that it takes without.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/rollback_history.h>

#include "tests/support/parameter_name.h"
#include "tests/support/workload.h"
#include "tools/scenes/build.h"
#include "tools/scenes/scene.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint64_t k_seed = 1;
constexpr std::uint32_t k_history_ticks = 8;
constexpr std::uint32_t k_rounds = test::share_of(24U);

World make(const Scene& scene) {
  std::vector<AssetPtr> assets;
  if (scene.assets != nullptr) assets = scene.assets(k_seed);
  World world =
      World::create(scene.define(), std::make_shared<const AssetSet>(std::move(assets))).value();
  scene.build(world, k_seed);
  return world;
}

bool is_same(const ContactEvent& a, const ContactEvent& b) {
  return a.kind == b.kind && a.a == b.a && a.b == b.b && a.approach_speed == b.approach_speed &&
         a.tag_a == b.tag_a && a.tag_b == b.tag_b;
}

// A scene twice: once as it goes, once with detours on wrong guesses.
class Course {
 public:
  explicit Course(const Scene& scene)
      : scene_(scene),
        plain_(make(scene)),
        rolled_(make(scene)),
        history_(rolled_, k_history_ticks),
        start_(rolled_.snapshot_bytes_max(SnapshotKind::native)) {}

  void run() {
    Random random(k_seed);
    for (std::uint32_t round = 0; round < k_rounds && !::testing::Test::HasFailure(); ++round) {
      const std::size_t size = rolled_.save(SnapshotKind::native, start_);
      for (std::uint32_t ahead = 1 + random.below(k_history_ticks); ahead > 0; --ahead) {
        if (random.below(3) == 0) guess_wrong(random);
        drive(rolled_);
        (void)history_.step();
      }
      ASSERT_EQ(rolled_.load(SnapshotKind::native, ByteView(start_).first(size)), Status::ok);
      for (std::uint32_t ticks = 1 + random.below(4); ticks > 0; --ticks)
        go_on();
    }
  }

 private:
  void drive(World& world) {
    if (scene_.drive != nullptr) scene_.drive(world, k_seed);
  }

  void guess_wrong(Random& random) {
    const BodyHandle body = rolled_.body_at(random.below(rolled_.body_limit()));
    if (body.is_null()) return;
    const auto speed = [&] { return Velocity::from_integer(random.between(-3, 3)); };
    const Velocity x = speed(), y = speed();
    (void)rolled_.apply(SetVelocity{body, {x, y, 1_mps}});
  }

  void go_on() {
    drive(plain_);
    drive(rolled_);
    (void)plain_.step();
    (void)history_.step();
    ASSERT_EQ(plain_.hash().total, rolled_.hash().total) << "tick " << plain_.tick();
    const auto are_same = [](const auto& a, const auto& b) { return is_same(a, b); };
    ASSERT_TRUE(std::ranges::equal(plain_.events(), rolled_.events(), are_same))
        << "tick " << plain_.tick();
    ASSERT_FALSE(rolled_.find_fault()) << rolled_.find_fault().what;
    if (scene_.observe == nullptr) return;
    scene_.observe(plain_);
    scene_.observe(rolled_);
  }

  const Scene& scene_;
  World plain_, rolled_;
  RollbackHistory history_;
  std::vector<std::byte> start_;
};

class HistoryScenes : public ::testing::TestWithParam<std::string> {};

TEST_P(HistoryScenes, TakeTheSameCourse) {
  Course(*find_scene(GetParam())).run();
}

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const Scene& scene : world_scenes())
    result.emplace_back(scene.name);
  return result;
}

INSTANTIATE_TEST_SUITE_P(All, HistoryScenes, ::testing::ValuesIn(test::share_of_cases(names())),
                         test::parameter_name);

}  // namespace
}  // namespace lockstone::scenes
