#include "tools/fuzz/fuzz_run.h"

#include <atomic>
#include <mutex>
#include <thread>

#include "tools/fuzz/pair_checks.h"

namespace lockstone::fuzz {
namespace {

constexpr std::uint64_t k_block = 256;

void add(const Pair& pair, const Verdict& verdict, std::uint64_t index, FuzzReport& report) {
  const auto [low, high] = std::minmax(pair.a.kind, pair.b.kind);
  ++report.pairs;
  ++report.kinds[static_cast<std::size_t>(low)][static_cast<std::size_t>(high)];
  for (std::size_t i = 0; i < k_checks; ++i)
    report.figures[i].add(verdict.figures()[i]);
  if (!verdict.failed()) return;
  ++report.failed_pairs;
  report.failures.push_back({index, verdict});
}

void add(const FuzzReport& part, FuzzReport& report) {
  report.pairs += part.pairs;
  report.failed_pairs += part.failed_pairs;
  for (std::size_t a = 0; a < k_kinds; ++a)
    for (std::size_t b = 0; b < k_kinds; ++b)
      report.kinds[a][b] += part.kinds[a][b];
  for (std::size_t i = 0; i < k_checks; ++i)
    report.figures[i].add(part.figures[i]);
  report.failures.insert(report.failures.end(), part.failures.begin(), part.failures.end());
}

// The indices of one run, handed out in blocks.
class Work {
 public:
  Work(const FuzzOptions& options, HullPool& pool) : options_(options), pool_(pool) {
    if (options_.kinds.empty()) options_.kinds = all_kinds();
  }

  void run() {
    FuzzReport part;
    for (;;) {
      const std::uint64_t done = next_.fetch_add(k_block);
      if (done >= options_.count) break;
      check_block(options_.first + done, std::min(k_block, options_.count - done), part);
    }
    const std::lock_guard lock(mutex_);
    add(part, report_);
  }

  FuzzReport take() {
    std::ranges::sort(report_.failures, {}, &PairFailure::index);
    return std::move(report_);
  }

 private:
  void check_block(std::uint64_t first, std::uint64_t count, FuzzReport& report) {
    for (std::uint64_t index = first; index < first + count; ++index) {
      const Pair pair = make_pair(pool_, options_.seed, index, options_.kinds);
      Verdict verdict(index);
      check_pair(pair, verdict);
      add(pair, verdict, index, report);
    }
  }

  FuzzOptions options_;
  HullPool& pool_;
  std::atomic<std::uint64_t> next_{0};
  std::mutex mutex_;
  FuzzReport report_;
};

}  // namespace

std::vector<Kind> all_kinds() {
  return {Kind::sphere, Kind::capsule, Kind::box, Kind::hull, Kind::triangle, Kind::half_space};
}

FuzzReport fuzz_pairs(const FuzzOptions& options) {
  HullPool pool(options.seed);
  Work work(options, pool);
  std::vector<std::thread> threads;
  for (int i = 1; i < options.threads; ++i)
    threads.emplace_back([&work] { work.run(); });
  work.run();
  for (std::thread& thread : threads)
    thread.join();
  return work.take();
}

}  // namespace lockstone::fuzz
