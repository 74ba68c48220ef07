// The pages that `bench accuracy --page` and `bench stability --page` write: Markdown tables.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/bench/accuracy/accuracy.h"
#include "tools/bench/stability/stability.h"

namespace lockstone::tool {

struct MeasuredAccuracy {
  const bench::AccuracyRow* row = nullptr;
  std::vector<bench::AccuracyResult> results;
  double seconds = 0;
};

struct MeasuredStability {
  const bench::StabilityRow* row = nullptr;
  bench::StabilityResult result;
};

/// Figures that were measured at the same settings share a table, a column each.
[[nodiscard]] std::string accuracy_page(std::span<const MeasuredAccuracy> rows,
                                        std::string_view command);

[[nodiscard]] std::string stability_page(std::span<const MeasuredStability> rows,
                                         std::string_view command);

}  // namespace lockstone::tool
