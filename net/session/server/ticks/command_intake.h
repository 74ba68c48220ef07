// The commands of the players and of the server itself, as they come, and the tick of each.
#pragma once

#include <cstddef>
#include <cstdint>

#include <lockstone/bytes.h>

#include "net/session/server/data/server_data.h"

namespace lockstone::net {

/// Puts pieces together, refuses commands beyond the limits, and binds whole commands to ticks.
class CommandIntake {
 public:
  explicit CommandIntake(ServerData& data) : data_(data) {}

  /// A piece of a player's command. False for a packet that breaks the format or comes out of turn;
  /// then it had no effect.
  [[nodiscard]] bool on_command(const Peer& peer, ByteView packet);

  /// A command of the server's own.
  [[nodiscard]] Status give(ByteView bytes);

  /// The commands that wait belong to the next tick from now on, as many as it may have: first the
  /// server's, then those of the slots, each tick beginning with another slot. Returns their
  /// number.
  [[nodiscard]] std::uint8_t bind_to_next_tick();

 private:
  /// The commands of a tick so far.
  struct Bound {
    std::size_t commands = 0;
    std::size_t bytes = 0;
  };
  [[nodiscard]] bool begin(Seat& seat, std::size_t total_bytes);
  void conclude(const Peer& peer, bool taken);
  void bind(CommandBuffer& waiting, std::uint8_t slot, Bound& bound);

  ServerData& data_;
};

}  // namespace lockstone::net
