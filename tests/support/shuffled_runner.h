// Task runners that behave as badly as a TaskRunner may.
#pragma once

#include <algorithm>
#include <cstdint>
#include <mutex>
#include <thread>
#include <vector>

#include <lockstone/tasks.h>

#include "tests/support/random.h"

namespace lockstone::test {

/// Chunks and workers in random order, one after the other on the calling thread.
class ShuffledRunner final : public TaskRunner {
 public:
  explicit ShuffledRunner(std::uint32_t workers, std::uint64_t seed = run_seed())
      : workers_(workers), random_(seed) {}

  [[nodiscard]] std::uint32_t worker_count() const override { return workers_; }

  void run(std::uint32_t chunks, TaskFunction task, void* context) override {
    ++runs_;
    for (const std::uint32_t chunk : shuffled(chunks)) {
      const auto worker = static_cast<std::uint32_t>(random_.between(0, workers_ - 1));
      task(context, chunk, worker);
    }
  }

  [[nodiscard]] int runs() const { return runs_; }

 private:
  std::vector<std::uint32_t> shuffled(std::uint32_t count) {
    std::vector<std::uint32_t> order(count);
    for (std::uint32_t i = 0; i < count; ++i)
      order[i] = i;
    for (std::uint32_t i = count; i > 1; --i)
      std::swap(order[i - 1], order[static_cast<std::size_t>(random_.between(0, i - 1))]);
    return order;
  }

  std::uint32_t workers_;
  Random random_;
  int runs_ = 0;
};

/// A thread of its own for each worker and call, which begins after a random delay and takes the
/// chunks from the last to the first.
class DelayedRunner final : public TaskRunner {
 public:
  explicit DelayedRunner(std::uint32_t workers, std::uint64_t seed = run_seed())
      : workers_(workers), random_(seed) {}

  [[nodiscard]] std::uint32_t worker_count() const override { return workers_; }

  void run(std::uint32_t chunks, TaskFunction task, void* context) override {
    std::mutex mutex;
    std::uint32_t left = chunks;
    std::vector<std::thread> threads;
    for (std::uint32_t worker = 0; worker < workers_; ++worker) {
      const std::int64_t yields = random_.between(0, 3) * random_.between(0, 30);
      threads.emplace_back([&, worker, yields] {
        for (std::int64_t i = 0; i < yields; ++i)
          std::this_thread::yield();
        for (;;) {
          std::unique_lock lock(mutex);
          if (left == 0) return;
          const std::uint32_t chunk = --left;
          lock.unlock();
          task(context, chunk, worker);
        }
      });
    }
    for (std::thread& thread : threads)
      thread.join();
  }

 private:
  std::uint32_t workers_;
  Random random_;
};

}  // namespace lockstone::test
