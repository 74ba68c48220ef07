// The transport over UDP, by ENet 1.3. Present only where LOCKSTONE_WITH_ENET is on.
//
// Every datagram carries a checksum under the match's link key, and is dropped before ENet sees it
// if that is wrong: a stranger gets no connection and no answer. Encryption is SecureTransport's.
// Without a link key the checksum is one that anybody can compute: then the session must be
// `insecure`.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/net/datagram_limits.h>
#include <lockstone/net/keys.h>
#include <lockstone/net/open_matches.h>
#include <lockstone/net/transport.h>

namespace lockstone::net {

struct EnetOptions {
  /// Numeric, IPv4 or IPv6. `::` stands for all addresses of both, `0.0.0.0` for those of IPv4.
  std::string bind_address = "127.0.0.1";
  std::uint16_t port = 0;            ///< 0: the system chooses, see EnetTransport::port
  std::size_t max_connections = 32;  ///< 1 … 4095
  /// Players behind one router share an address. IPv6 addresses of one /64 count as one.
  std::size_t max_connections_per_address = 8;
  std::size_t max_strangers_per_address = 4;  ///< of these, before `trust`
  std::size_t max_waiting_bytes = 1 << 20;    ///< received but not yet polled, per connection
  /// Without an answer to any reliable packet a connection ends. Well above the session's drop
  /// time: on a bad connection ENet may send only three times in 5 s, and all three may be lost.
  std::uint32_t timeout_ms = 20000;
  std::optional<LinkKey> link_key = std::nullopt;  ///< none: open to everybody
  /// make_match_tag of the match: a client of another match is told so. 0: it hears nothing.
  std::uint32_t match_tag = 0;
  /// Instead of key and tag, of a listening socket: a request for a connection has the tag and the
  /// checksum of one of these matches. Must outlive the transport.
  const OpenMatches* matches = nullptr;
  DatagramLimits limits = {};      ///< of those who call a listening socket
  RandomSource* random = nullptr;  ///< for numbers of connections; null: the system's
};

/// Counters of the traffic that reached a socket and of the rejected part, since its creation.
struct EnetCounters {
  std::uint64_t datagrams = 0;          ///< all but empty ones over IPv4
  std::uint64_t malformed = 0;          ///< no datagram of ENet
  std::uint64_t strays = 0;             ///< of no connection that exists
  std::uint64_t forged = 0;             ///< wrong checksum
  std::uint64_t repeated_connects = 0;  ///< a request for a connection, sent again from elsewhere
  std::uint64_t refusals = 0;           ///< answers to peers of another kind or match, 20 a second
  std::uint64_t limited = 0;            ///< beyond a peer's limits
  std::uint64_t floods = 0;             ///< peers disconnected for that
  std::uint64_t too_far_ahead = 0;      ///< more reliable packets behind a gap than may wait
  std::uint64_t crowded = 0;            ///< requests from an address that has all its places
  std::uint64_t replayed = 0;           ///< sealed ones that came before, or are too old to know
  std::uint64_t oversized = 0;          ///< longer than any datagram of ENet
};

/// The numeric addresses of a host, IPv4 and IPv6, each once, in the order in which the system
/// would try them; a numeric address gives itself. Empty: no such host. Asks the system's resolver
/// and blocks as long as that does.
[[nodiscard]] std::vector<std::string> resolve_host(const std::string& host);

/// A UDP socket, and one more where IPv6 is used. Use it from one thread.
class EnetTransport final : public Transport {
 public:
  /// Opens a socket that accepts connections. invalid_argument: address or limits; io_error: the
  /// system refused the address or port; incompatible: a link key without libsodium. An error
  /// writes a line for people into `problem`, with the address, the port and the reason.
  [[nodiscard]] static Result<std::unique_ptr<EnetTransport>> listen(
      const EnetOptions& options, std::string* problem = nullptr);

  /// Opens a socket that only calls others; address, port and limits of `options` are not used.
  [[nodiscard]] static Result<std::unique_ptr<EnetTransport>> open(const EnetOptions& options);

  ~EnetTransport() override;
  EnetTransport(const EnetTransport&) = delete;
  EnetTransport& operator=(const EnetTransport&) = delete;

  /// Begins to connect; `connected` or `disconnected` follows as an event. `address` is numeric,
  /// IPv4 or IPv6 (`fe80::1%eth0` for one that is valid on one interface only). invalid_argument:
  /// it is not; io_error: the system has no IPv6.
  [[nodiscard]] Result<ConnectionId> connect(const std::string& address, std::uint16_t port);

  /// The UDP port that this side is bound to; 0 before anything was sent by an `open` socket.
  [[nodiscard]] std::uint16_t port() const;

  /// `now_us` is for the limits alone: ENet reads the system's monotonic clock itself.
  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override;

  /// Sleeps until a datagram has come, at most `limit_us`, rounded up to milliseconds. For a
  /// program whose loop has nothing else to do; all else here returns at once. True if one has
  /// come.
  bool wait(std::int64_t limit_us);

  void disconnect(ConnectionId connection) override;
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;
  void trust(ConnectionId connection) override;
  void protect(ConnectionId connection, const DatagramKeys& keys, bool peer_has_them) override;

  [[nodiscard]] const EnetCounters& counters() const;

 private:
  struct State;
  explicit EnetTransport(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace lockstone::net
