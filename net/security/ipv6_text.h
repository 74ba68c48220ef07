// IPv6 addresses as text, without a system's help: RFC 4291, section 2.2; written as in RFC 5952.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace lockstone::net {

using Ipv6Bytes = std::array<std::byte, 16>;  ///< in network order

/// Four decimal numbers of at most 255 with dots between them. Nothing: another text.
[[nodiscard]] std::optional<std::array<std::byte, 4>> ipv4_from_text(std::string_view text);
/// Nothing: another text, such as one with a zone behind `%`.
[[nodiscard]] std::optional<Ipv6Bytes> ipv6_from_text(std::string_view text);

/// Lower case, the longest run of zeros as `::`.
[[nodiscard]] std::string ipv6_to_text(const Ipv6Bytes& address);

/// An IPv4 address in ::ffff:0:0/96.
[[nodiscard]] bool is_mapped_ipv4(const Ipv6Bytes& address);
[[nodiscard]] Ipv6Bytes map_ipv4(const std::array<std::byte, 4>& address);

}  // namespace lockstone::net
