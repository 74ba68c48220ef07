// The inside of SecureTransport: the packets of open connections. The handshake of each side is a
// class of its own.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <lockstone/net/transport_secure.h>

#include "net/security/secure_client_handshake.h"
#include "net/security/secure_data.h"
#include "net/security/secure_server_handshake.h"

namespace lockstone::net {

/// Opens the carrier's packets, or hands them to the handshake. Functions return whether there is
/// an event to tell.
struct SecureTransport::Impl {
  Impl(Transport& carrier, RandomSource& secrets, std::size_t max_connections);

  [[nodiscard]] bool translate(const TransportEvent& source, TransportEvent& event);
  [[nodiscard]] bool accept(ConnectionId connection, TransportEvent& event);
  [[nodiscard]] bool receive(SecureLink& link, const TransportEvent& source, TransportEvent& event);

  SecureData data;
  std::optional<SecureServerHandshake> server;  ///< this one or the other
  std::optional<SecureClientHandshake> client;
  std::vector<std::byte> sealed;  ///< a packet on its way out
  std::vector<std::byte> opened;  ///< the last event's bytes point into it
};

}  // namespace lockstone::net
