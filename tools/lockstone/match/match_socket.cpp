#include "tools/lockstone/match/match_socket.h"

#include <fmt/format.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {

std::unique_ptr<MatchSocket> MatchSocket::open(const SocketOptions& options) {
  net::EnetOptions enet = options.enet;
  if (options.matches != nullptr) {
    enet.matches = options.matches;
  } else if (options.key) {
    enet.link_key = net::make_link_key(*options.key, options.match);
    enet.match_tag = net::make_match_tag(options.match);
  }
  std::string problem;
  auto listening = net::EnetTransport::listen(enet, &problem);
  if (!listening) {
    complain("cannot listen on " + problem);
    return nullptr;
  }
  std::unique_ptr<MatchSocket> made(new MatchSocket);
  made->socket_ = std::move(listening).value();
  if (options.key && !made->encrypt(options)) return nullptr;
  return made;
}

bool MatchSocket::encrypt(const SocketOptions& options) {
  net::SecureServerOptions security;
  security.backend_key = *options.key;
  security.match = options.match;
  security.matches = options.matches;
  security.max_connections = options.enet.max_connections;
  security.own_addresses = options.addresses;
  security.unix_us_at_zero = options.unix_us_at_zero;
  auto created = net::SecureTransport::serve(*socket_, security, random_);
  if (!created) {
    complain(fmt::format("no encryption: {}", to_string(created.status())));
    return false;
  }
  secure_ = std::move(created).value();
  return true;
}

net::Transport& MatchSocket::session() {
  if (secure_ != nullptr) return *secure_;
  return *socket_;
}

net::SecurityCounters MatchSocket::security_counters() const {
  return secure_ != nullptr ? secure_->counters() : net::SecurityCounters{};
}

}  // namespace lockstone::tool
