// One judge for all engines: errors from the recorded motion of a scene's bodies.
#pragma once

#include <span>
#include <string_view>

#include "tools/bench/neutral/play.h"

namespace lockstone::bench {

/// A figure of a scene. Rows are those of `lockstone bench accuracy`; 0: of none.
struct JudgedError {
  std::string_view scene;
  int row = 0;
  std::string_view name;  ///< of the chart: letters, digits and hyphens
  std::string_view title;
  std::string_view unit;
  double goal = 0;  ///< of ours at 4 substeps; 0: none
  double (*error)(const NeutralScene& scene, const Played& played) = nullptr;
};

/// By row.
[[nodiscard]] std::span<const JudgedError> judged_errors();

/// The error of an engine that lost a body or a number.
inline constexpr double k_lost = 1e3;

/// Below it all errors are alike.
inline constexpr double k_least_error = 1e-9;

/// Between k_least_error and k_lost; NaN is lost.
[[nodiscard]] double judge(const JudgedError& error, const NeutralScene& scene,
                           const Played& played);

}  // namespace lockstone::bench
