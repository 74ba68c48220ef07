// Loops whose pieces run side by side, and sequences of such loops.
//
// How a loop is cut depends on the number of workers; its results must not.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/assert.h>
#include <lockstone/tasks.h>

namespace lockstone {

/// One loop of a sequence: over 0 … count − 1, in pieces of `grain` items or more, or in one piece.
struct Loop {
  std::uint32_t count = 0;
  std::uint32_t grain = 1;
  bool is_serial = false;
};

class Parallel {
 public:
  /// Null: everything is done by the caller.
  void set_runner(TaskRunner* runner, TaskPieces pieces = TaskPieces::worthwhile);

  [[nodiscard]] std::uint32_t workers() const { return workers_; }

  /// Calls `body(first, end, worker)` for pieces that together are 0 … loop.count − 1.
  template <class Body>
  void for_each(const Loop& loop, Body&& body) {
    run_all(std::span(&loop, 1), [&](std::size_t, std::uint32_t first, std::uint32_t end,
                                     std::uint32_t worker) { body(first, end, worker); });
  }

  /// The same for each loop of a sequence: `body(i, first, end, worker)` for loop i. A loop begins
  /// when all of the one before has ended. One call of the runner for all of them, since its
  /// barriers are dearer than those here.
  template <class Body>
  void run_all(std::span<const Loop> loops, Body&& body) {
    if (!is_worth_sharing(loops)) {
      for (std::size_t i = 0; i < loops.size(); ++i) {
        if (loops[i].count > 0) body(i, 0U, loops[i].count, 0U);
      }
      return;
    }
    using Callable = std::remove_reference_t<Body>;
    context_ = const_cast<void*>(static_cast<const void*>(&body));
    call_ = [](void* context, std::size_t loop, std::uint32_t first, std::uint32_t end,
               std::uint32_t worker) {
      (*static_cast<Callable*>(context))(loop, first, end, worker);
    };
    share(loops);
  }

 private:
  using Call = void (*)(void* context, std::size_t loop, std::uint32_t first, std::uint32_t end,
                        std::uint32_t worker);

  // Each worker has a part of every loop, the same one each time, so that memory does not wander
  // between processors; a worker that is done helps the others. A cursor is the last loop whose
  // part was begun and the next grain of it: a worker that comes late from another loop cannot take
  // anything.
  struct alignas(64) Cursor {
    std::atomic<std::uint64_t> value{0};
  };
  struct Piece {
    std::uint32_t first = 0, end = 0;  // grains
  };

  [[nodiscard]] bool is_worth_sharing(std::span<const Loop> loops) const;
  void share(std::span<const Loop> loops);
  void work(std::uint32_t worker);
  void work_on(std::size_t index, std::uint32_t worker);
  bool take(std::size_t loop, std::uint32_t part, std::uint32_t stop, Piece& piece);
  [[nodiscard]] std::uint32_t grain_of(const Loop& loop) const;

  TaskRunner* runner_ = nullptr;
  TaskPieces pieces_ = TaskPieces::worthwhile;
  std::uint32_t workers_ = 1;

  std::span<const Loop> loops_;
  Call call_ = nullptr;
  void* context_ = nullptr;
  alignas(64) std::atomic<std::uint64_t> done_{0};  // items of all loops
  std::array<Cursor, k_max_workers> cursors_{};
};

}  // namespace lockstone
