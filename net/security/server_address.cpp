#include <algorithm>
#include <charconv>

#include <lockstone/net/token.h>

#include "net/security/ipv6_text.h"

namespace lockstone::net {
namespace {

// 1 … 65535 in decimal digits, without zeros in front; 0: another text.
std::uint16_t port_from_text(std::string_view text) {
  std::uint16_t port = 0;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, port);
  const bool whole = error == std::errc() && stop == end && text[0] != '0';
  return whole ? port : std::uint16_t{0};
}

}  // namespace

Result<HostPort> HostPort::from_text(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return Status::malformed;
  std::string_view host = text.substr(0, colon);
  const std::uint16_t port = port_from_text(text.substr(colon + 1));
  const bool bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (bracketed) host = host.substr(1, host.size() - 2);
  // Only a host with a colon may stand in brackets.
  const bool has_colon = host.find(':') != std::string_view::npos;
  if (host.empty() || port == 0 || has_colon != bracketed) return Status::malformed;
  if (host.find_first_of("[] \t") != std::string_view::npos) return Status::malformed;
  return HostPort{std::string(host), port};
}

std::string HostPort::to_text() const {
  const bool bracketed = host.find(':') != std::string::npos;
  return (bracketed ? "[" + host + "]:" : host + ":") + std::to_string(port);
}

Result<ServerAddress> ServerAddress::from_text(std::string_view text) {
  const Result<HostPort> parts = HostPort::from_text(text);
  if (!parts) return parts.status();
  ServerAddress result;
  result.port = parts.value().port;
  if (const auto ipv4 = ipv4_from_text(parts.value().host)) {
    result.address = map_ipv4(*ipv4);
    return result;
  }
  const auto ipv6 = ipv6_from_text(parts.value().host);
  if (!ipv6) return Status::malformed;
  result.address = *ipv6;
  return result;
}

HostPort ServerAddress::to_host_port() const {
  if (!is_mapped_ipv4(address)) return {ipv6_to_text(address), port};
  HostPort result{{}, port};
  for (std::size_t i = address.size() - 4; i < address.size(); ++i) {
    if (!result.host.empty()) result.host += '.';
    result.host += std::to_string(std::to_integer<unsigned>(address[i]));
  }
  return result;
}

std::string ServerAddress::to_text() const {
  return to_host_port().to_text();
}

bool ServerList::add(const ServerAddress& address) {
  if (count >= entries.size()) return false;
  entries[count++] = address;
  return true;
}

bool ServerList::contains(const ServerAddress& address) const {
  return std::find(entries.begin(), entries.begin() + count, address) != entries.begin() + count;
}

}  // namespace lockstone::net
