// Where a datagram comes from, over IPv4 or IPv6.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "net/security/ipv6_text.h"

namespace lockstone::net {

struct DatagramSource {
  Ipv6Bytes address{};      ///< an IPv4 address is mapped into ::ffff:0:0/96
  std::uint32_t scope = 0;  ///< of a link-local address: the number of the interface
  std::uint16_t port = 0;
  /// The address of ours that it was sent to, from which answers go; zeros: the system chooses. A
  /// host has several IPv6 addresses as a rule, and a peer that called one drops datagrams from
  /// another.
  Ipv6Bytes called{};
  friend bool operator==(const DatagramSource&, const DatagramSource&) = default;

  [[nodiscard]] bool is_ipv4() const { return is_mapped_ipv4(address); }
};

/// Whether limits by address count both as one: equal IPv4 addresses, or IPv6 addresses of one /64,
/// the least that a network gives to a host (RFC 7421), all of which it may send from.
[[nodiscard]] inline bool from_one_site(const DatagramSource& a, const DatagramSource& b) {
  constexpr std::ptrdiff_t k_prefix_bytes = 8;
  if (a.is_ipv4() || b.is_ipv4()) return a.address == b.address;
  return a.scope == b.scope &&
         std::equal(a.address.begin(), a.address.begin() + k_prefix_bytes, b.address.begin());
}

/// Equal for sources of one site; those of other sites may share a number, but seldom do.
[[nodiscard]] inline std::uint64_t site_number(const DatagramSource& source) {
  const std::size_t begin = source.is_ipv4() ? 8 : 0;
  std::uint64_t number = 0;
  for (std::size_t i = 0; i < 8; ++i)
    number = (number << 8) | std::to_integer<std::uint64_t>(source.address[begin + i]);
  return source.is_ipv4() ? number : number ^ source.scope;
}

}  // namespace lockstone::net
