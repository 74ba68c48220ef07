// Runs the checks over many random pairs on several threads.
#pragma once

#include <cstdint>
#include <vector>

#include "tools/fuzz/pair_source.h"
#include "tools/fuzz/verdict.h"

namespace lockstone::fuzz {

struct FuzzOptions {
  std::uint64_t seed = 1;
  std::uint64_t first = 0;  ///< index
  std::uint64_t count = 100'000;
  int threads = 1;
  std::vector<Kind> kinds;  ///< empty: `all_kinds`
  Places places = Places::random;
};

struct PairFailure {
  std::uint64_t index = 0;
  Verdict verdict;
};

struct FuzzReport {
  std::uint64_t pairs = 0;
  std::uint64_t failed_pairs = 0;
  std::array<std::array<std::uint64_t, k_kinds>, k_kinds> kinds{};  ///< lower kind first
  std::array<Figure, k_checks> figures{};
  std::vector<PairFailure> failures;  ///< by index
};

[[nodiscard]] std::vector<Kind> all_kinds();

/// The same report whatever the number of threads.
[[nodiscard]] FuzzReport fuzz_pairs(const FuzzOptions& options);

}  // namespace lockstone::fuzz
