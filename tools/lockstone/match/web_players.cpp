#include "tools/lockstone/match/web_players.h"

namespace lockstone::tool {

std::optional<net::WebSocketOptions> WebPlayers::options(const net::EnetOptions& like) const {
  if (!port) return std::nullopt;
  net::WebSocketOptions wanted;
  wanted.bind_address = like.bind_address;
  wanted.port = *port;
  wanted.max_connections = like.max_connections;
  wanted.max_connections_per_address = like.max_connections_per_address;
  wanted.max_strangers_per_address = like.max_strangers_per_address;
  wanted.limits = like.limits;
  wanted.origins = origins;
  wanted.certificate_file = certificate_file;
  wanted.key_file = key_file;
  return wanted;
}

}  // namespace lockstone::tool
