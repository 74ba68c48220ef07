// A summary of a log, without simulating anything.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/replay/format.h>
#include <lockstone/replay/source.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// The chunks of one type.
struct ChunkTypeTotals {
  ChunkType type = ChunkType::none;
  std::uint64_t chunks = 0;
  std::uint64_t raw_bytes = 0;     ///< payloads after decoding
  std::uint64_t stored_bytes = 0;  ///< in the file, frames included
};

/// How many events LogInfo lists; the rest are counted.
inline constexpr std::size_t k_max_listed_events = 10'000;

struct LogInfo {
  LogHeader header;
  std::uint64_t file_bytes = 0;
  std::uint64_t config_bytes = 0;
  std::uint64_t ticks = 0;                  ///< with a recorded hash
  std::uint64_t duration_milliseconds = 0;  ///< of these ticks at the log's tick rate
  std::uint64_t last_hash = 0;
  std::vector<ChunkTypeTotals> chunk_types;  ///< those that occur, by type
  std::vector<std::uint64_t> keyframe_ticks;
  std::vector<LogEvent> events;  ///< the first k_max_listed_events
  std::uint64_t event_count = 0;
  std::uint64_t commands = 0;                       ///< of players and the server
  std::uint64_t command_bytes = 0;                  ///< of all together
  std::vector<std::string> player_names;            ///< by slot, the last of each; empty: not told
  std::array<std::uint64_t, 4> inputs_by_origin{};  ///< indexed by InputOrigin, over all slots
  bool complete = false;
  bool torn_tail = false;
  std::string end_reason;
  std::optional<Damage> damage;  ///< also of a torn tail; the whole part before it is summed up
};

/// Reads a whole log, checking it as LogReader does. An error only when the file header is damaged,
/// with `damage`, where given, saying more; damage further on is part of the answer.
[[nodiscard]] Result<LogInfo> read_log_info(Source& source, Damage* damage = nullptr);

}  // namespace lockstone::replay
