// The inside of WebSocketTransport: libwebsockets' context, and the translation of its callbacks.
// Behaviour of libwebsockets relied upon: https://libwebsockets.org (4.1), lws-callbacks.h.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <libwebsockets.h>

#include <lockstone/net/transport_websocket.h>

#include "net/transport/websocket/incoming_events.h"
#include "net/transport/websocket/tcp_listener.h"
#include "net/transport/websocket/websocket_places.h"

namespace lockstone::net {

struct WebSocketNetwork {
  WebSocketNetwork(const WebSocketOptions& wanted, bool listening)
      : options(wanted), listens(listening), places(wanted, listening) {}
  ~WebSocketNetwork();
  WebSocketNetwork(const WebSocketNetwork&) = delete;
  WebSocketNetwork& operator=(const WebSocketNetwork&) = delete;

  // websocket_setup.cpp
  [[nodiscard]] static Result<std::unique_ptr<WebSocketNetwork>> listen(const WebSocketOptions& options,
                                                             std::string* problem);
  /// False when libwebsockets refuses: the certificate, mostly.
  [[nodiscard]] bool start(bool tls);
  [[nodiscard]] Result<ConnectionId> connect(const std::string& url);

  /// One round of the network: callers, bytes in both directions, time-outs.
  void serve();

  /// The session hears that the connection has ended; the peer is told the reason.
  void end(WebSocketPlace& place, RefuseReason reason);

  const WebSocketOptions options;
  const bool listens;
  WebSocketPlaces places;
  IncomingEvents events;
  WebSocketCounters counters;
  std::int64_t now_us = 0;
  bool anything_to_write = false;
  std::unique_ptr<TcpListener> listener;

 private:
  void admit_callers();
  void enforce_times();
  void enforce_times(WebSocketPlace& place);
  static void cut(WebSocketPlace& place);

  lws_context* context_ = nullptr;
  std::int64_t times_checked_us_ = 0;
};

/// libwebsockets calls it for every event of every socket.
int on_websocket(lws* socket, lws_callback_reasons reason, void* user, void* in, std::size_t size);

}  // namespace lockstone::net
