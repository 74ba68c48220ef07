// Players of many matches on one thread, with real sockets and tokens, and simulations that cost
// nothing.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <vector>

#include <lockstone/net/client.h>
#include <lockstone/net/token.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_secure.h>

#include "tools/lockstone/bench/hosting/echo_simulation.h"

namespace lockstone::tool {

/// One connection of a socket as a transport of its own.
class BotLine final : public net::Transport {
 public:
  BotLine(net::EnetTransport& socket, net::ConnectionId connection)
      : socket_(socket), connection_(connection) {}

  [[nodiscard]] net::ConnectionId connection() const { return connection_; }
  void push(const net::TransportEvent& event);

  bool poll(std::int64_t now_us, net::TransportEvent& event) override;
  Status send(net::ConnectionId connection, net::Channel channel, ByteView bytes) override {
    return socket_.send(connection, channel, bytes);
  }
  void flush() override {}  // the owner of the socket does
  void disconnect(net::ConnectionId connection) override { socket_.disconnect(connection); }
  [[nodiscard]] net::TransportStats stats(net::ConnectionId connection) const override {
    return socket_.stats(connection);
  }
  void protect(net::ConnectionId connection, const net::DatagramKeys& keys,
               bool peer_has_them) override {
    socket_.protect(connection, keys, peer_has_them);
  }

 private:
  struct Waiting {
    net::TransportEvent event;
    std::vector<std::byte> bytes;
  };
  net::EnetTransport& socket_;
  net::ConnectionId connection_;
  std::deque<Waiting> waiting_;
  Waiting current_;
};

/// Keys that are held for some ticks.
class BotInputs final : public net::InputSource {
 public:
  explicit BotInputs(std::uint64_t seed) : seed_(seed) {}
  void sample(std::uint64_t tick, std::span<std::byte> out) override;

 private:
  std::uint64_t seed_;
};

/// The players of one match: they share a socket, since they share the match's link key.
class BotTeam {
 public:
  /// Null when the system refuses.
  [[nodiscard]] static std::unique_ptr<BotTeam> call(std::uint16_t port, const net::Key& key,
                                                     std::uint64_t match, unsigned bots,
                                                     const HashBoards& boards);
  void update(std::int64_t now_us);

 private:
  struct Bot {
    std::unique_ptr<BotLine> line;
    std::unique_ptr<net::SecureTransport> secure;
    std::unique_ptr<BotInputs> inputs;
    std::unique_ptr<net::Client> client;
  };
  [[nodiscard]] bool add(std::uint16_t port, const net::ConnectToken& token,
                         const HashBoards& boards);

  net::SystemRandom random_;
  std::unique_ptr<net::EnetTransport> socket_;
  std::vector<Bot> bots_;
};

}  // namespace lockstone::tool
