#include "net/session/server/data/peers.h"

#include <algorithm>

namespace lockstone::net {

Peer* Peers::find(ConnectionId connection) {
  const auto found = std::find_if(places_.begin(), places_.end(), [connection](const Peer& peer) {
    return peer.stage != Stage::unused && peer.connection == connection;
  });
  return found == places_.end() ? nullptr : &*found;
}

Peer* Peers::open(ConnectionId connection, std::int64_t now_us) {
  const auto place = std::find_if(places_.begin(), places_.end(),
                                  [](const Peer& peer) { return peer.stage == Stage::unused; });
  if (place == places_.end()) return nullptr;
  *place = {};
  place->connection = connection;
  place->stage = Stage::connected;
  place->since_us = now_us;
  place->watch.heard(now_us);
  place->identity = transport_->identity(connection);
  return &*place;
}

}  // namespace lockstone::net
