#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>
#include <utility>

#include <lockstone/replay/verifier.h>

#include "replay/verification.h"

namespace lockstone::replay {
namespace {

VerifyReport unreadable(Status status) {
  VerifyReport report;
  report.outcome = VerifyOutcome::corrupt;
  report.damage =
      Damage{status, 0, ChunkType::none, "cannot be opened: " + std::string(to_string(status))};
  return report;
}

// One task of a worker, and what came of it.
struct Task {
  std::size_t log = 0;
  LogSegment segment;
  VerifyReport report;
};

class ParallelVerification {
 public:
  ParallelVerification(std::span<const SourceOpener> logs, const SimulationFactory& factory,
                       const VerifyOptions& options, unsigned threads,
                       const VerifyProgress& progress)
      : logs_(logs), factory_(factory), options_(options), threads_(threads), progress_(progress) {}

  std::vector<VerifyReport> run() {
    for (std::size_t log = 0; log < logs_.size(); ++log)
      plan(log);
    const std::size_t helpers = std::min<std::size_t>(threads_, tasks_.size());
    std::vector<std::thread> pool;
    for (std::size_t i = 1; i < helpers; ++i)
      pool.emplace_back([this] { work(); });
    work();
    for (std::thread& thread : pool)
      thread.join();
    return merge();
  }

 private:
  // One thread has nothing to gain from segments.
  void plan(std::size_t log) {
    const Result<std::unique_ptr<Source>> source = logs_[log]();
    LogMap map;
    if (source && (threads_ > 1 || progress_)) map = map_log(*source.value());
    total_ += map.ticks;
    if (threads_ <= 1) map.keyframes.clear();
    LogSegment segment;
    for (const KeyframePlace& place : map.keyframes) {
      segment.end = place;
      tasks_.push_back({log, segment, {}});
      segment = {place, std::nullopt};
    }
    tasks_.push_back({log, segment, {}});
  }

  // From the back: recorders put keyframes closer at the beginning, and with the shortest parts
  // last the threads end together.
  void work() {
    for (std::size_t i = next_++; i < tasks_.size(); i = next_++) {
      Task& task = tasks_[tasks_.size() - 1 - i];
      task.report = verify_segment(task);
    }
  }

  VerifyReport verify_segment(const Task& task) {
    const Result<std::unique_ptr<Source>> source = logs_[task.log]();
    if (!source) return unreadable(source.status());
    TickCounter counter;
    if (progress_) counter = [this](std::uint64_t ticks) { count(ticks); };
    return Verification(*source.value(), task.segment, factory_, options_, counter).run();
  }

  void count(std::uint64_t ticks) {
    const std::lock_guard lock(mutex_);
    progress_(done_ += ticks, total_);
  }

  // The first finding in the order of the file decides; what is said about the end of the log
  // comes from the segment that reached it.
  std::vector<VerifyReport> merge() {
    std::vector<VerifyReport> reports(logs_.size());
    std::vector<bool> begun(logs_.size());
    for (Task& task : tasks_) {
      VerifyReport& whole = reports[task.log];
      if (!begun[task.log]) {
        whole = std::move(task.report);
        begun[task.log] = true;
      } else {
        join(whole, std::move(task.report));
      }
    }
    return reports;
  }

  static void join(VerifyReport& whole, VerifyReport part) {
    if (whole.outcome == VerifyOutcome::incompatible || whole.outcome == VerifyOutcome::corrupt) {
      return;
    }
    const bool decided = whole.outcome != VerifyOutcome::same;
    if (!decided) {
      whole.outcome = part.outcome;
      whole.ticks_verified += part.ticks_verified;
      if (part.ticks_verified > 0) whole.final_hash = part.final_hash;
      whole.divergence = std::move(part.divergence);
      whole.mismatches = std::move(part.mismatches);
    }
    whole.complete = part.complete;
    whole.torn_tail = part.torn_tail;
    whole.end_reason = std::move(part.end_reason);
    if (!whole.damage) whole.damage = std::move(part.damage);
  }

  const std::span<const SourceOpener> logs_;
  const SimulationFactory& factory_;
  const VerifyOptions& options_;
  const unsigned threads_;
  const VerifyProgress& progress_;
  std::vector<Task> tasks_;
  std::atomic<std::size_t> next_ = 0;
  std::mutex mutex_;
  std::uint64_t done_ = 0;
  std::uint64_t total_ = 0;
};

}  // namespace

std::vector<VerifyReport> verify_all(std::span<const SourceOpener> logs,
                                     const SimulationFactory& factory, const VerifyOptions& options,
                                     unsigned threads, const VerifyProgress& progress) {
  return ParallelVerification(logs, factory, options, threads, progress).run();
}

}  // namespace lockstone::replay
