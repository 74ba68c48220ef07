// Stands in for a real carrier's keyed checksum: packets that were altered or forged on the way are
// dropped before a session sees them.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/net/transport.h>

namespace lockstone::simnet {

/// Both ends share the key. The tag has 64 bits and costs 8 bytes a packet.
class SealedTransport final : public net::Transport {
 public:
  SealedTransport(net::Transport& carrier, std::uint64_t key) : carrier_(carrier), key_(key) {}

  bool poll(std::int64_t now_us, net::TransportEvent& event) override;
  Status send(net::ConnectionId connection, net::Channel channel, ByteView bytes) override;
  void flush() override { carrier_.flush(); }
  void disconnect(net::ConnectionId connection) override { carrier_.disconnect(connection); }
  [[nodiscard]] net::TransportStats stats(net::ConnectionId connection) const override {
    return carrier_.stats(connection);
  }

  /// Packets that were dropped for their tag.
  [[nodiscard]] std::uint64_t refused() const { return refused_; }

 private:
  net::Transport& carrier_;
  std::uint64_t key_;
  std::uint64_t refused_ = 0;
  std::vector<std::byte> out_;
};

}  // namespace lockstone::simnet
