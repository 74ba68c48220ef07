// Keys, tokens and transports for tests of encrypted sessions.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <lockstone/net/token.h>
#include <lockstone/net/transport_secure.h>

#include "net/transport/random.h"

namespace lockstone::net::test {

/// The same bytes for the same seed.
class TestRandom final : public RandomSource {
 public:
  explicit TestRandom(std::uint64_t seed) : random_(seed) {}
  void fill(std::span<std::byte> out) override {
    for (std::byte& byte : out)
      byte = static_cast<std::byte>(random_.below(256));
  }

 private:
  Random random_;
};

inline constexpr std::uint64_t k_match = 0x1234;
inline constexpr std::int64_t k_unix_s = 1'800'000'000;  ///< when the simulated time is 0

/// The key of the backend of all tests.
[[nodiscard]] Key backend_key();

/// Of player 100 + slot, for an hour.
[[nodiscard]] TokenGrant grant_for(std::size_t slot);

[[nodiscard]] ConnectToken token_for(std::size_t slot, RandomSource& random);

[[nodiscard]] SecureServerOptions server_options();

[[nodiscard]] std::unique_ptr<SecureTransport> serve_securely(Transport& carrier,
                                                              RandomSource& random);
[[nodiscard]] std::unique_ptr<SecureTransport> join_securely(Transport& carrier, std::size_t slot,
                                                             RandomSource& random);

/// Passes everything on and keeps copies of sent packets.
class TapTransport final : public Transport {
 public:
  struct Sent {
    ConnectionId connection;
    Channel channel;
    std::vector<std::byte> bytes;
  };

  explicit TapTransport(Transport& carrier) : carrier_(carrier) {}
  bool poll(std::int64_t now_us, TransportEvent& event) override {
    return carrier_.poll(now_us, event);
  }
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override {
    sent.push_back({connection, channel, {bytes.begin(), bytes.end()}});
    return carrier_.send(connection, channel, bytes);
  }
  void flush() override { carrier_.flush(); }
  void disconnect(ConnectionId connection) override { carrier_.disconnect(connection); }
  void protect(ConnectionId connection, const DatagramKeys& keys, bool peer_has_them) override {
    carrier_.protect(connection, keys, peer_has_them);
  }
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override {
    return carrier_.stats(connection);
  }

  std::vector<Sent> sent;

 private:
  Transport& carrier_;
};

}  // namespace lockstone::net::test
