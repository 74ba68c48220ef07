#include <algorithm>
#include <array>
#include <memory>

#include <lockstone/net/transport_enet.h>

#include "net/transport/udp/system_sockets.h"
#include "net/transport/udp/udp6_socket.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_longest_address = 128;  // with a zone

std::string numeric_text(const addrinfo& found) {
  std::array<char, k_longest_address> text{};
  const auto size = static_cast<socklen_t>(found.ai_addrlen);
  const int error = getnameinfo(found.ai_addr, size, text.data(),
                                static_cast<socklen_t>(text.size()), nullptr, 0, NI_NUMERICHOST);
  return error == 0 ? std::string(text.data()) : std::string();
}

}  // namespace

std::vector<std::string> resolve_host(const std::string& host) {
  const SocketLibrary library;
  addrinfo hints{};
  hints.ai_family = AF_UNSPEC;
  hints.ai_socktype = SOCK_DGRAM;
  addrinfo* found = nullptr;
  if (host.empty() || getaddrinfo(host.c_str(), nullptr, &hints, &found) != 0) return {};
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  std::vector<std::string> addresses;
  for (const addrinfo* each = found; each != nullptr; each = each->ai_next) {
    std::string text = numeric_text(*each);
    const bool known = std::find(addresses.begin(), addresses.end(), text) != addresses.end();
    if (!text.empty() && !known) addresses.push_back(std::move(text));
  }
  return addresses;
}

}  // namespace lockstone::net
