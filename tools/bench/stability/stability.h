// Things that break engines: each a scene that runs long, and figures that must stay within bounds.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lockstone::bench {

struct StabilityOptions {
  double seconds = 0;  ///< of the world's time; 0: as long as the row asks for
};

/// One line of a row.
struct StabilityFigure {
  std::string name;
  std::string unit;
  double value = 0;  ///< the worst over the run, or of its end
  double bound = 0;

  [[nodiscard]] bool met() const { return value <= bound; }
};

struct StabilityResult {
  std::vector<StabilityFigure> figures;
  std::uint64_t ticks = 0;
  double tick_seconds = 0;  ///< processor time of a tick
  std::uint64_t hash = 0;   ///< of the last state
};

struct StabilityRow {
  std::string_view name;
  std::string_view text;
  double seconds = 600;  ///< as a rule
  StabilityResult (*run)(double seconds) = nullptr;
};

[[nodiscard]] std::span<const StabilityRow> stability_rows();

/// Null for an unknown name.
[[nodiscard]] const StabilityRow* find_stability_row(std::string_view name);

[[nodiscard]] StabilityResult run_stability_row(const StabilityRow& row,
                                                const StabilityOptions& options);

// Rows, by file.
[[nodiscard]] std::span<const StabilityRow> heap_rows();
[[nodiscard]] std::span<const StabilityRow> extreme_rows();
[[nodiscard]] std::span<const StabilityRow> joint_rows();
[[nodiscard]] std::span<const StabilityRow> limit_rows();

}  // namespace lockstone::bench
