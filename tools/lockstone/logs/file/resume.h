// A match whose server was killed, from its log.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/simulation.h>

#include "tools/tool/games.h"

namespace lockstone::tool {

/// The state after the last tick whose hash is in the log, and the players at that tick.
struct ResumedMatch {
  Match match;
  replay::LogHeader header;
  net::SlotMask playing_mask = 0;  ///< bit n: slot n had a player in the last tick
};

/// Nothing, with a complaint: no log, one that has its end, that is damaged in the middle, or whose
/// ticks give other hashes here.
[[nodiscard]] std::optional<ResumedMatch> load_killed_match(const Games& games,
                                                            const std::string& path);

/// Copies the log at `path` into the recorder, keyframes and events included. The recorder has
/// begun and stands at its first tick.
[[nodiscard]] Status copy_log(const std::string& path, replay::Recorder& recorder);

}  // namespace lockstone::tool
