// The interface of a scheduler, for stepping a world on several threads.
//
// No result depends on it: the same bits come out of one thread or many, of any order and of any
// delay. A game puts its own scheduler behind TaskRunner; `lockstone/thread_pool.h` is one for
// those who have none.
#pragma once

#include <cstdint>
#include <string_view>

namespace lockstone {

/// One share of the work. `worker` tells calls apart that go on at the same time.
using TaskFunction = void (*)(void* context, std::uint32_t chunk, std::uint32_t worker);

/// Bound on TaskRunner::worker_count.
inline constexpr std::uint32_t k_max_workers = 64;

/// How small the pieces are that a world makes.
enum class TaskPieces : std::uint8_t {
  worthwhile,  ///< a microsecond of work or more; little work is not shared at all
  smallest,    ///< for tests: everything that can be shared is
};
[[nodiscard]] std::string_view to_string(TaskPieces pieces);

/// Calls functions side by side. One runner may serve several worlds, one after the other or, if
/// its `run` allows that, at the same time.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;

  /// How many calls `run` makes at the same time at most, 1 … k_max_workers. Constant as long as a
  /// world has the runner.
  [[nodiscard]] virtual std::uint32_t worker_count() const = 0;

  /// Calls `task(context, chunk, worker)` once for each chunk of 0 … chunks − 1, on any threads and
  /// in any order, and returns when all calls have returned; their writes are then visible to the
  /// caller. `worker` is below `worker_count()`, and no two calls at the same time have the same.
  ///
  /// A chunk may wait for another chunk of its call that has begun, but never for one that has not
  /// begun: running all of them here, one after the other, is correct.
  virtual void run(std::uint32_t chunks, TaskFunction task, void* context) = 0;
};

}  // namespace lockstone
