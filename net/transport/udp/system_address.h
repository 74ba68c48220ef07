// The system's IPv6 addresses as sources.
#pragma once

#include <cstring>

#include "net/transport/udp/datagram_source.h"
#include "net/transport/udp/system_sockets.h"

namespace lockstone::net {

/// `called` is left zero.
[[nodiscard]] inline DatagramSource from_system(const sockaddr_in6& address) {
  DatagramSource source;
  std::memcpy(source.address.data(), &address.sin6_addr, source.address.size());
  source.scope = address.sin6_scope_id;
  source.port = ntohs(address.sin6_port);
  return source;
}

}  // namespace lockstone::net
