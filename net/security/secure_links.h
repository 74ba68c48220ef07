// The connections of a SecureTransport, in the handshake or open.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/net/transport.h>

#include "net/security/packet_seal.h"

namespace lockstone::net {

enum class SecureStage : std::uint8_t {
  unused,
  greeting,  ///< server: waits for hello; client: waits for challenge
  proving,   ///< server: waits for confirm
  open,
};

struct SecureLink {
  ConnectionId connection = k_no_connection;
  SecureStage stage = SecureStage::unused;
  std::int64_t since_us = 0;
  PeerIdentity identity;
  PacketSealer sealer;
  PacketOpener opener;
  Key secret;                                    ///< client: of the key agreement
  std::array<std::byte, k_hello_bytes> hello{};  ///< client: as sent
};

/// Gives each connection a place, and wipes its keys when it ends. Functions that take an event
/// return whether it is to be told. Allocates when made only.
class SecureLinks {
 public:
  SecureLinks(Transport& carrier, std::size_t capacity)
      : carrier_(carrier), ids_(capacity, k_no_connection), links_(capacity) {}
  ~SecureLinks();
  SecureLinks(const SecureLinks&) = delete;
  SecureLinks& operator=(const SecureLinks&) = delete;

  [[nodiscard]] std::vector<SecureLink>& all() { return links_; }
  [[nodiscard]] SecureLink* find(ConnectionId connection);

  /// A place for a new connection; null: all are in use.
  SecureLink* add(ConnectionId connection, std::int64_t now_us);

  /// Forgets a connection and wipes its keys.
  void release(SecureLink& link);

  /// Ends a connection from this side.
  [[nodiscard]] bool close(SecureLink& link, RefuseReason reason, TransportEvent& event);

  /// The handshake is over.
  [[nodiscard]] static bool open(SecureLink& link, TransportEvent& event);

  /// Sends a message of the handshake.
  [[nodiscard]] bool send_plain(const SecureLink& link, ByteView bytes);

 private:
  Transport& carrier_;
  std::vector<ConnectionId> ids_;  ///< of the links, close together: every packet is looked up
  std::vector<SecureLink> links_;  ///< never resized
};

}  // namespace lockstone::net
