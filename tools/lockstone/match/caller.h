// The client's end of a connection, over UDP or over a WebSocket.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <lockstone/net/token.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_secure.h>

namespace lockstone::tool {

/// Where the server may be: the addresses of its name, or of the token's servers. An address of a
/// WebSocket, like ws://127.0.0.1:9000/, stands in the host of one without a port.
class Targets {
 public:
  explicit Targets(std::vector<net::HostPort> list) : list_(std::move(list)) {}

  [[nodiscard]] std::size_t count() const { return list_.size(); }
  [[nodiscard]] const net::HostPort& current() const { return list_[at_]; }
  [[nodiscard]] bool web() const { return list_.front().port == 0; }
  void go_on() { at_ = (at_ + 1) % list_.size(); }

 private:
  std::vector<net::HostPort> list_;
  std::size_t at_ = 0;
};

/// A connection on its way, encrypted if there is a token.
class Caller {
 public:
  /// Null, with a complaint, when the system refuses.
  [[nodiscard]] static std::unique_ptr<Caller> open(
      const Targets& targets, const std::optional<net::ConnectToken>& token);

  /// Goes on from targets that the system cannot call, such as IPv6 where it has none.
  [[nodiscard]] Result<net::ConnectionId> call_next(Targets& targets);

  [[nodiscard]] net::Transport* transport() const {
    return secure_ != nullptr ? secure_.get() : socket_.get();
  }
  /// Of the last call.
  [[nodiscard]] net::ConnectionId connection() const { return connection_; }

 private:
  [[nodiscard]] bool open_socket(bool web, const std::optional<net::ConnectToken>& token);
  [[nodiscard]] Result<net::ConnectionId> connect(const net::HostPort& target);

  net::SystemRandom random_;
  bool web_ = false;
  std::unique_ptr<net::Transport> socket_;
  std::unique_ptr<net::Transport> secure_;
  net::ConnectionId connection_ = net::k_no_connection;
};

/// Opens it and calls the first target. Null, with a complaint, when the system refuses.
[[nodiscard]] std::unique_ptr<Caller> call(Targets& targets,
                                           const std::optional<net::ConnectToken>& token);

}  // namespace lockstone::tool
