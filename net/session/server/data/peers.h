// The connections of a server: a fixed number of places, each with the stage of its handshake.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/net/server.h>
#include <lockstone/net/wire.h>

#include "net/session/peer_watch.h"

namespace lockstone::net {

/// The stages of a connection, in their order.
enum class Stage : std::uint8_t {
  unused,     ///< the place is free
  connected,  ///< has not said hello
  offered,    ///< has the match's configuration, and has not answered
  seated,     ///< a player
  watching,   ///< a spectator
};

/// A connection, and the peer's own word about itself.
struct Peer {
  ConnectionId connection = k_no_connection;
  Stage stage = Stage::unused;
  std::uint8_t slot = k_no_slot;  ///< of a seated one; k_spectator_slot of a watching one
  std::uint8_t wanted_slot = k_any_slot;
  PeerIdentity identity;
  std::uint64_t rejoin_key = 0;
  std::uint64_t ticks_stepped = 0;
  std::uint64_t state_hash = 0;
  BuildText build;
  std::int64_t since_us = 0;
  PeerWatch watch;
  PlayerName name;

  /// Through the handshake.
  [[nodiscard]] bool is_admitted() const { return stage >= Stage::seated; }
};

/// Finds, opens and closes the places of peers, and sends them messages. Peers never move in
/// memory: seats point to them. Allocates when made only.
class Peers {
 public:
  Peers(Transport& transport, std::size_t capacity)
      : transport_(&transport), places_(capacity), message_(k_max_message_bytes) {}

  [[nodiscard]] std::vector<Peer>& all() { return places_; }
  [[nodiscard]] const std::vector<Peer>& all() const { return places_; }

  /// The peer of a connection, or null.
  [[nodiscard]] Peer* find(ConnectionId connection);

  /// Gives a new connection a place; null: all are in use.
  Peer* open(ConnectionId connection, std::int64_t now_us);

  template <class Message>
  Status send(const Peer& peer, const Message& message, Channel channel = Channel::reliable) {
    const std::size_t size = encode(message, message_);
    return transport_->send(peer.connection, channel, ByteView(message_).first(size));
  }

  /// Sends to all players and spectators.
  template <class Message>
  void send_to_admitted(const Message& message) {
    for (const Peer& peer : places_) {
      if (peer.is_admitted()) tell(peer, message);
    }
  }

  /// Sends reliably. A full queue shows as silence, and silence as a time-out.
  template <class Message>
  void tell(const Peer& peer, const Message& message) {
    static_cast<void>(send(peer, message));
  }

 private:
  Transport* transport_;
  std::vector<Peer> places_;
  std::vector<std::byte> message_;  ///< the message being encoded
};

}  // namespace lockstone::net
