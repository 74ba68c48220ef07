// Encryption around any other transport: tokens prove who connects, packets are sealed, replays are
// dropped. A session above it sees plain payloads and identities.
//
// Needs libsodium (security_available). No clock and no randomness of its own. Nothing is allocated
// after creation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include <lockstone/net/keys.h>
#include <lockstone/net/open_matches.h>
#include <lockstone/net/token.h>
#include <lockstone/net/transport.h>

namespace lockstone::net {

struct SecureServerOptions {
  Key backend_key;          ///< seals the tokens
  std::uint64_t match = 0;  ///< tokens of other matches are refused
  /// Instead of `match`: tokens of all these are good. Must outlive the transport. Null: `match`.
  const OpenMatches* matches = nullptr;
  ServerList own_addresses;  ///< one of them must be in a token that lists servers; none: no check
  std::int64_t unix_us_at_zero = 0;       ///< the wall clock when the transport's time was 0
  std::size_t max_connections = 32;       ///< further ones are disconnected at once; 1 … 4095
  std::int64_t handshake_us = 5'000'000;  ///< for the token and its proof
};

/// Counters of rejected traffic, since creation.
struct SecurityCounters {
  std::uint64_t handshakes_completed = 0;
  std::uint64_t handshakes_refused = 0;  ///< a token or a proof was not good
  std::uint64_t handshakes_timed_out = 0;
  std::uint64_t handshakes_replaced = 0;  ///< the same token was shown again before its proof
  std::uint64_t handshakes_limited = 0;   ///< one player came in too often
  std::uint64_t packets_forged = 0;       ///< not sealed under the connection's key, or altered
  std::uint64_t packets_replayed = 0;     ///< seen before, or too old to know
};

/// Driven like the transport that it wraps, which it must not outlive and nobody else may poll. A
/// connection keeps the number that the wrapped transport gave it.
class SecureTransport final : public Transport {
 public:
  /// For a server. invalid_argument: a limit is out of range; incompatible: no libsodium.
  [[nodiscard]] static Result<std::unique_ptr<SecureTransport>> serve(
      Transport& carrier, const SecureServerOptions& options, RandomSource& random);

  /// For a client: every connection of the carrier shows this token.
  [[nodiscard]] static Result<std::unique_ptr<SecureTransport>> join(Transport& carrier,
                                                                     const ConnectToken& token,
                                                                     RandomSource& random);

  ~SecureTransport() override;
  SecureTransport(const SecureTransport&) = delete;
  SecureTransport& operator=(const SecureTransport&) = delete;

  /// `connected` comes once the peer has proven itself. A `disconnected` of a client that never was
  /// connected carries the server's reason.
  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override;
  void disconnect(ConnectionId connection) override;
  /// Of the wrapped transport: sealed bytes.
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;
  [[nodiscard]] bool secure() const override { return true; }
  [[nodiscard]] PeerIdentity identity(ConnectionId connection) const override;
  void trust(ConnectionId connection) override;

  [[nodiscard]] const SecurityCounters& counters() const;

 private:
  struct Impl;
  explicit SecureTransport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::net
