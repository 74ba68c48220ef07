#include "tools/fuzz/fuzz_run.h"

#include <algorithm>
#include <mutex>

#include "tools/fuzz/pair_checks.h"
#include "tools/support/for_blocks.h"

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

FuzzReport check_block(const FuzzOptions& options, HullPool& pool, std::uint64_t first,
                       std::uint64_t count) {
  FuzzReport report;
  for (std::uint64_t index = first; index < first + count; ++index) {
    const Pair pair = make_pair(pool, options.seed, index, options.kinds, options.places);
    Verdict verdict(index);
    check_pair(pair, verdict);
    add(pair, verdict, index, report);
  }
  return report;
}

}  // namespace

std::vector<Kind> all_kinds() {
  return {Kind::sphere,          Kind::capsule,     Kind::box,         Kind::hull,
          Kind::triangle,        Kind::half_space,  Kind::cylinder,    Kind::cone,
          Kind::tapered_capsule, Kind::rounded_box, Kind::rounded_hull};
}

FuzzReport fuzz_pairs(const FuzzOptions& asked) {
  FuzzOptions options = asked;
  if (options.kinds.empty()) options.kinds = all_kinds();
  HullPool pool(options.seed);
  FuzzReport sum;
  std::mutex mutex;
  tool::for_blocks(
      options.count, k_block, options.threads, [&](std::uint64_t first, std::uint64_t count) {
        const FuzzReport part = check_block(options, pool, options.first + first, count);
        const std::lock_guard lock(mutex);
        add(part, sum);
      });
  std::ranges::sort(sum.failures, {}, &PairFailure::index);
  return sum;
}

}  // namespace lockstone::fuzz
