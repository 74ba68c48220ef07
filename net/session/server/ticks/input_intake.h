// The players' inputs and reports, as they come, and the inputs of a tick made of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/bytes.h>

#include "net/session/server/data/server_data.h"

namespace lockstone::net {

/// Takes each client's packet of inputs, hashes and progress. A player whose input for a tick has
/// not come when the tick is confirmed gets a substitute.
class InputIntake {
 public:
  explicit InputIntake(ServerData& data) : data_(data) {}

  /// False for a packet that breaks the format or comes out of turn; then it had no effect.
  [[nodiscard]] bool on_inputs(Peer& peer, ByteView packet);

  /// Writes the inputs of the next tick, which are then final.
  void fill_next(std::span<std::byte> record);

 private:
  [[nodiscard]] bool take_progress(const Peer& peer, const Inputs& message);
  void take_inputs(Seat& seat, const Inputs& message);
  void take_hashes(std::uint8_t slot, const Inputs& message);
  void note_margin(Seat& seat, std::uint64_t tick) const;
  void fill_slot(std::span<std::byte> record, std::uint8_t slot);

  ServerData& data_;
};

}  // namespace lockstone::net
