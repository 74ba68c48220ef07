#include "tools/lockstone/match/servers.h"

#include <fmt/format.h>

#include <lockstone/net/transport_enet.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

bool add_server(const net::HostPort& server, net::ServerList& servers) {
  const std::string text = server.to_text();
  const Result<net::ServerAddress> address = net::ServerAddress::from_text(text);
  if (!address) {
    complain(fmt::format("{} is valid on one line only: no address for a token", text));
    return false;
  }
  if (servers.contains(address.value()) || servers.add(address.value())) return true;
  complain(fmt::format("{}: a token names at most {} servers", text, net::k_max_token_servers));
  return false;
}

}  // namespace

std::vector<net::HostPort> look_up(const net::HostPort& server) {
  std::vector<net::HostPort> found;
  for (std::string& address : net::resolve_host(server.host))
    found.push_back({std::move(address), server.port});
  if (found.empty()) complain(fmt::format("{}: no host is known by this name", server.host));
  return found;
}

bool add_servers(const std::vector<std::string>& texts, net::ServerList& servers) {
  for (const std::string& text : texts) {
    const Result<net::HostPort> server = net::HostPort::from_text(text);
    if (!server) {
      complain(
          fmt::format("{} is no server like 1.2.3.4:7777, [::1]:7777 or localhost:7777", text));
      return false;
    }
    const std::vector<net::HostPort> found = look_up(server.value());
    if (found.empty()) return false;
    for (const net::HostPort& each : found) {
      if (!add_server(each, servers)) return false;
    }
  }
  return true;
}

}  // namespace lockstone::tool
