// The contact-row kernel on every target beside its like in floating point, in one run.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lockstone::bench {

struct RowBenchOptions {
  std::uint32_t bodies = 1024;
  std::uint32_t colours = 4;
  int repeats = 301;
  std::uint64_t seed = 1;
};

/// One competitor. Times are ns per contact and iteration.
struct RowBenchResult {
  std::string name;
  std::vector<double> times;
  std::uint64_t hash = 0;  // of the state after one repeat; 0 for floating point

  [[nodiscard]] double quantile(double share) const;
};

struct RowBench {
  std::size_t contacts = 0;
  std::vector<RowBenchResult> results;

  [[nodiscard]] bool hashes_agree() const;
  [[nodiscard]] const RowBenchResult* find(const std::string& name) const;
};

/// The competitors take turns within each repeat, so that a disturbance hits all of them alike.
[[nodiscard]] RowBench run_row_bench(const RowBenchOptions& options);

}  // namespace lockstone::bench
