// Spectators: they get the same packets as players, later and less often, and nobody waits for
// them.
#pragma once

#include <cstdint>

#include "net/session/server/data/server_data.h"
#include "net/session/server/data/tick_sender.h"
#include "net/session/server/entry/entry_states.h"
#include "net/session/server/entry/player_entry.h"
#include "net/session/server/leaving/departures.h"

namespace lockstone::net {

/// Admits spectators, brings them up to the ticks that they may see, and drops those who lack too
/// many.
class Spectators {
 public:
  /// The parts of the server that it uses.
  struct Uses {
    EntryStates& states;
    const PlayerEntry& entry;
    TickSender& sender;
    Departures& departures;
  };
  Spectators(ServerData& data, const Uses& uses) : data_(data), uses_(uses) {}

  /// Whether one more may come; otherwise the reason.
  [[nodiscard]] Refusal judge() const;

  /// Gives the peer a free place. Only if `judge` refuses nobody.
  void admit(Peer& peer);

  /// Sends states and ticks to everybody for whom some are due.
  void serve();

 private:
  void welcome_to_running_match(Watcher& watcher);
  void offer_state(Watcher& watcher);
  [[nodiscard]] bool is_too_far_behind(const Watcher& watcher) const;
  void tell_end();

  ServerData& data_;
  Uses uses_;
};

}  // namespace lockstone::net
