// The transport over WebSockets, by libwebsockets: for players in browsers. Its functions are present
// only where LOCKSTONE_WITH_WEBSOCKETS is on.
//
// Packets travel as binary messages over TCP, so that a lost segment holds back all that follow it.
// TLS keeps the handshake and the addresses private; the packets are sealed by SecureTransport, as
// over UDP. Bytes: docs/reference/wire-format.md, "WebSockets".
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <lockstone/net/datagram_limits.h>
#include <lockstone/net/transport.h>

namespace lockstone::net {

struct WebSocketOptions {
  /// Numeric, IPv4 or IPv6. `::` stands for all addresses of both, `0.0.0.0` for those of IPv4.
  std::string bind_address = "127.0.0.1";
  std::uint16_t port = 0;            ///< 0: the system chooses, see WebSocketTransport::port
  std::size_t max_connections = 32;  ///< 1 … 4095, callers that have not finished a handshake too
  /// Players behind one router share an address. IPv6 addresses of one /64 count as one.
  std::size_t max_connections_per_address = 8;
  std::size_t max_strangers_per_address = 4;  ///< of these, before `trust`
  /// Bytes that may wait for one peer, at least 64 KiB. A peer for which more waits is disconnected;
  /// of unreliable packets the oldest are dropped long before.
  std::size_t max_outgoing_bytes = 2 << 20;
  std::int64_t handshake_us = 5'000'000;  ///< from TCP's handshake to the end of the WebSocket's
  std::int64_t ping_us = 1'000'000;       ///< between two pings, which measure the round trip
  std::int64_t idle_us = 20'000'000;      ///< without a byte, not even an answer to a ping
  /// Pages of these origins may connect, like `https://game.example`; none: all. Programs that are
  /// no browsers send none, and may.
  std::vector<std::string> origins = {};
  std::string certificate_file = {};  ///< PEM, with its chain; of a listening socket: TLS
  std::string key_file = {};          ///< PEM
  /// Of a client: PEM with the certificates to trust instead of the system's.
  std::string authority_file = {};
  DatagramLimits limits = {};  ///< of messages, of those who call a listening socket
};

/// Counters of the traffic that reached a socket and of the rejected part, since its creation.
struct WebSocketCounters {
  std::uint64_t callers = 0;            ///< accepted by TCP
  std::uint64_t opened = 0;             ///< handshakes that were completed
  std::uint64_t messages = 0;           ///< whole ones
  std::uint64_t crowded = 0;            ///< callers from an address that has all its places
  std::uint64_t full = 0;               ///< callers when all places were taken
  std::uint64_t wrong_origin = 0;       ///< handshakes of pages elsewhere
  std::uint64_t wrong_protocol = 0;     ///< HTTP of another kind, or another subprotocol
  std::uint64_t handshakes_late = 0;    ///< not completed in time
  std::uint64_t malformed = 0;          ///< text, empty or too long: the peer was disconnected
  std::uint64_t limited = 0;            ///< messages beyond a peer's limits
  std::uint64_t floods = 0;             ///< peers disconnected for that
  std::uint64_t slow = 0;               ///< peers disconnected because too much waited for them
  std::uint64_t idle = 0;               ///< peers disconnected because nothing came from them
  std::uint64_t unreliable_dropped = 0; ///< packets that newer ones replaced before they were sent
};

struct WebSocketNetwork;

/// Sockets with WebSockets. Use it from one thread. The first one silences the log of libwebsockets
/// in this process, and ignores SIGPIPE.
class WebSocketTransport final : public Transport {
 public:
  /// Opens a socket that accepts connections. invalid_argument: address, limits or one of
  /// certificate and key alone; io_error: the system refused the address or port, or the files are
  /// no certificate and key. An error writes a line for people into `problem`.
  [[nodiscard]] static Result<std::unique_ptr<WebSocketTransport>> listen(
      const WebSocketOptions& options, std::string* problem = nullptr);

  /// Only calls others; address, port and limits of `options` are not used.
  [[nodiscard]] static Result<std::unique_ptr<WebSocketTransport>> open(
      const WebSocketOptions& options);

  ~WebSocketTransport() override;
  WebSocketTransport(const WebSocketTransport&) = delete;
  WebSocketTransport& operator=(const WebSocketTransport&) = delete;

  /// Begins to connect to `ws://HOST:PORT/` or `wss://HOST:PORT/`; `connected` or `disconnected`
  /// follows as an event. A name is looked up, and blocks as long as that takes. invalid_argument:
  /// no such address; capacity_exhausted: too many connections.
  [[nodiscard]] Result<ConnectionId> connect(const std::string& url);

  /// The TCP port that a listening side is bound to.
  [[nodiscard]] std::uint16_t port() const;

  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override;
  void disconnect(ConnectionId connection) override;
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;
  void trust(ConnectionId connection) override;

  /// Bytes that wait for a peer, here and not in the system; 0 for an unknown connection.
  [[nodiscard]] std::size_t waiting_bytes(ConnectionId connection) const;

  [[nodiscard]] const WebSocketCounters& counters() const;

 private:
  explicit WebSocketTransport(std::unique_ptr<WebSocketNetwork> network);
  std::unique_ptr<WebSocketNetwork> network_;
};

}  // namespace lockstone::net
