// Players who hold the match up, or fall so far behind that they could not go on.
#pragma once

#include <cstdint>

#include "net/session/server/data/server_data.h"
#include "net/session/server/entry/entry_states.h"
#include "net/session/server/leaving/departures.h"

namespace lockstone::net {

/// Tells for whom the match waits, and drops those who cannot or will not keep up.
class Laggards {
 public:
  Laggards(ServerData& data, const EntryStates& states, Departures& departures)
      : data_(data), states_(states), departures_(departures) {}

  /// Bit n: slot n's input for the next tick has not come.
  [[nodiscard]] SlotMask missing_inputs_mask() const;

  /// Bit n: slot n is about to lose ticks or snapshots that it needs.
  [[nodiscard]] SlotMask behind_mask() const;

  /// Drops those for whom the match has waited too long.
  void drop_waited_for();

  /// Before a tick is confirmed: drops those who would then lack ticks that are gone.
  void drop_behind();

  /// Drops players who take ticks and do not report their hashes.
  void drop_without_hashes();

 private:
  [[nodiscard]] std::uint64_t ticks_behind(std::uint8_t slot) const;

  ServerData& data_;
  const EntryStates& states_;
  Departures& departures_;
};

}  // namespace lockstone::net
