// The sockets of a hosted match, or of many: UDP, and WebSockets if they are asked for. With their
// encryption.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <lockstone/net/open_matches.h>
#include <lockstone/net/token.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_joined.h>
#include <lockstone/net/transport_secure.h>
#include <lockstone/net/transport_websocket.h>

namespace lockstone::tool {

struct SocketOptions {
  net::EnetOptions enet;         ///< without keys
  std::optional<net::WebSocketOptions> web = {};  ///< none: UDP only
  std::optional<net::Key> key;   ///< seals the tokens; none: insecure
  std::uint64_t match = 0;       ///< of the tokens
  net::ServerList addresses;     ///< of this server that tokens may name; none: no check
  std::int64_t unix_us_at_zero;  ///< the wall clock when the transport's time was 0
  const net::OpenMatches* matches = nullptr;  ///< instead of `match`
};

class MatchSocket {
 public:
  /// Null, with a complaint, when the system refuses.
  [[nodiscard]] static std::unique_ptr<MatchSocket> open(const SocketOptions& options);

  [[nodiscard]] std::uint16_t port() const { return socket_->port(); }
  /// Where browsers call, as text; empty: nowhere.
  [[nodiscard]] const std::string& web_address() const { return web_address_; }
  [[nodiscard]] net::Transport& session();
  [[nodiscard]] const net::EnetCounters& socket_counters() const { return socket_->counters(); }
  [[nodiscard]] net::WebSocketCounters web_counters() const;
  [[nodiscard]] net::SecurityCounters security_counters() const;

 private:
  MatchSocket() = default;
  [[nodiscard]] bool open_web(const net::WebSocketOptions& options);
  [[nodiscard]] bool encrypt(const SocketOptions& options);
  [[nodiscard]] net::Transport& carrier();

  net::SystemRandom random_;
  std::unique_ptr<net::EnetTransport> socket_;
  std::unique_ptr<net::Transport> web_;           ///< null: UDP only
  std::optional<net::JoinedTransport> joined_;    ///< of both
  std::string web_address_;
  std::unique_ptr<net::SecureTransport> secure_;  ///< null: insecure
};

}  // namespace lockstone::tool
