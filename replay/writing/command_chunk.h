// The COMMAND chunk that is being composed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include <lockstone/replay/format.h>
#include <lockstone/simulation.h>

#include "replay/chunks/chunk_writer.h"

namespace lockstone::replay {

/// Holds the commands of recorded ticks, and behind them those of the tick that is recorded next.
/// Allocates when made only.
class CommandChunk {
 public:
  CommandChunk();

  /// Whether a log of this many players may hold all of them in one tick.
  [[nodiscard]] bool takes(std::span<const PlayerCommand> commands, std::size_t players) const;
  /// Whether there is room for them; otherwise there is, once the chunk was sealed.
  [[nodiscard]] bool has_room(std::span<const PlayerCommand> commands) const;

  /// Commands of the tick that is recorded next.
  void add(std::uint64_t tick, std::span<const PlayerCommand> commands);
  [[nodiscard]] std::span<const PlayerCommand> next() const { return next_; }
  /// That tick is recorded.
  void note_tick();

  [[nodiscard]] bool empty() const { return count_ == 0; }
  /// The sealed chunk, until the next call.
  [[nodiscard]] std::span<std::byte> seal(ChunkWriter& writer, std::uint64_t first_tick);
  /// It is written: the next one begins.
  void restart();

 private:
  [[nodiscard]] std::span<std::byte> room() const;

  std::unique_ptr<std::byte[]> bytes_;  ///< not initialised: unused pages cost no memory
  std::size_t end_;                     ///< of the recorded ticks' commands
  std::size_t next_end_;                ///< of the next tick's commands
  std::uint32_t count_ = 0;             ///< commands of recorded ticks
  std::vector<PlayerCommand> next_;     ///< the views point into the chunk
};

}  // namespace lockstone::replay
