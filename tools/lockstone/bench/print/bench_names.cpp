#include "tools/lockstone/bench/print/bench_names.h"

#include <algorithm>

#include <fmt/format.h>

namespace lockstone::tool {
namespace {

/// As `to_string`, in one word.
std::string numbered_kind(std::size_t kind) {
  std::string name(to_string(static_cast<ShapeKind>(kind)));
  std::ranges::replace(name, ' ', '-');
  return name;
}

}  // namespace

std::array<StepStage, k_step_stages> all_stages() {
  std::array<StepStage, k_step_stages> stages{};
  for (std::size_t i = 0; i < k_step_stages; ++i)
    stages[i] = static_cast<StepStage>(i);
  return stages;
}

std::vector<PairRow> pair_rows(const StepProfile& profile) {
  std::vector<PairRow> rows;
  for (std::size_t a = 0; a < StepProfile::k_kinds; ++a) {
    for (std::size_t b = a; b < StepProfile::k_kinds; ++b) {
      const PairProfile& pairs = profile.pair_kinds[a][b];
      if (pairs.pairs != 0)
        rows.push_back({fmt::format("{}-{}", numbered_kind(a), numbered_kind(b)), &pairs});
    }
  }
  return rows;
}

double net_nanoseconds(const PairProfile& pairs, double clock_nanoseconds) {
  const double net =
      static_cast<double>(pairs.ticks) - clock_nanoseconds * static_cast<double>(pairs.pairs);
  return std::max(net, 0.0);
}

}  // namespace lockstone::tool
