// Several transports as one: a server takes players over UDP and over WebSockets in one match.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/net/transport.h>

namespace lockstone::net {

/// Driven like the transports that it joins, which it must not outlive and nobody else may poll.
/// The order of its events says nothing about the session, which orders everything by slot.
class JoinedTransport final : public Transport {
 public:
  /// The part's number stands in the highest bits of a connection's.
  static constexpr std::size_t k_most = std::size_t{1} << (32 - k_connection_bits);

  /// One to four transports whose connections have numbers of k_connection_bits.
  explicit JoinedTransport(std::vector<Transport*> parts);

  /// Takes events of one part after the other, so that none keeps the others waiting.
  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override;
  void disconnect(ConnectionId connection) override;
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;
  /// True if all parts are.
  [[nodiscard]] bool secure() const override;
  [[nodiscard]] PeerIdentity identity(ConnectionId connection) const override;
  void trust(ConnectionId connection) override;
  void protect(ConnectionId connection, const DatagramKeys& keys, bool peer_has_them) override;

 private:
  [[nodiscard]] Transport* part_of(ConnectionId connection) const;

  std::vector<Transport*> parts_;
  std::size_t next_ = 0;
};

}  // namespace lockstone::net
