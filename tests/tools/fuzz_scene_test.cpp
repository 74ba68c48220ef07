// Random scenes: a few of them here, as many as asked for by `lockstone fuzz-scene`.
#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tools/fuzz/scene_fuzz.h"

namespace lockstone::fuzz {
namespace {

TEST(FuzzScenes, OfARandomSeedDependOnTheStateAlone) {
  SceneFuzzOptions options;
  options.seed = test::run_seed();
  options.count = test::share_of(std::uint64_t{16});
  options.ticks = 30;
  const SceneFuzzReport report = fuzz_scenes(options);
  EXPECT_EQ(report.scenes, options.count);
  EXPECT_GT(report.ticks, 0U);
  for (const SceneFailure& failure : report.failures)
    ADD_FAILURE() << "scene " << failure.index << " of seed " << options.seed << ", tick "
                  << failure.tick << ": " << failure.what;
}

TEST(FuzzScenes, ThatFailedOnceHold) {
  struct Scene {
    std::uint64_t seed, index;
    bool with_rims = false;  // most were found before there were any
    std::uint32_t ticks = 60;
  };
  constexpr std::uint32_t k_part = test::share_of(60U);  // of a scene whose every tick takes long
  constexpr Scene k_scenes[] = {
      {20261121, 104},   // locks opened for a body whose joint sat too far away for one that turns
      {20261122, 334},   // a trigger 2,048 m behind a half-space
      {20261122, 668},   // impacts on a body with one free axis of rotation gained energy
      {20261122, 1084},  // a known manifold on a half-space was taken for other bits
      {20261122, 1275},  // angular momenta at the end of their range
      {20261122, 1331, false, k_part},  // a factor of rows that say the same twice
      {20261123, 1630},    // a joint's force at the end of its type along two axes, turned
      {77, 156, true, 8},  // which contacts found no room followed from derived data
  };
  for (const Scene& scene : k_scenes) {
    SceneFuzzOptions options;
    options.seed = scene.seed;
    options.first = scene.index;
    options.count = 1;
    options.with_rims = scene.with_rims;
    options.ticks = scene.ticks;
    EXPECT_TRUE(fuzz_scenes(options).failures.empty()) << scene.seed << ", scene " << scene.index;
  }
}

TEST(FuzzScenes, AreTheSameOnAnyNumberOfThreads) {
  SceneFuzzOptions options;
  options.count = 4;
  options.ticks = 10;
  const SceneFuzzReport one = fuzz_scenes(options);
  options.threads = 3;
  const SceneFuzzReport three = fuzz_scenes(options);
  EXPECT_EQ(one.contacts, three.contacts);
  EXPECT_EQ(one.saturations, three.saturations);
  EXPECT_EQ(one.ticks, three.ticks);
}

}  // namespace
}  // namespace lockstone::fuzz
