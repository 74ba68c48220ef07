#include "tools/fuzz/rollback_fuzz.h"

#include <algorithm>
#include <mutex>
#include <span>

#include <fmt/format.h>

#include <lockstone/rollback_history.h>

#include "tools/fuzz/random_features.h"
#include "tools/fuzz/random_world.h"
#include "tools/support/for_blocks.h"

namespace lockstone::fuzz {
namespace {

using arena::mix;
using arena::Random;

// Ticks that the history keeps, and that a round goes ahead at most: more than it keeps.
constexpr std::uint32_t k_history_ticks = 8;
constexpr std::uint32_t k_most_ahead = 10;

class RollbackRun {
 public:
  RollbackRun(const RandomWorld& source, std::uint64_t seed, RollbackFuzzReport& report)
      : source_(source),
        random_(seed),
        report_(report),
        plain_(source.make()),
        rolled_(source.make()),
        history_(rolled_, k_history_ticks),
        bytes_(plain_.snapshot_bytes_max(SnapshotKind::native)) {}

  // Goes ahead on guesses, comes back and takes the true way. Returns the violated invariant, if
  // any.
  std::string round() {
    const std::size_t size = rolled_.save(SnapshotKind::native, bytes_);
    const std::uint32_t ahead = 1 + random_.below(k_most_ahead);
    const std::uint32_t wrong = chance(random_, 4) ? 1 : 8;
    for (std::uint32_t i = 0; i < ahead; ++i)
      guess(wrong);
    if (rolled_.load(SnapshotKind::native, ByteView(bytes_).first(size)) != Status::ok)
      return "the snapshot does not load";
    ++report_.rollbacks;
    if (chance(random_, 20)) rolled_.drop_derived();
    if (chance(random_, 40)) history_.forget();
    const std::uint32_t confirmed = 1 + random_.below(ahead);
    for (std::uint32_t i = 0; i < confirmed; ++i)
      if (std::string what = go_on(); !what.empty()) return what;
    return {};
  }

  [[nodiscard]] std::uint64_t ticks() const { return plain_.tick(); }

 private:
  // One tick in so many is wrong: the true commands lack, or there is another one.
  void guess(std::uint32_t wrong) {
    const bool is_wrong = chance(random_, wrong);
    if (!is_wrong || chance(random_, 2)) source_.drive(rolled_);
    if (is_wrong) (void)rolled_.apply(source_.other_command(rolled_, random_));
    count(history_.step());
  }

  std::string go_on() {
    source_.drive(plain_);
    source_.drive(rolled_);
    const StepReport plain = plain_.step();
    const StepReport rolled = history_.step();
    count(rolled);
    if (plain.status != rolled.status) return "the status of the step differs";
    if (plain_.hash().total != rolled_.hash().total) return difference();
    if (plain.asleep_bodies != rolled.asleep_bodies) return "the number of sleepers differs";
    if (std::string what = difference_of_events(plain_, rolled_); !what.empty()) return what;
    if (const WorldFault fault = rolled_.find_fault())
      return fmt::format("{} does not fit, {}", fault.what, fault.index);
    return {};
  }

  void count(const StepReport& step) {
    ++report_.ticks;
    report_.computed_islands += step.computed_islands;
    report_.recalled_islands += step.recalled_islands;
    const bool recalled = step.recalled_islands != 0, computed = step.computed_islands != 0;
    report_.partial_ticks += recalled && computed ? 1U : 0U;
    report_.whole_ticks += recalled && !computed ? 1U : 0U;
  }

  std::string difference() {
    std::vector<std::byte> here(plain_.snapshot_bytes_max(SnapshotKind::canonical));
    std::vector<std::byte> there(here.size());
    here.resize(plain_.save(SnapshotKind::canonical, here));
    there.resize(rolled_.save(SnapshotKind::canonical, there));
    return "the state differs: " + plain_.describe_difference(here, there).to_line();
  }

  const RandomWorld& source_;
  Random random_;
  RollbackFuzzReport& report_;
  World plain_, rolled_;
  RollbackHistory history_;
  std::vector<std::byte> bytes_;
};

void run_world(const RollbackFuzzOptions& options, std::uint64_t index,
               RollbackFuzzReport& report) {
  const RandomWorld source(options.seed, index);
  RollbackRun run(source, mix(options.seed ^ mix(index)), report);
  ++report.worlds;
  for (std::uint32_t round = 0; round < options.rounds; ++round) {
    std::string what = run.round();
    if (what.empty()) continue;
    report.failures.push_back({index, run.ticks(), std::move(what)});
    return;
  }
}

void add(RollbackFuzzReport& sum, RollbackFuzzReport&& part) {
  sum.worlds += part.worlds;
  sum.rollbacks += part.rollbacks;
  sum.ticks += part.ticks;
  sum.computed_islands += part.computed_islands;
  sum.recalled_islands += part.recalled_islands;
  sum.partial_ticks += part.partial_ticks;
  sum.whole_ticks += part.whole_ticks;
  for (RollbackFailure& failure : part.failures)
    sum.failures.push_back(std::move(failure));
}

}  // namespace

RollbackFuzzReport fuzz_rollbacks(const RollbackFuzzOptions& options) {
  RollbackFuzzReport sum;
  std::mutex mutex;
  tool::for_blocks(options.count, 1, options.threads, [&](std::uint64_t i, std::uint64_t /*one*/) {
    RollbackFuzzReport part;
    run_world(options, options.first + i, part);
    const std::lock_guard lock(mutex);
    add(sum, std::move(part));
  });
  std::ranges::sort(sum.failures, {}, &RollbackFailure::index);
  return sum;
}

}  // namespace lockstone::fuzz
