// The client's connection to its server.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/net/transport.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

/// Encodes and sends messages to the server. Allocates when made only.
class ServerConnection {
 public:
  ServerConnection(Transport& transport, ConnectionId connection)
      : transport_(&transport), connection_(connection), message_(k_max_message_bytes) {}

  [[nodiscard]] ConnectionId id() const { return connection_; }

  /// A new connection instead of one that was lost.
  void replace(ConnectionId connection) { connection_ = connection; }

  template <class Message>
  Status try_send(const Message& message, Channel channel = Channel::reliable) {
    const std::size_t size = encode(message, message_);
    return transport_->send(connection_, channel, ByteView(message_).first(size));
  }

  /// A full queue shows as silence, and silence as a time-out.
  template <class Message>
  void send(const Message& message, Channel channel = Channel::reliable) {
    static_cast<void>(try_send(message, channel));
  }

  void disconnect() { transport_->disconnect(connection_); }
  void flush() { transport_->flush(); }
  [[nodiscard]] TransportStats stats() const { return transport_->stats(connection_); }

 private:
  Transport* transport_;
  ConnectionId connection_;
  std::vector<std::byte> message_;  ///< the message being encoded
};

}  // namespace lockstone::net
