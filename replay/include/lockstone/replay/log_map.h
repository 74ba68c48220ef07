// Where the keyframes of a log stand, so that it can be read from the middle.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/replay/format.h>
#include <lockstone/replay/source.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// A KEYFRAME chunk.
struct KeyframePlace {
  std::uint64_t tick = 0;    ///< the state at this tick
  std::uint64_t offset = 0;  ///< of the chunk in the file

  friend bool operator==(const KeyframePlace&, const KeyframePlace&) = default;
};

/// Read from the frames alone; the payloads are not read.
struct LogMap {
  std::uint64_t ticks = 0;  ///< with a recorded hash
  std::vector<KeyframePlace> keyframes;
};

/// Walks the frames of a log up to its end or to the first damage. Empty if the source is not a
/// log.
[[nodiscard]] LogMap map_log(Source& source);

/// The keyframes that the log's INDEX names: all, or every second, fourth, … of a very long match.
/// not_found for a log without one; else the status of its damage.
[[nodiscard]] Result<std::vector<KeyframePlace>> read_index(Source& source);

/// The last keyframe at or before `tick`, from the index where there is a good one. not_found when
/// the log has none so early.
[[nodiscard]] Result<KeyframePlace> find_keyframe(Source& source, std::uint64_t tick);

}  // namespace lockstone::replay
