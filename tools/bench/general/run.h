// Many seeds of many families by several engines, in parallel, and their results.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/bench/general/watch.h"

namespace lockstone::bench {

struct GeneralOptions {
  std::vector<const Family*> families;
  std::vector<GeneralMaker> engines;  ///< those that are in this build
  std::uint64_t first_seed = 1;
  int seeds = 20;
  int substeps = 4;
  int threads = 1;
};

/// One engine's figures of one family, by seed.
struct FamilyRun {
  const Family* family = nullptr;
  std::string engine;
  std::vector<std::optional<GeneralFigures>> figures;

  [[nodiscard]] int failures() const;
  /// The quantile of a figure over the seeds that were played; 1: the worst.
  [[nodiscard]] double quantile_of(double GeneralFigures::*figure, double share) const;
};

/// By family, then engine. `progress` is called from any thread, one at a time.
[[nodiscard]] std::vector<FamilyRun> run_general(const GeneralOptions& options,
                                                 void (*progress)(int done, int total));

/// The smallest cap of counts with which the scene still fails; `k_no_cap` when it does not fail.
[[nodiscard]] int shrink_general(const GeneralMaker& maker, const Family& family,
                                 std::uint64_t seed, int substeps);

}  // namespace lockstone::bench
