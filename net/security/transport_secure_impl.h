// The inside of SecureTransport: transport_secure.cpp handles the packets of open connections,
// secure_handshake.cpp the handshake.
#pragma once

#include <optional>
#include <vector>

#include <lockstone/net/transport_secure.h>

#include "net/security/entry_limits.h"
#include "net/security/packet_seal.h"

namespace lockstone::net {

struct SecureTransport::Impl {
  enum class Stage : std::uint8_t {
    unused,
    greeting,  ///< server: waits for hello; client: waits for challenge
    proving,   ///< server: waits for confirm
    open,
  };

  struct Link {
    ConnectionId connection = k_no_connection;
    Stage stage = Stage::unused;
    std::int64_t since_us = 0;
    PeerIdentity identity;
    PacketSealer sealer;
    PacketOpener opener;
    Key secret;                                    ///< client: of the key agreement
    std::array<std::byte, k_hello_bytes> hello{};  ///< client: as sent
  };

  Impl(Transport& wrapped, RandomSource& random_source, std::size_t max_connections);

  // transport_secure.cpp
  [[nodiscard]] bool translate(const TransportEvent& source, TransportEvent& event);
  [[nodiscard]] bool receive(Link& link, const TransportEvent& source, TransportEvent& event);
  [[nodiscard]] bool expire(TransportEvent& event);
  [[nodiscard]] bool close(Link& link, RefuseReason reason, TransportEvent& event);
  void release(Link& link);
  [[nodiscard]] Link* find(ConnectionId connection);

  // secure_handshake.cpp: each returns whether there is an event to tell.
  [[nodiscard]] bool accept(ConnectionId connection, TransportEvent& event);
  [[nodiscard]] bool greet(Link& link, TransportEvent& event);
  [[nodiscard]] bool on_hello(Link& link, ByteView packet, TransportEvent& event);
  [[nodiscard]] RefuseReason judge(const SecureHello& hello, SealedGrant& grant) const;
  [[nodiscard]] bool challenge(Link& link, const SecureHello& hello, const SealedGrant& grant,
                               ByteView packet, TransportEvent& event);
  void end_older_handshake(const SealedGrant& grant);
  [[nodiscard]] bool on_confirm(Link& link, ByteView packet, TransportEvent& event);
  [[nodiscard]] bool on_challenge(Link& link, ByteView packet, TransportEvent& event);
  [[nodiscard]] bool open(Link& link, TransportEvent& event);
  [[nodiscard]] bool refuse(Link& link, RefuseReason reason, TransportEvent& event);
  [[nodiscard]] bool send_plain(const Link& link, ByteView bytes);

  Transport& carrier;
  RandomSource& secrets;
  std::optional<SecureServerOptions> server;  ///< or else a client's `token`
  ConnectToken token;
  std::int64_t now_us = 0;
  std::vector<Link> links;                ///< never resized
  EntryLimits entries;                    ///< of a server
  std::optional<TransportEvent> pending;  ///< to be told before anything else
  SecurityCounters counters;
  std::vector<std::byte> sealed;  ///< a packet on its way out
  std::vector<std::byte> opened;  ///< the last event's bytes point into it
};

}  // namespace lockstone::net
