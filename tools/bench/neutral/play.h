// Plays a scene by an engine: once for the results, and again for the time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/neutral/engine.h"

namespace lockstone::bench {

/// An engine's run of a scene at a setting.
struct Played {
  std::string engine;
  std::string scene;
  int setting = 0;
  std::vector<double> cpu_seconds;  ///< of each repeat, a simulated second
  std::uint64_t hash = 0;
  std::string note;
  std::vector<std::vector<BodyState>> samples;  ///< every this many ticks, of all watched bodies

  [[nodiscard]] double median_seconds() const;
};

/// Records the run; nothing when the engine cannot do the scene. A run of more than half a second
/// is its own first repeat: the recording takes little time beside that.
[[nodiscard]] std::optional<Played> play(const NeutralMaker& maker, const NeutralScene& scene,
                                         int setting);

/// The same again without looking at anything; adds its time. Nothing once all repeats together
/// took half a second: long runs need no median.
void time_again(const NeutralMaker& maker, const NeutralScene& scene, Played& played);

}  // namespace lockstone::bench
