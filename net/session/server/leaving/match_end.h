// The end of a match: after the last tick, by a desync, or for want of players.
#pragma once

#include "net/session/server/data/server_data.h"
#include "net/session/server/desync/desync_cases.h"

namespace lockstone::net {

/// Decides that the match ends and tells everybody why. Nobody is disconnected here.
class MatchEnd {
 public:
  MatchEnd(ServerData& data, DesyncCases& cases) : data_(data), cases_(cases) {}

  /// No further ticks: from now on the match waits for the last hashes. In the lobby it ends at
  /// once.
  void begin_finishing();

  /// Finishes when everybody's last hash is compared, so that a difference in the last tick is
  /// found too, or when that takes too long.
  void try_finish();

  /// Finishes if nobody plays and nobody is expected back.
  void finish_if_deserted();

  /// Reports the open cases and tells the players that the match is over. Does nothing the second
  /// time.
  void finish(FinishReason reason);

 private:
  ServerData& data_;
  DesyncCases& cases_;
};

}  // namespace lockstone::net
