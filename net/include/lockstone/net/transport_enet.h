// The transport over UDP, by ENet 1.3. Present only where LOCKSTONE_WITH_ENET is on.
//
// ENet keeps its own clock and has no encryption: sessions over it must ask for `insecure`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

#include <lockstone/net/transport.h>

namespace lockstone::net {

struct EnetOptions {
  std::string bind_address = "127.0.0.1";   ///< numeric IPv4
  std::uint16_t port = 0;                   ///< 0: the system chooses, see EnetTransport::port
  std::size_t max_connections = 32;         ///< 1 … 1024
  std::size_t max_waiting_bytes = 1 << 20;  ///< received but not yet polled, per connection
  std::uint32_t timeout_ms = 5000;          ///< unanswered reliable packets end a connection
};

/// One UDP socket. Use it from one thread.
class EnetTransport final : public Transport {
 public:
  /// Opens a socket that accepts connections. invalid_argument: address or limits; io_error: the
  /// system refused the address or port.
  [[nodiscard]] static Result<std::unique_ptr<EnetTransport>> listen(const EnetOptions& options);

  /// Opens a socket that only calls others; address and port of `options` are not used.
  [[nodiscard]] static Result<std::unique_ptr<EnetTransport>> open(const EnetOptions& options);

  ~EnetTransport() override;
  EnetTransport(const EnetTransport&) = delete;
  EnetTransport& operator=(const EnetTransport&) = delete;

  /// Begins to connect; `connected` or `disconnected` follows as an event. `address` is numeric.
  [[nodiscard]] Result<ConnectionId> connect(const std::string& address, std::uint16_t port);

  /// The UDP port that this side is bound to; 0 before anything was sent by an `open` socket.
  [[nodiscard]] std::uint16_t port() const;

  /// `now_us` is not used: ENet reads the system's monotonic clock itself.
  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override;
  void disconnect(ConnectionId connection) override;
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;

 private:
  struct State;
  explicit EnetTransport(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lockstone::net
