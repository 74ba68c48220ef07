// A TaskRunner for games that have no scheduler of their own.
#pragma once

#include <cstdint>
#include <memory>

#include <lockstone/tasks.h>

namespace lockstone {

/// Threads that wait for work: the one that calls `run`, and the pool's own. Between two calls they
/// look for the next one for about 300 µs, then sleep. One thread at a time may call `run`.
class ThreadPool final : public TaskRunner {
 public:
  /// 1 … k_max_workers, the calling thread included; 0 takes as many as the machine runs at once.
  explicit ThreadPool(std::uint32_t workers = 0);
  ~ThreadPool() override;
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  [[nodiscard]] std::uint32_t worker_count() const override;
  void run(std::uint32_t chunks, TaskFunction task, void* context) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone
