// The records of COMMAND chunks as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/replay/format.h>
#include <lockstone/simulation.h>

#include "replay/codec/decode_fault.h"

namespace lockstone::replay {

/// Bytes of a record without the command.
inline constexpr std::size_t k_command_fixed_bytes = 13;

/// Whether a log of this many players may hold the command.
[[nodiscard]] bool is_command(const PlayerCommand& command, std::size_t player_count);

void encode_command(ByteWriter& writer, std::uint64_t tick, const PlayerCommand& command);

/// The decoded content of a COMMAND chunk.
class CommandBlock {
 public:
  void clear();

  /// Replaces the content. `count` is the chunk's claim and is not trusted; the ticks ascend from
  /// `first_tick` on.
  [[nodiscard]] DecodeFault decode(ByteView payload, std::uint32_t count, std::uint64_t first_tick,
                                   std::size_t player_count);

  [[nodiscard]] std::span<const PlayerCommand> all() const { return commands_; }
  [[nodiscard]] std::span<const PlayerCommand> of(std::uint64_t tick) const;

  /// No command is of this tick or a later one.
  [[nodiscard]] std::uint64_t end_tick() const { return ticks_.empty() ? 0 : ticks_.back() + 1; }

 private:
  [[nodiscard]] DecodeFault decode_one(ByteReader& reader, std::uint64_t first_tick,
                                       std::size_t player_count);

  std::vector<std::byte> bytes_;  ///< the views point into it
  std::vector<std::uint64_t> ticks_;
  std::vector<PlayerCommand> commands_;
};

}  // namespace lockstone::replay
