#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include <lockstone/assert.h>
#include <lockstone/thread_pool.h>

#include "core/base/pause.h"

namespace lockstone {
namespace {

// Some 200 µs on today's processors, and then as long again or more while others may have the
// processor: longer than a tick's single-threaded stretches, for waking up takes tens of
// microseconds.
constexpr int k_looks_before_yield = 4000;
constexpr int k_yields_before_sleep = 400;

std::uint32_t chosen_workers(std::uint32_t workers) {
  if (workers == 0) workers = std::max(std::thread::hardware_concurrency(), 1U);
  return std::min(workers, k_max_workers);
}

}  // namespace

// A job is open while the caller is in `run`. A thread that enters says so first and then looks
// whether it is open; the caller closes it first and then looks who is inside, and waits. So nobody
// reads a job that is being exchanged.
struct ThreadPool::Impl {
  explicit Impl(std::uint32_t workers) {
    for (std::uint32_t worker = 1; worker < workers; ++worker)
      threads.emplace_back([this, worker] { serve(worker); });
  }

  ~Impl() {
    stopped = true;
    ++jobs;
    wake();
    for (std::thread& thread : threads)
      thread.join();
  }

  void run(std::uint32_t chunks, TaskFunction function, void* data) {
    task = function;
    context = data;
    chunk_count = chunks;
    next_chunk = 0;
    open = true;
    ++jobs;
    wake();
    work(0);
    open = false;
    for (Pause pause; inside != 0; pause()) {
    }
  }

  void work(std::uint32_t worker) {
    for (std::uint32_t chunk = next_chunk++; chunk < chunk_count; chunk = next_chunk++)
      task(context, chunk, worker);
  }

  void serve(std::uint32_t worker) {
    std::uint32_t seen = 0;
    for (;;) {
      wait_beyond(seen);
      seen = jobs;
      if (stopped) return;
      ++inside;
      if (open) work(worker);
      --inside;
    }
  }

  void wait_beyond(std::uint32_t seen) {
    for (int i = 0; i < k_looks_before_yield + k_yields_before_sleep; ++i) {
      if (jobs != seen) return;
      if (i < k_looks_before_yield)
        relax_processor();
      else
        std::this_thread::yield();
    }
    std::unique_lock lock(mutex);
    ++sleepers;
    condition.wait(lock, [&] { return jobs != seen; });
    --sleepers;
  }

  void wake() {
    if (sleepers == 0) return;
    const std::lock_guard lock(mutex);
    condition.notify_all();
  }

  TaskFunction task = nullptr;
  void* context = nullptr;
  std::uint32_t chunk_count = 0;

  // Each on its own cache line.
  alignas(64) std::atomic<std::uint32_t> next_chunk{0};
  alignas(64) std::atomic<std::uint32_t> inside{0};  // besides the caller
  alignas(64) std::atomic<std::uint32_t> jobs{0};    // begun so far
  std::atomic<bool> open{false};
  std::atomic<bool> stopped{false};
  std::atomic<std::uint32_t> sleepers{0};

  std::mutex mutex;
  std::condition_variable condition;
  std::vector<std::thread> threads;
};

ThreadPool::ThreadPool(std::uint32_t workers)
    : impl_(std::make_unique<Impl>(chosen_workers(workers))) {}

ThreadPool::~ThreadPool() = default;

std::uint32_t ThreadPool::worker_count() const {
  return static_cast<std::uint32_t>(impl_->threads.size()) + 1;
}

void ThreadPool::run(std::uint32_t chunks, TaskFunction task, void* context) {
  LKS_ASSERT(task != nullptr);
  impl_->run(chunks, task, context);
}

}  // namespace lockstone
