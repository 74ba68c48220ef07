#include <algorithm>
#include <atomic>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <lockstone/replay/log_map.h>
#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/verifier.h>

#include "replay/verifying/verification.h"

namespace lockstone::replay {
namespace {

VerifyReport unreadable(Status status) {
  VerifyReport report;
  report.outcome = VerifyOutcome::corrupt;
  report.damage =
      Damage{status, 0, ChunkType::none, "cannot be opened: " + std::string(to_string(status))};
  return report;
}

// More parts than this for each thread gain nothing, and each makes a simulation of its own.
constexpr std::size_t k_parts_per_thread = 8;

// The findings of reading a log from its beginning to its end, without simulating.
struct Reading {
  LogMap map;
  std::optional<Damage> damage;
};

// The parts do not see the totals and the transcript of the whole log; this does.
Reading read_whole(Source& source) {
  Reading reading;
  LogReader reader(source);
  if (reader.open() != Status::ok) return reading;
  LogItem item = reader.next();
  for (; !is_last(item); item = reader.next()) {
    if (item == LogItem::hashes) reading.map.ticks += reader.hashes().size();
    if (item == LogItem::keyframe)
      reading.map.keyframes.push_back({reader.chunk().first_tick, reader.chunk_offset()});
  }
  if (item == LogItem::damaged) reading.damage = reader.damage();
  return reading;
}

// Of all keyframes, those between parts of about equal length.
std::vector<KeyframePlace> choose_parts(const LogMap& map, std::size_t parts) {
  std::vector<KeyframePlace> chosen;
  const std::uint64_t least_ticks = map.ticks / parts + 1;
  for (const KeyframePlace& place : map.keyframes) {
    if (map.keyframes.size() > parts && !chosen.empty() &&
        place.tick - chosen.back().tick < least_ticks) {
      continue;
    }
    chosen.push_back(place);
  }
  return chosen;
}

// One task of a worker, and its result.
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
    Reading reading;
    if (source && threads_ > 1) reading = read_whole(*source.value());
    if (source && threads_ <= 1 && progress_) reading.map = map_log(*source.value());
    total_ += reading.map.ticks;
    if (threads_ <= 1) reading.map.keyframes.clear();
    damages_.push_back(std::move(reading.damage));
    LogSegment segment;
    for (const KeyframePlace& place :
         choose_parts(reading.map, k_parts_per_thread * std::max(threads_, 1U))) {
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

  // The first finding in the order of the file decides; the findings about the end of the log come
  // from the segment that reached it.
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
    for (std::size_t log = 0; log < reports.size(); ++log)
      judge_whole(reports[log], damages_[log]);
    return reports;
  }

  // Each part was right, and yet the whole is not: its END names other totals.
  static void judge_whole(VerifyReport& whole, const std::optional<Damage>& damage) {
    if (!damage || whole.damage || whole.outcome == VerifyOutcome::incompatible) return;
    whole.damage = damage;
    whole.complete = false;
    whole.end_reason.clear();
    whole.transcript = {};
    if (whole.outcome == VerifyOutcome::same) whole.outcome = VerifyOutcome::corrupt;
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
    whole.end_kind = part.end_kind;
    whole.transcript = part.transcript;
    if (!whole.damage) whole.damage = std::move(part.damage);
  }

  const std::span<const SourceOpener> logs_;
  const SimulationFactory& factory_;
  const VerifyOptions& options_;
  const unsigned threads_;
  const VerifyProgress& progress_;
  std::vector<Task> tasks_;
  std::vector<std::optional<Damage>> damages_;  // of each log as a whole
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
