// Names and ratios that the printed forms of a benchmark share.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/profile.h>

namespace lockstone::tool {

#if defined(LKS_ENABLE_ASSERTS)
inline constexpr bool k_asserts = true;
#else
inline constexpr bool k_asserts = false;
#endif

/// To be printed beside times that mean little.
inline constexpr std::string_view k_build_remark =
    k_asserts ? "; asserts are on: not a build to measure" : "";

[[nodiscard]] std::array<StepStage, k_step_stages> all_stages();

/// One row of the table of pairs.
struct PairRow {
  std::string name;  ///< "sphere-box"
  const PairProfile* profile;
};

/// The kinds of pairs that occurred. Points into the profile.
[[nodiscard]] std::vector<PairRow> pair_rows(const StepProfile& profile);

/// The time of all pairs of a row without the clock's own time in each.
[[nodiscard]] double net_nanoseconds(const PairProfile& pairs, double clock_nanoseconds);

/// 0 for none.
template <class Count>
[[nodiscard]] double per(double value, Count count) {
  return count == 0 ? 0 : value / static_cast<double>(count);
}

}  // namespace lockstone::tool
