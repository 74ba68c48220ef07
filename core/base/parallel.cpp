#include "core/base/parallel.h"

#include "core/base/pause.h"

namespace lockstone {
namespace {

// A piece is this fraction of the remainder of a worker's part of a loop: large at first, small in
// the end, so that others can help and nobody waits long for the last piece.
constexpr std::uint32_t k_share_of_rest = 3;

constexpr std::uint64_t cursor(std::size_t loop, std::uint32_t grain) {
  return (static_cast<std::uint64_t>(loop) + 1) << 32 | grain;
}

}  // namespace

void Parallel::set_runner(TaskRunner* runner, TaskPieces pieces) {
  runner_ = runner;
  pieces_ = pieces;
  workers_ = runner == nullptr ? 1 : runner->worker_count();
  if (workers_ < 1 || workers_ > k_max_workers)
    misused("World::set_task_runner: worker_count() must be 1 … k_max_workers");
}

// Not worth it for loops that would be done in one piece anyway.
bool Parallel::is_worth_sharing(std::span<const Loop> loops) const {
  return workers_ > 1 &&
         std::ranges::any_of(loops, [&](const Loop& loop) { return loop.count > grain_of(loop); });
}

void Parallel::share(std::span<const Loop> loops) {
  loops_ = loops;
  done_.store(0, std::memory_order_relaxed);
  for (Cursor& each : cursors_)
    each.value.store(0, std::memory_order_relaxed);
  const auto task = [](void* context, std::uint32_t, std::uint32_t worker) {
    static_cast<Parallel*>(context)->work(worker);
  };
  runner_->run(workers_, task, this);
  std::uint64_t all = 0;
  for (const Loop& loop : loops)
    all += loop.count;
  LKS_CHECK(done_ == all);
}

// A worker that runs alone does all of it. A worker that comes late joins the present loop.
void Parallel::work(std::uint32_t worker) {
  std::uint64_t end = 0;
  for (std::size_t loop = 0; loop < loops_.size(); ++loop) {
    end += loops_[loop].count;
    if (done_.load(std::memory_order_acquire) >= end) continue;
    work_on(loop, worker);
    for (Pause pause; done_.load(std::memory_order_acquire) < end; pause()) {
    }
  }
}

// Reports its finished work once, at its end: each report waits for the other processors. Parts are
// whole grains.
void Parallel::work_on(std::size_t index, std::uint32_t worker) {
  const Loop& loop = loops_[index];
  const std::uint32_t grain = grain_of(loop);
  const std::uint64_t grains = (std::uint64_t{loop.count} + grain - 1) / grain;
  std::uint32_t items = 0;
  for (std::uint32_t i = 0; i < workers_; ++i) {
    const std::uint32_t part = worker + i < workers_ ? worker + i : worker + i - workers_;
    Piece piece{static_cast<std::uint32_t>(grains * part / workers_),
                static_cast<std::uint32_t>(grains * (part + 1) / workers_)};
    for (const std::uint32_t stop = piece.end; take(index, part, stop, piece);
         piece = {piece.end, stop}) {
      const std::uint32_t first = piece.first * grain;
      const auto end = static_cast<std::uint32_t>(
          std::min<std::uint64_t>(std::uint64_t{piece.end} * grain, loop.count));
      call_(context_, index, first, end, worker);
      items += end - first;
    }
  }
  if (items != 0) done_.fetch_add(items, std::memory_order_acq_rel);
}

// The next piece of a part. In: where the part begins, if nobody has begun it.
bool Parallel::take(std::size_t loop, std::uint32_t part, std::uint32_t stop, Piece& piece) {
  std::atomic<std::uint64_t>& value = cursors_[part].value;
  const std::uint64_t begin = cursor(loop, piece.first);
  std::uint64_t seen = value.load(std::memory_order_relaxed);
  do {
    const std::uint64_t from = std::max(seen, begin);
    piece.first = static_cast<std::uint32_t>(from);
    if (from >> 32 != begin >> 32 || piece.first >= stop) return false;
    piece.end = piece.first + std::max((stop - piece.first) / k_share_of_rest, 1U);
  } while (!value.compare_exchange_weak(seen, cursor(loop, piece.end), std::memory_order_relaxed));
  return true;
}

std::uint32_t Parallel::grain_of(const Loop& loop) const {
  if (loop.is_serial) return std::max(loop.count, 1U);
  return pieces_ == TaskPieces::smallest ? 1 : loop.grain;
}

}  // namespace lockstone
