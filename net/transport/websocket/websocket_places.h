// The connections of a WebSocketTransport: a place for each, with the limits of its holder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <libwebsockets.h>

#include <lockstone/net/transport_websocket.h>

#include "net/transport/flood_watch.h"
#include "net/transport/udp/datagram_source.h"
#include "net/transport/websocket/outgoing_messages.h"

namespace lockstone::net {

enum class PlaceStage : std::uint8_t {
  free,
  door,     ///< TCP stands, the WebSocket's handshake does not yet
  open,     ///< the session knows it
  closing,  ///< ended by the session, or the session has heard: messages that wait are still sent
};

struct WebSocketPlace {
  lws* socket = nullptr;
  PlaceStage stage = PlaceStage::free;
  std::uint32_t generation = 1;
  bool trusted = false;
  RefuseReason ending = RefuseReason::none;  ///< told to the peer when it is closed
  std::int64_t since_us = 0;                 ///< of the stage
  std::int64_t heard_us = 0;                 ///< when bytes came last
  std::int64_t pinged_us = 0;
  DatagramSource remote;
  std::vector<std::byte> incoming;  ///< of a message that is not whole yet
  OutgoingMessages outgoing{LWS_PRE};
  FloodWatch messages;
  TransportStats stats;
};

/// Gives places to callers, a limited number to one address, and names them by ids that are not
/// used again. Allocates when made only.
class WebSocketPlaces {
 public:
  WebSocketPlaces(const WebSocketOptions& options, bool listens)
      : limits_(options.limits),
        listens_(listens),
        places_per_address_(options.max_connections_per_address),
        strangers_per_address_(options.max_strangers_per_address),
        places_(options.max_connections) {}

  [[nodiscard]] std::vector<WebSocketPlace>& all() { return places_; }
  [[nodiscard]] ConnectionId id_of(const WebSocketPlace& place) const;

  /// The open connection of an id, or null.
  [[nodiscard]] WebSocketPlace* find(ConnectionId connection);

  /// The one that has this socket, or null.
  [[nodiscard]] static WebSocketPlace* find(const lws* socket);

  /// Whether the address of a caller has as many places as it may have.
  [[nodiscard]] bool is_crowded(const DatagramSource& source) const;

  /// A place at the door, or null: all are taken.
  [[nodiscard]] WebSocketPlace* take(const DatagramSource& source, std::int64_t now_us);

  void release(WebSocketPlace& place);

  /// A member of the match has other limits than a stranger.
  void trust(WebSocketPlace& place) const;

 private:
  DatagramLimits limits_;
  bool listens_;
  std::size_t places_per_address_;
  std::size_t strangers_per_address_;
  std::vector<WebSocketPlace> places_;  ///< never resized
};

}  // namespace lockstone::net
