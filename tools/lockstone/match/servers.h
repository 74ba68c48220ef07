// Servers by name or address, as options give them.
#pragma once

#include <string>
#include <vector>

#include <lockstone/net/token.h>

namespace lockstone::tool {

/// All addresses of a host, numeric, with its port. Empty, with a complaint, when there are none.
[[nodiscard]] std::vector<net::HostPort> look_up(const net::HostPort& server);

/// Adds all addresses of servers like `1.2.3.4:7777`, `[2001:db8::1]:7777` or `game.example:7777`.
/// False, with a complaint, for another text, an unknown name, or when there is no more room.
[[nodiscard]] bool add_servers(const std::vector<std::string>& texts, net::ServerList& servers);

}  // namespace lockstone::tool
