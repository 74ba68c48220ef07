// Steps the confirmed ticks, when each is due.
#pragma once

#include <cstdint>

#include "net/session/client/client_data.h"
#include "net/session/client/prediction.h"

namespace lockstone::net {

/// Brings the simulation from one confirmed tick to the next, and keeps the hash and the snapshot
/// of each state.
class Playback {
 public:
  Playback(ClientData& data, Prediction& prediction) : data_(data), prediction_(prediction) {}

  /// Steps the ticks that are due. Stops where the server has not acknowledged hashes for so long
  /// that the snapshots would be lost which a report of a difference needs.
  void advance() { step_ticks(unacknowledged_limit()); }

  /// The match is over: steps all that is here, at once.
  void step_rest();

 private:
  void step_ticks(std::uint64_t unacknowledged_limit);
  [[nodiscard]] std::uint64_t unacknowledged_limit() const;
  [[nodiscard]] bool is_due(std::uint64_t tick) const;
  [[nodiscard]] std::uint64_t step_next();
  void note_stepped(std::uint64_t hash);
  void note_replaced_input(std::uint64_t tick, InputOrigin origin);

  ClientData& data_;
  Prediction& prediction_;
};

}  // namespace lockstone::net
