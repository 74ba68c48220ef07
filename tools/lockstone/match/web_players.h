// The options of a hosted match for players in browsers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_websocket.h>

namespace CLI {
class App;
}

namespace lockstone::tool {

struct WebPlayers {
  std::optional<std::uint16_t> port;  ///< none: there are none; 0: the system chooses
  std::string certificate_file;
  std::string key_file;
  std::vector<std::string> origins;

  /// For a socket with so many connections, for each address.
  [[nodiscard]] std::optional<net::WebSocketOptions> options(const net::EnetOptions& like) const;
};

void add_web_options(CLI::App& command, WebPlayers& web);

/// Not k_ok, with a complaint: a certificate goes with its key, and both with browsers.
[[nodiscard]] int check_web(const WebPlayers& web);

}  // namespace lockstone::tool
