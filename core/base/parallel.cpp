#include "core/base/parallel.h"

#include "core/base/pause.h"

namespace lockstone {
namespace {

// A piece is this part of what is left of a worker's part of a loop: large at first, small in the
// end, so that others can help and nobody waits long for the last piece.
constexpr std::uint32_t k_share_of_rest = 3;

constexpr std::uint64_t cursor(std::size_t loop, std::uint32_t item) {
  return (static_cast<std::uint64_t>(loop) << 32) | item;
}

}  // namespace

void Parallel::set_runner(TaskRunner* runner, TaskPieces pieces) {
  runner_ = runner;
  pieces_ = pieces;
  workers_ = runner == nullptr ? 1 : runner->worker_count();
  LKS_CHECK(workers_ >= 1 && workers_ <= k_max_workers);
}

// Not what would be done in one piece anyway.
bool Parallel::is_worth_sharing(std::span<const Loop> loops) const {
  return workers_ > 1 &&
         std::ranges::any_of(loops, [&](const Loop& loop) { return loop.count > grain_of(loop); });
}

void Parallel::share(std::span<const Loop> loops) {
  loops_ = loops;
  open(0);
  const auto task = [](void* context, std::uint32_t, std::uint32_t worker) {
    static_cast<Parallel*>(context)->work(worker);
  };
  runner_->run(workers_, task, this);
  LKS_CHECK(current_ == loops.size());
}

// The first loop from here on that has items.
void Parallel::open(std::size_t loop) {
  while (loop < loops_.size() && loops_[loop].count == 0)
    ++loop;
  done_.store(0, std::memory_order_relaxed);
  if (loop < loops_.size()) {
    for (std::uint32_t part = 0; part < workers_; ++part) {
      cursors_[part].value.store(cursor(loop, begin_of(loops_[loop], part)),
                                 std::memory_order_release);
    }
  }
  current_.store(loop, std::memory_order_release);
}

// Whoever runs alone does all of it.
void Parallel::work(std::uint32_t worker) {
  for (;;) {
    const std::size_t loop = current_.load(std::memory_order_acquire);
    if (loop >= loops_.size()) return;
    work_on(loop, worker);
    for (Pause pause; current_.load(std::memory_order_acquire) == loop; pause()) {
    }
  }
}

void Parallel::work_on(std::size_t loop, std::uint32_t worker) {
  for (std::uint32_t i = 0; i < workers_; ++i) {
    const std::uint32_t part = (worker + i) % workers_;
    std::uint32_t first = 0, end = 0;
    while (take(loop, part, first, end)) {
      call_(context_, loop, first, end, worker);
      const std::uint32_t items = end - first;
      if (done_.fetch_add(items, std::memory_order_acq_rel) + items == loops_[loop].count) {
        open(loop + 1);
        return;
      }
    }
  }
}

bool Parallel::take(std::size_t loop, std::uint32_t part, std::uint32_t& first,
                    std::uint32_t& end) {
  std::atomic<std::uint64_t>& value = cursors_[part].value;
  const std::uint32_t stop = begin_of(loops_[loop], part + 1), grain = grain_of(loops_[loop]);
  std::uint64_t seen = value.load(std::memory_order_acquire);
  do {
    first = static_cast<std::uint32_t>(seen);
    if (seen >> 32 != loop || first >= stop) return false;
    const std::uint32_t grains = (stop - first) / grain / k_share_of_rest;
    end = std::min(first + std::max(grains, 1U) * grain, stop);
  } while (!value.compare_exchange_weak(seen, cursor(loop, end), std::memory_order_acq_rel));
  return true;
}

std::uint32_t Parallel::grain_of(const Loop& loop) const {
  if (loop.is_serial) return std::max(loop.count, 1U);
  return pieces_ == TaskPieces::smallest ? 1 : loop.grain;
}

// Parts are whole grains but for the last item.
std::uint32_t Parallel::begin_of(const Loop& loop, std::uint32_t part) const {
  const std::uint64_t grain = grain_of(loop);
  const std::uint64_t begin = (loop.count + grain - 1) / grain * part / workers_ * grain;
  return static_cast<std::uint32_t>(std::min<std::uint64_t>(begin, loop.count));
}

}  // namespace lockstone
