#include "tools/bench/rows/bench_rows.h"

#include <algorithm>
#include <chrono>
#include <functional>
#include <string_view>

#include "core/kernels/target.h"
#include "tools/bench/rows/float_rows.h"
#include "tools/bench/rows/integer_rows.h"
#include "tools/bench/support/measure.h"

namespace lockstone::bench {
namespace {

// In a repeat, after two to warm up.
constexpr int k_sweeps = 8;

struct Competitor {
  std::function<void()> reset;
  std::function<void()> sweep;
  std::function<std::uint64_t()> hash;
};

double nanoseconds_per_sweep(const Competitor& competitor) {
  using Clock = std::chrono::steady_clock;
  competitor.reset();
  for (int i = 0; i < 2; ++i)
    competitor.sweep();
  competitor.reset();
  const auto start = Clock::now();
  for (int i = 0; i < k_sweeps; ++i)
    competitor.sweep();
  return std::chrono::duration<double, std::nano>(Clock::now() - start).count() / k_sweeps;
}

#if defined(__SSE2__)
class FloatRuns {
 public:
  explicit FloatRuns(const RowScene& scene) : first_(scene), now_(first_) {}

  Competitor competitor(void (FloatRows::*sweep)()) {
    return {[this] { now_ = first_; }, [this, sweep] { (now_.*sweep)(); },
            [] { return std::uint64_t{0}; }};
  }

 private:
  FloatRows first_;
  FloatRows now_;
};
#endif

class IntegerRuns {
 public:
  explicit IntegerRuns(const RowScene& scene) : first_(scene), now_(first_) {}

  Competitor competitor(std::string_view target) {
    return {[this, target] {
              static_cast<void>(lanes::set_target(target));
              now_ = first_;
            },
            [this] { now_.sweep(); }, [this] { return now_.hash(); }};
  }

 private:
  IntegerRows first_;
  IntegerRows now_;
};

}  // namespace

double RowBenchResult::quantile(double share) const {
  return bench::quantile(times, share);
}

bool RowBench::hashes_agree() const {
  std::uint64_t first = 0;
  for (const RowBenchResult& result : results) {
    if (result.hash == 0) continue;
    if (first == 0) first = result.hash;
    if (result.hash != first) return false;
  }
  return true;
}

const RowBenchResult* RowBench::find(const std::string& name) const {
  const auto it = std::find_if(results.begin(), results.end(),
                               [&](const RowBenchResult& r) { return r.name == name; });
  return it == results.end() ? nullptr : &*it;
}

RowBench run_row_bench(const RowBenchOptions& options) {
  const RowScene scene = make_row_scene(options.bodies, options.colours, options.seed);
  RowBench bench;
  bench.contacts = scene.contacts.size();
  std::vector<Competitor> competitors;
#if defined(__SSE2__)
  FloatRuns floats(scene);
  bench.results.push_back({"float sse2", {}});
  competitors.push_back(floats.competitor(&FloatRows::sweep));
  bench.results.push_back({"float sse2, in twos", {}});
  competitors.push_back(floats.competitor(&FloatRows::sweep_in_twos));
#endif
  IntegerRuns integers(scene);
  for (const std::string_view target : lanes::supported_targets()) {
    bench.results.push_back({"int " + std::string(target), {}});
    competitors.push_back(integers.competitor(target));
  }
  for (int repeat = 0; repeat < options.repeats; ++repeat) {
    for (std::size_t i = 0; i < competitors.size(); ++i) {
      const double time = nanoseconds_per_sweep(competitors[i]);
      bench.results[i].times.push_back(time / static_cast<double>(bench.contacts));
      bench.results[i].hash = competitors[i].hash();
    }
  }
  return bench;
}

}  // namespace lockstone::bench
