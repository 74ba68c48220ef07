// Players who enter a match that runs: late ones, those who come back, those whose state was wrong.
//
// A player that enters gets the canonical snapshot of an agreed state, then the ticks since. When
// it has caught up, the tick from which on it plays is announced. Nobody else waits.
#pragma once

#include <cstdint>

#include <lockstone/bytes.h>

#include "net/session/server/data/server_data.h"
#include "net/session/server/entry/entry_states.h"
#include "net/session/server/leaving/departures.h"

namespace lockstone::net {

/// Brings each player from its welcome to its first tick.
class PlayerEntry {
 public:
  PlayerEntry(ServerData& data, EntryStates& states, Departures& departures)
      : data_(data), states_(states), departures_(departures) {}

  /// Welcomes the player that sat down in `slot`.
  void begin(std::uint8_t slot, const Peer& peer);

  /// The player of `slot` goes on from the right state; until then its slot is absent.
  void resync(std::uint8_t slot);

  /// Moves every player that enters one step on, if it can.
  void advance();

  /// The client's word on a snapshot. False for a packet that breaks the format or comes out of
  /// turn.
  [[nodiscard]] bool on_snapshot_taken(Peer& peer, ByteView packet);

  /// Whether the state that a client still has is one of this match, so that it can go on from it.
  [[nodiscard]] bool has_right_state(const Peer& peer) const;

 private:
  void try_activate(std::uint8_t slot);

  ServerData& data_;
  EntryStates& states_;
  Departures& departures_;
};

}  // namespace lockstone::net
