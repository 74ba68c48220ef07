#include "tools/lockstone/match/match_socket.h"

#include <algorithm>

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
  if (options.web && !made->open_web(*options.web)) return nullptr;
  if (options.key && !made->encrypt(options)) return nullptr;
  return made;
}

#if defined(LOCKSTONE_WITH_WEBSOCKETS)
bool MatchSocket::open_web(const net::WebSocketOptions& options) {
  std::string problem;
  auto listening = net::WebSocketTransport::listen(options, &problem);
  if (!listening) {
    complain("cannot listen for browsers on " + problem);
    return false;
  }
  const net::HostPort where{options.bind_address, listening.value()->port()};
  const bool tls = !options.certificate_file.empty();
  web_address_ = fmt::format("{}://{}/", tls ? "wss" : "ws", where.to_text());
  web_ = std::move(listening).value();
  joined_.emplace(std::vector<net::Transport*>{socket_.get(), web_.get()});
  return true;
}

net::WebSocketCounters MatchSocket::web_counters() const {
  if (web_ == nullptr) return {};
  return static_cast<const net::WebSocketTransport&>(*web_).counters();
}
#else
bool MatchSocket::open_web(const net::WebSocketOptions&) {
  complain("this build has no WebSockets (LOCKSTONE_WITH_WEBSOCKETS is off)");
  return false;
}

net::WebSocketCounters MatchSocket::web_counters() const {
  return {};
}
#endif

net::Transport& MatchSocket::carrier() {
  if (joined_) return *joined_;
  return *socket_;
}

bool MatchSocket::encrypt(const SocketOptions& options) {
  net::SecureServerOptions security;
  security.backend_key = *options.key;
  security.match = options.match;
  security.matches = options.matches;
  security.max_connections =
      std::min(options.enet.max_connections + (options.web ? options.web->max_connections : 0),
               net::k_max_socket_connections);
  security.own_addresses = options.addresses;
  security.unix_us_at_zero = options.unix_us_at_zero;
  auto created = net::SecureTransport::serve(carrier(), security, random_);
  if (!created) {
    complain(fmt::format("no encryption: {}", to_string(created.status())));
    return false;
  }
  secure_ = std::move(created).value();
  return true;
}

net::Transport& MatchSocket::session() {
  if (secure_ != nullptr) return *secure_;
  return carrier();
}

net::SecurityCounters MatchSocket::security_counters() const {
  return secure_ != nullptr ? secure_->counters() : net::SecurityCounters{};
}

}  // namespace lockstone::tool
