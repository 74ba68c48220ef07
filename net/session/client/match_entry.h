// How a client comes into a match: with everybody at tick 0, from a snapshot, or from the state
// that it still has.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/bytes.h>

#include "net/session/client/client_data.h"
#include "net/session/client/input_sender.h"
#include "net/session/client/prediction.h"

namespace lockstone::net {

/// Gathers the pieces of a snapshot, and sets all counters to the tick at which the client begins.
/// Messages return false for a packet that breaks the format or comes out of turn.
class MatchEntry {
 public:
  MatchEntry(ClientData& data, Prediction& prediction, InputSender& sender)
      : data_(data), prediction_(prediction), sender_(sender) {}

  /// Takes the memory for a snapshot; 0: none is taken.
  void reserve(std::size_t snapshot_bytes) { snapshot_.resize(snapshot_bytes); }

  /// Forgets the pieces of a snapshot that is not complete.
  void cancel() { received_bytes_ = 0; }

  /// The simulation stands after `ticks` ticks, and the next one is to come.
  void begin(std::uint64_t ticks);

  [[nodiscard]] bool on_start(ByteView packet);
  [[nodiscard]] bool on_snapshot(ByteView packet);
  [[nodiscard]] bool on_activate(ByteView packet);

 private:
  void load(const Snapshot& last_piece);

  ClientData& data_;
  Prediction& prediction_;
  InputSender& sender_;
  std::vector<std::byte> snapshot_;  ///< comes in pieces
  std::size_t received_bytes_ = 0;
  std::uint64_t ticks_ = 0;  ///< of the snapshot
};

}  // namespace lockstone::net
