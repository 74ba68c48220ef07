#include "tools/lockstone/match/caller.h"

#include <fmt/format.h>

#include <lockstone/net/transport_websocket.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

Result<std::unique_ptr<net::Transport>> open_udp(const std::optional<net::ConnectToken>& token) {
  net::EnetOptions enet;
  if (token) {
    enet.link_key = token->link_key;
    enet.match_tag = net::make_match_tag(token->grant.match);
  }
  auto opened = net::EnetTransport::open(enet);
  if (!opened) return opened.status();
  return std::unique_ptr<net::Transport>(std::move(opened).value());
}

#if defined(LOCKSTONE_WITH_WEBSOCKETS)
Result<std::unique_ptr<net::Transport>> open_web() {
  auto opened = net::WebSocketTransport::open({});
  if (!opened) return opened.status();
  return std::unique_ptr<net::Transport>(std::move(opened).value());
}

Result<net::ConnectionId> connect_web(net::Transport& socket, const std::string& url) {
  return static_cast<net::WebSocketTransport&>(socket).connect(url);
}
#else
Result<std::unique_ptr<net::Transport>> open_web() {
  complain("this build has no WebSockets (LOCKSTONE_WITH_WEBSOCKETS is off)");
  return Status::incompatible;
}

Result<net::ConnectionId> connect_web(net::Transport&, const std::string&) {
  return Status::incompatible;
}
#endif

}  // namespace

std::unique_ptr<Caller> Caller::open(const Targets& targets,
                                     const std::optional<net::ConnectToken>& token) {
  auto caller = std::make_unique<Caller>();
  if (!caller->open_socket(targets.web(), token)) return nullptr;
  return caller;
}

bool Caller::open_socket(bool web, const std::optional<net::ConnectToken>& token) {
  web_ = web;
  auto opened = web ? open_web() : open_udp(token);
  if (!opened) {
    complain(fmt::format("no socket: {}", to_string(opened.status())));
    return false;
  }
  socket_ = std::move(opened).value();
  if (token) secure_ = std::move(net::SecureTransport::join(*socket_, *token, random_)).value();
  return true;
}

Result<net::ConnectionId> Caller::connect(const net::HostPort& target) {
  if (web_) return connect_web(*socket_, target.host);
  return static_cast<net::EnetTransport&>(*socket_).connect(target.host, target.port);
}

Result<net::ConnectionId> Caller::call_next(Targets& targets) {
  for (std::size_t tries = 1;; ++tries) {
    const Result<net::ConnectionId> connection = connect(targets.current());
    if (connection) connection_ = connection.value();
    if (connection || tries == targets.count()) return connection;
    targets.go_on();
  }
}

std::unique_ptr<Caller> call(Targets& targets, const std::optional<net::ConnectToken>& token) {
  auto caller = Caller::open(targets, token);
  if (caller == nullptr) return nullptr;
  const Result<net::ConnectionId> connection = caller->call_next(targets);
  if (connection) return caller;
  const net::HostPort& target = targets.current();
  complain(fmt::format("cannot call {}: {}", targets.web() ? target.host : target.to_text(),
                       to_string(connection.status())));
  return nullptr;
}

}  // namespace lockstone::tool
