// For tests over ::1.
#pragma once

#include <memory>

#include <gtest/gtest.h>

#include "net/transport/udp/udp6_socket.h"

namespace lockstone::net::test {

inline DatagramSource loopback6(std::uint16_t port) {
  return *read_ipv6("::1", port);
}

/// A socket at ::1; null where the machine has no IPv6.
inline std::unique_ptr<Udp6Socket> open_loopback6() {
  const DatagramSource local = loopback6(0);
  return Udp6Socket::open(&local);
}

}  // namespace lockstone::net::test

#define LKS_NEEDS_IPV6()                                 \
  if (lockstone::net::test::open_loopback6() == nullptr) \
  GTEST_SKIP() << "no address ::1: this machine has no IPv6"
