#include "tools/simnet/batch.h"

#include <algorithm>
#include <mutex>

#include "tools/simnet/shrink.h"
#include "tools/support/for_blocks.h"

namespace lockstone::simnet {
namespace {

class Batch {
 public:
  Batch(const BatchOptions& options, const GameMaker& make_game, const BatchProgress& progress)
      : options_(options),
        make_game_(make_game),
        progress_(progress),
        hashes_(static_cast<std::size_t>(options.seeds)) {}

  BatchTotals run() {
    tool::for_blocks(options_.seeds, 1, static_cast<int>(options_.threads),
                     [this](std::uint64_t index, std::uint64_t /*one*/) { play_one(index); });
    finish();
    return totals_;
  }

 private:
  void play_one(std::uint64_t index) {
    const Schedule schedule = schedule_of(options_.first_seed + index);
    const MatchOutcome outcome = play(options_.first_seed + index, schedule);
    const std::lock_guard lock(mutex_);
    add(index, schedule, outcome);
    if (progress_) progress_(totals_.matches);
  }

  [[nodiscard]] Schedule schedule_of(std::uint64_t seed) const {
    if (options_.schedule) return *options_.schedule;
    return draw_schedule(seed, options_.faults, options_.clients, heal_ms(options_.ticks, 60));
  }

  [[nodiscard]] MatchOutcome play(std::uint64_t seed, const Schedule& schedule) const {
    MatchSetup setup;
    setup.seed = seed;
    setup.clients = options_.clients;
    setup.ticks = options_.ticks;
    setup.schedule = schedule;
    setup.lie = options_.lie;
    if (options_.lie != Lie::none) setup.policy = options_.policy;
    const Game game = make_game_(seed, setup.control);
    return run_match(game, setup);
  }

  void add(std::uint64_t index, const Schedule& schedule, const MatchOutcome& outcome) {
    ++totals_.matches;
    totals_.ticks += outcome.ticks;
    totals_.client_ticks += outcome.client_ticks;
    totals_.comparisons += outcome.comparisons;
    totals_.substituted_inputs += outcome.substituted_inputs;
    totals_.resends += outcome.resends;
    totals_.refused_packets += outcome.refused_packets;
    totals_.kills += outcome.kills;
    totals_.entries += outcome.entries;
    totals_.too_late += outcome.too_late;
    totals_.rollbacks += outcome.rollbacks;
    totals_.faults += schedule.size();
    totals_.peak_bytes = std::max(totals_.peak_bytes, outcome.peak_bytes);
    hashes_[static_cast<std::size_t>(index)] = outcome.last_hash;
    if (outcome.failure.empty()) return;
    totals_.failures.push_back(
        {options_.first_seed + index, outcome.failure, schedule, outcome.mode});
  }

  void finish() {
    for (std::uint64_t hash : hashes_)
      totals_.hash = totals_.hash * 0x9e3779b97f4a7c15ULL + hash;
    std::sort(totals_.failures.begin(), totals_.failures.end(),
              [](const BatchFailure& a, const BatchFailure& b) { return a.seed < b.seed; });
    if (totals_.failures.empty() || !options_.shrink) return;
    BatchFailure& first = totals_.failures.front();
    first.schedule = shrink(first.schedule, [this, &first](const Schedule& schedule) {
      return !play(first.seed, schedule).failure.empty();
    });
    first.what = play(first.seed, first.schedule).failure;
  }

  const BatchOptions& options_;
  const GameMaker& make_game_;
  const BatchProgress& progress_;
  std::mutex mutex_;
  BatchTotals totals_;
  std::vector<std::uint64_t> hashes_;
};

}  // namespace

BatchTotals run_batch(const BatchOptions& options, const GameMaker& make_game,
                      const BatchProgress& progress) {
  return Batch(options, make_game, progress).run();
}

}  // namespace lockstone::simnet
