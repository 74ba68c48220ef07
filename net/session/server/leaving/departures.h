// How peers leave a server: by their own will, because they are lost, or because they are sent
// away.
#pragma once

#include <cstdint>

#include "net/session/server/data/server_data.h"
#include "net/session/server/desync/desync_cases.h"
#include "net/session/server/leaving/match_end.h"

namespace lockstone::net {

/// Ends connections, and keeps or gives up the seats of their players.
class Departures {
 public:
  Departures(ServerData& data, DesyncCases& cases, MatchEnd& end)
      : data_(data), cases_(cases), end_(end) {}

  /// The transport has ended the connection.
  void connection_ended(Peer& peer, RefuseReason reason);

  /// Says good-bye to a peer and disconnects it; its seat is lost.
  void drop(Peer& peer, LeaveReason reason);

  /// The player of `slot` does not come back to this match.
  void expel(std::uint8_t slot, LeaveReason reason);

  /// Tells a peer in the handshake why it cannot take part, and disconnects it.
  void refuse(Peer& peer, const Refusal& refusal);

  /// Counts a packet that breaks the format; too many end the connection.
  void note_malformed(Peer& peer);

  /// Ends handshakes that take too long, and warns of silent peers, then drops them.
  void drop_silent();

  /// After the end: the clients leave; those that do not are left.
  void close_all();

 private:
  void release(Peer& peer);
  void lose_seat(std::uint8_t slot, LeaveReason reason);

  ServerData& data_;
  DesyncCases& cases_;
  MatchEnd& end_;
};

}  // namespace lockstone::net
