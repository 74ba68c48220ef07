// Brings a simulation to any tick of a log.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include <lockstone/replay/source.h>
#include <lockstone/replay/tick_reader.h>
#include <lockstone/simulation.h>

namespace lockstone::replay {

/// Where seek() arrived.
struct SeekResult {
  Status status = Status::ok;
  std::string what;  ///< one line for people when the status is not ok
  std::unique_ptr<Simulation> simulation;
  std::unique_ptr<TickReader> ticks;  ///< stands before the tick: next() reads it
  std::uint64_t loaded_tick = 0;      ///< of the keyframe that was started from
  bool same_canary = true;            ///< false: this build computes something else than the log's
  /// The first tick on the way whose hash was not the recorded one; `diverged` tells whether any.
  bool diverged = false;
  std::uint64_t diverged_tick = 0;
};

enum class SeekFrom : std::uint8_t {
  keyframe,   ///< the last one at or before the tick
  beginning,  ///< the log's, so that no recorded state but the first is used
};
[[nodiscard]] std::string_view to_string(SeekFrom from);

/// The state at `tick`: loads the last keyframe at or before it and steps on with the log's inputs.
/// not_found when the log does not reach so far; incompatible when it is of another simulation.
/// Only the canary may differ, so that the states of builds that compute different results can be
/// compared. `source` must outlive the result.
[[nodiscard]] SeekResult seek(Source& source, const SimulationFactory& factory, std::uint64_t tick,
                              SeekFrom from = SeekFrom::keyframe);

}  // namespace lockstone::replay
