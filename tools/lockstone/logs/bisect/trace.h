// This build's hashes for a log, tick by tick.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <lockstone/status.h>

#include "tools/lockstone/logs/bisect/stage_trace.h"
#include "tools/lockstone/logs/file/log_file.h"

namespace lockstone::tool {

struct Trace {
  std::uint64_t first_tick = 0;
  std::vector<std::uint64_t> hashes;  ///< after each tick
  std::uint64_t agreed = 0;           ///< ticks from the first on whose hash is the recorded one
};

/// Hashes after the stages of a tick, simulated from the log's beginning.
[[nodiscard]] std::optional<StageTrace> stages_of(const GameLog& log, std::uint64_t tick);

/// Simulates from the log's beginning. On an error it complains.
[[nodiscard]] Result<Trace> trace_log(const GameLog& log);

}  // namespace lockstone::tool
