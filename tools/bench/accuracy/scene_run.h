// A world stepped for a row of accuracy: its time is taken, its last state hashed.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <lockstone/world.h>

#include "tools/bench/accuracy/accuracy.h"

namespace lockstone::bench {

/// Ticks a second and substeps a tick.
struct Setting {
  std::uint16_t tick_rate = 60;
  std::uint8_t substeps = 4;

  [[nodiscard]] std::string name() const;
  friend bool operator==(const Setting&, const Setting&) = default;
};

/// The setting for which the goals are set.
inline constexpr Setting k_usual_setting{};

class SceneRun {
 public:
  /// `def` with the setting's tick rate and substeps.
  SceneRun(const Setting& setting, WorldDef def, std::shared_ptr<const AssetSet> assets = nullptr);

  [[nodiscard]] World& world() { return world_; }
  [[nodiscard]] const Setting& setting() const { return setting_; }
  BodyHandle add(const BodyDef& def);
  void step();
  /// As many ticks as a time in seconds holds.
  void run(double seconds);

  /// The result of a run at `setting`, judged when that is the usual one.
  [[nodiscard]] AccuracyResult result(std::string name, std::string unit, double worst,
                                      double goal) const;

 private:
  Setting setting_;
  World world_;
  std::uint64_t ticks_ = 0;
  std::uint64_t nanoseconds_ = 0;
};

/// The results of `measure` at 1, 2, 4, 8 and 16 substeps.
[[nodiscard]] std::vector<AccuracyResult> over_substeps(
    const std::function<AccuracyResult(const Setting&)>& measure);

/// The same at 30, 60, 120 and 240 ticks a second.
[[nodiscard]] std::vector<AccuracyResult> over_tick_rates(
    const std::function<AccuracyResult(const Setting&)>& measure);

}  // namespace lockstone::bench
