#include "tools/bench/stability/stability.h"

#include <algorithm>

namespace lockstone::bench {

std::span<const StabilityRow> stability_rows() {
  static const std::vector<StabilityRow> rows = [] {
    std::vector<StabilityRow> all;
    for (const auto& part : {heap_rows(), extreme_rows(), joint_rows(), limit_rows()})
      all.insert(all.end(), part.begin(), part.end());
    return all;
  }();
  return rows;
}

const StabilityRow* find_stability_row(std::string_view name) {
  const std::span<const StabilityRow> rows = stability_rows();
  const auto found = std::ranges::find(rows, name, &StabilityRow::name);
  return found == rows.end() ? nullptr : &*found;
}

StabilityResult run_stability_row(const StabilityRow& row, const StabilityOptions& options) {
  return row.run(options.seconds > 0 ? options.seconds : row.seconds);
}

}  // namespace lockstone::bench
