// Runs a speed scene under a clock.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <lockstone/world.h>

#include "tools/bench/speed/speed_scene.h"
#include "tools/bench/support/measure.h"

namespace lockstone::bench {

struct SpeedOptions {
  std::uint32_t ticks = 0;  ///< 0: as many as the scene says
  int repeats = 3;          ///< each from the beginning; a tick's time is the median over them
  BroadPhaseKind broad_phase = BroadPhaseKind::tree;
  Clock clock = now_nanoseconds;
  std::vector<std::uint32_t> threads = {1};  ///< each has its own result; they take turns
  bool detail = false;                       ///< one more run with a clock around each pair
};

/// Of one tick, in nanoseconds.
struct TickTimes {
  double whole = 0;
  std::array<double, k_step_stages> stages{};
};

struct SpeedResult {
  const SpeedScene* scene = nullptr;
  std::uint32_t threads = 1;
  std::uint32_t bodies = 0;  ///< at the end, static ones included
  std::vector<TickTimes> times;
  std::vector<StepReport> reports;
  double hash_nanoseconds = 0;  ///< of the whole state at the end, besides the tick
  std::uint64_t hash = 0;       ///< of the final state
  bool hashes_agree = true;     ///< over all repeats, numbers of threads, and the run in detail
  StepProfile detail;           ///< in nanoseconds, the clock's own time included

  /// capacity_exhausted when any tick said so: the times are those of less work.
  [[nodiscard]] Status status() const;

  [[nodiscard]] double quantile_of_ticks(double share) const;  ///< ns
  [[nodiscard]] double sum_of_ticks() const;                   ///< ns
  [[nodiscard]] double sum_of(StepStage stage) const;          ///< ns

  /// Summed over all ticks.
  [[nodiscard]] std::uint64_t sum(std::uint32_t StepReport::*counter) const;
};

/// One for each number of threads.
[[nodiscard]] std::vector<SpeedResult> run_speed(const SpeedScene& scene,
                                                 const SpeedOptions& options);

}  // namespace lockstone::bench
