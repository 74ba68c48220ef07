// A client's end whose packets the program carries itself, as messages of a WebSocket that it has
// opened: in a browser, which lets nobody else open one. Bytes: docs/reference/wire-format.md,
// "WebSockets".
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/net/transport.h>

namespace lockstone::net {

/// One connection at a time. Of unreliable packets that wait to be taken the oldest give way.
class MessageTransport final : public Transport {
 public:
  /// More bytes that wait in either direction end the connection.
  static constexpr std::size_t k_max_waiting_bytes = 8 << 20;

  MessageTransport();
  ~MessageTransport() override;
  MessageTransport(const MessageTransport&) = delete;
  MessageTransport& operator=(const MessageTransport&) = delete;

  /// A new connection, whose number it returns. A former one ends without an event.
  ConnectionId open();

  /// Its WebSocket is open, with the subprotocol `lockstone`: `connected` follows as an event.
  void opened();

  /// A binary message has come. False: it breaks the format, or too much waits; the connection has
  /// ended, and the program closes its WebSocket.
  bool receive(ByteView message);

  /// The next message to send; empty when there is none. Valid until the next call.
  [[nodiscard]] ByteView next_message();
  /// It was sent.
  void take_message();

  /// The WebSocket was closed, with this code: `disconnected` follows as an event.
  void closed(unsigned code);

  /// False once the session, a limit or `closed` has ended the connection.
  [[nodiscard]] bool is_open() const;

  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override {}
  void disconnect(ConnectionId connection) override;
  /// The round trip is unknown: a page cannot ping.
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace lockstone::net
