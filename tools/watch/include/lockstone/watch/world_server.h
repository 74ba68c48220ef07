// A running world, shown to `lockstone studio --world` on the same machine. Its functions are present
// only where LOCKSTONE_WITH_WEBSOCKETS is on.
//
// A viewer only looks: bytes that it sends after its token are dropped, and the world is passed as a
// constant. Bytes: docs/reference/wire-format.md, "Viewers of a world".
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lockstone/net/transport_websocket.h>
#include <lockstone/world.h>

namespace lockstone::watch {

/// Listens on 127.0.0.1 alone. Use it from the thread that steps the world.
class WorldServer {
 public:
  /// `port` 0: the system chooses. io_error: the port is taken, or sockets are refused; then a line
  /// for people stands in `problem`.
  [[nodiscard]] static Result<std::unique_ptr<WorldServer>> open(std::uint16_t port = 0,
                                                                 std::string* problem = nullptr);

  /// "ws://127.0.0.1:PORT/TOKEN": the argument of `lockstone studio --world`. Who knows the token,
  /// 128 random bits, sees the world.
  [[nodiscard]] const std::string& address() const { return address_; }

  /// To be called after every step, with the same world and with a time in microseconds that never
  /// runs backwards. Sends each viewer the world's state, unless the one before still waits for it:
  /// a slow viewer sees fewer ticks. Without viewers it only asks the socket for news.
  void update(const World& world, std::int64_t now_us);

  /// Viewers that have shown the token.
  [[nodiscard]] std::size_t viewers() const { return viewers_.size(); }

 private:
  struct Viewer {
    net::ConnectionId connection = net::k_no_connection;
    std::uint64_t tick = 0;  ///< of the last state that was sent
    bool has_state = false;
  };

  WorldServer(std::unique_ptr<net::WebSocketTransport> transport, std::string token);

  void hear(const World& world, const net::TransportEvent& event);
  void send(net::ConnectionId connection, ByteView message);
  [[nodiscard]] bool wants_state(const Viewer& viewer, std::uint64_t tick) const;
  void save(const World& world);

  std::unique_ptr<net::WebSocketTransport> transport_;
  std::string token_;
  std::string address_;
  std::vector<Viewer> viewers_;
  std::vector<std::byte> state_;  ///< the message with the last saved state
  std::vector<std::byte> packet_;
};

}  // namespace lockstone::watch
