// Loops on workers: each item once, loops in order, on any worker.
#include "core/base/parallel.h"

#include <atomic>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/thread_pool.h>

#include "tests/support/shuffled_runner.h"

namespace lockstone {
namespace {

constexpr auto k_idle = [](std::uint32_t, std::uint32_t, std::uint32_t) {};

void expect_each_item_once(Parallel& parallel, const Loop& loop) {
  std::vector<std::atomic<int>> visits(loop.count);
  std::atomic<bool> bad_piece{false};
  parallel.for_each(loop, [&](std::uint32_t first, std::uint32_t end, std::uint32_t worker) {
    if (first >= end || worker >= parallel.workers()) bad_piece = true;
    for (std::uint32_t i = first; i < end; ++i)
      ++visits[i];
  });
  EXPECT_FALSE(bad_piece);
  for (std::uint32_t i = 0; i < loop.count; ++i)
    ASSERT_EQ(visits[i], 1) << "item " << i << " of " << loop.count << " by " << loop.grain;
}

void expect_every_loop_whole(TaskRunner* runner) {
  Parallel parallel;
  parallel.set_runner(runner);
  for (const std::uint32_t count : {0U, 1U, 2U, 3U, 7U, 64U, 1000U}) {
    for (const std::uint32_t grain : {1U, 4U, 64U, 5000U})
      expect_each_item_once(parallel, {count, grain});
  }
}

TEST(Parallel, VisitsEachItemOnce) {
  expect_every_loop_whole(nullptr);
  for (const std::uint32_t workers : {1U, 2U, 3U, 7U, 64U}) {
    ThreadPool pool(workers);
    expect_every_loop_whole(&pool);
    test::ShuffledRunner shuffled(workers);
    expect_every_loop_whole(&shuffled);
  }
  test::DelayedRunner delayed(3);
  expect_every_loop_whole(&delayed);
}

// Every loop sums the output of the one before.
std::vector<std::uint64_t> sums_of_sums(TaskRunner* runner) {
  Parallel parallel;
  parallel.set_runner(runner);
  constexpr std::uint32_t k_items = 200;
  std::vector<Loop> loops;
  for (std::uint32_t i = 0; i < 60; ++i)
    loops.push_back({i % 5 == 3 ? 0 : k_items, 1 + i % 7});
  std::vector<std::uint64_t> from(k_items, 1), to(k_items);
  std::vector<std::vector<std::uint64_t>> values(loops.size() + 1, from);
  std::vector<std::size_t> before(loops.size());
  for (std::size_t i = 1; i < loops.size(); ++i)
    before[i] = loops[i - 1].count == 0 ? before[i - 1] : i;
  parallel.run_all(
      loops, [&](std::size_t loop, std::uint32_t first, std::uint32_t end, std::uint32_t) {
        const std::vector<std::uint64_t>& in = values[before[loop]];
        const std::uint64_t sum = std::accumulate(in.begin(), in.end(), std::uint64_t{0});
        for (std::uint32_t i = first; i < end; ++i)
          values[loop + 1][i] = sum * 31 + in[i] + i;
      });
  return values.back();
}

TEST(Parallel, BeginsALoopAfterTheOneBefore) {
  const std::vector<std::uint64_t> alone = sums_of_sums(nullptr);
  for (const std::uint32_t workers : {2U, 4U, 7U}) {
    ThreadPool pool(workers);
    test::ShuffledRunner shuffled(workers);
    test::DelayedRunner delayed(workers);
    for (int repeat = 0; repeat < 5; ++repeat) {
      EXPECT_EQ(sums_of_sums(&pool), alone);
      EXPECT_EQ(sums_of_sums(&shuffled), alone);
      EXPECT_EQ(sums_of_sums(&delayed), alone);
    }
  }
}

TEST(Parallel, DoesNotCallTheRunnerForASinglePiece) {
  test::ShuffledRunner runner(4);
  Parallel parallel;
  parallel.set_runner(&runner);
  parallel.for_each({10, 10}, k_idle);
  EXPECT_EQ(runner.runs(), 0);
  parallel.for_each({11, 10}, k_idle);
  EXPECT_EQ(runner.runs(), 1);
  parallel.set_runner(&runner, TaskPieces::smallest);
  parallel.for_each({10, 10}, k_idle);
  EXPECT_EQ(runner.runs(), 2);
  parallel.for_each({1000, 10, true}, k_idle);
  EXPECT_EQ(runner.runs(), 2);
}

TEST(ThreadPool, RunsEachChunkOnceCallAfterCall) {
  for (const std::uint32_t workers : {1U, 2U, 5U}) {
    ThreadPool pool(workers);
    EXPECT_EQ(pool.worker_count(), workers);
    for (std::uint32_t chunks = 0; chunks < 200; ++chunks) {
      std::vector<std::atomic<int>> visits(chunks + 1);
      pool.run(
          chunks,
          [](void* context, std::uint32_t chunk, std::uint32_t) {
            ++(*static_cast<std::vector<std::atomic<int>>*>(context))[chunk];
          },
          &visits);
      for (std::uint32_t i = 0; i < chunks; ++i)
        ASSERT_EQ(visits[i], 1);
    }
  }
}

TEST(ThreadPool, HasAsManyWorkersAsTheMachineByDefault) {
  ThreadPool pool;
  EXPECT_GE(pool.worker_count(), 1U);
  EXPECT_LE(pool.worker_count(), k_max_workers);
}

}  // namespace
}  // namespace lockstone
