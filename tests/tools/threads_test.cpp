// Every scene has the same result on any number of workers.
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/thread_pool.h>

#include "tests/support/parameter_name.h"
#include "tests/support/shuffled_runner.h"
#include "tests/support/workload.h"
#include "tools/scenes/play.h"

namespace lockstone::scenes {
namespace {

constexpr std::uint64_t k_seed = 1;
constexpr std::uint32_t k_most_ticks = test::share_of(60);

std::vector<std::string> names() {
  std::vector<std::string> result;
  for (const SceneSummary& scene : list_scenes())
    result.emplace_back(scene.name);
  return result;
}

struct Record {
  std::vector<std::uint64_t> hashes;
  std::vector<StepReport> reports;
};

Record record_of(const std::string& scene, TaskRunner* runner) {
  const auto play = make_play(scene, k_seed).value();
  play->set_task_runner(runner, TaskPieces::smallest);
  Record record;
  for (std::uint32_t tick = 0; tick < k_most_ticks; ++tick) {
    play->step();
    record.hashes.push_back(play->simulation().hash());
    record.reports.push_back(play->last_report());
  }
  return record;
}

class EverySceneOnThreads : public ::testing::TestWithParam<std::string> {
 protected:
  void expect_same(TaskRunner* runner) {
    const Record record = record_of(GetParam(), runner);
    for (std::size_t tick = 0; tick < k_most_ticks; ++tick) {
      ASSERT_EQ(record.hashes[tick], alone_.hashes[tick]) << "after tick " << tick;
      ASSERT_EQ(record.reports[tick], alone_.reports[tick]) << "at tick " << tick;
    }
  }

  const Record alone_ = record_of(GetParam(), nullptr);
};

TEST_P(EverySceneOnThreads, ComesOutTheSameFromAThreadPool) {
  for (const std::uint32_t workers : {1U, 2U, 3U, 4U, 7U}) {
    ThreadPool pool(workers);
    expect_same(&pool);
  }
}

TEST_P(EverySceneOnThreads, ComesOutTheSameInAnyOrder) {
  test::ShuffledRunner shuffled(5);
  expect_same(&shuffled);
  if (GetParam() == "pile") {
    EXPECT_GT(shuffled.runs(), 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Scenes, EverySceneOnThreads,
                         ::testing::ValuesIn(test::share_of_cases(names())), test::parameter_name);

TEST(Threads, ComeAndGoWhileASceneRuns) {
  const Record alone = record_of("pile", nullptr);
  const auto play = make_play("pile", k_seed).value();
  ThreadPool pool(3);
  test::DelayedRunner delayed(4);
  TaskRunner* const runners[] = {nullptr, &pool, &delayed};
  for (std::uint32_t tick = 0; tick < k_most_ticks; ++tick) {
    play->set_task_runner(runners[tick / 5 % 3], TaskPieces::smallest);
    play->step();
    ASSERT_EQ(play->simulation().hash(), alone.hashes[tick]) << "after tick " << tick;
    ASSERT_EQ(play->last_report(), alone.reports[tick]) << "at tick " << tick;
  }
}

}  // namespace
}  // namespace lockstone::scenes
