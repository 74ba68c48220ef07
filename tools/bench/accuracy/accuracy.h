// Rows of accuracy: each measures a quantity against a reference and reports the worst error.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lockstone::bench {

struct AccuracyOptions {
  std::uint64_t seed = 1;
  std::uint64_t tries = 0;  ///< 0: the row's own number
  std::uint64_t first = 0;  ///< try to begin with
  int threads = 1;
  bool sweep = false;  ///< rows of contact: 1 to 16 substeps instead of 4
};

/// One line of a row.
struct AccuracyResult {
  std::string name;
  std::string unit;
  std::uint64_t tries = 0;
  double worst = 0;  ///< error, or how many were wrong
  double goal = 0;
  std::string note;         ///< which tries were wrong, say
  double tick_seconds = 0;  ///< processor time of a tick, where a scene was stepped
  std::uint64_t hash = 0;   ///< of the scene's last state
  std::string setting{};    ///< ticks a second and substeps, where a row can do with others
  bool judged = true;       ///< false: another setting, shown beside the one with the goal

  [[nodiscard]] bool met() const { return !judged || worst <= goal; }
};

/// A row of the table, by its number there.
struct AccuracyRow {
  int number = 0;
  std::string_view name;
  std::uint64_t tries = 0;  ///< as a rule
  std::vector<AccuracyResult> (*run)(const AccuracyOptions& options) = nullptr;
};

/// Ascending by number.
[[nodiscard]] std::span<const AccuracyRow> accuracy_rows();

[[nodiscard]] std::vector<AccuracyResult> measure_free_fall(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_drift(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_box_energy(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_box_momentum(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_box_flips(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_top(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_pendulum(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_double_pendulum(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_linkage(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_chain(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_rod_pendulum(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_heavy_chain(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_tunnels(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_queries(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_masses(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_cylinder(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_dzhanibekov(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_rod(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_damping(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_stopping(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_anisotropy(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_sticking(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_rolling(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_apex(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_bounces(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_cradle(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_stacks(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_mass_ratios(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_momentum(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_standing(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_carried_balls(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_monostable(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_thrown(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_bouncing_grid(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_heap(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_rest(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_overhang(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_elastic_cloud(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_far_away(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_vehicle(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_figures(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_drags(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_paths(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_air(const AccuracyOptions& options);

// Results of other methods; tools/bench/baselines.
[[nodiscard]] std::vector<AccuracyResult> measure_integrators(const AccuracyOptions& options);
[[nodiscard]] std::vector<AccuracyResult> measure_penalty(const AccuracyOptions& options);

}  // namespace lockstone::bench
