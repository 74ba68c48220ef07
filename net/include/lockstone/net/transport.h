// The network interface of a session: connections that carry datagrams, and no clock of its own.
//
// A transport is driven by one thread. It never blocks and keeps no global state. Time comes in as
// microseconds from any origin, 0 or above, never running backwards; one origin for all calls.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <lockstone/bytes.h>
#include <lockstone/net/reasons.h>
#include <lockstone/status.h>

namespace lockstone::net {

/// Names one connection of one transport. Not reused while anybody may still hold it; 0 is none.
using ConnectionId = std::uint32_t;
inline constexpr ConnectionId k_no_connection = 0;
/// Numbers of a transport that has a socket have at most so many bits: see JoinedTransport.
inline constexpr unsigned k_connection_bits = 30;

/// The most bytes of one unreliable and of one reliable packet that a session sends.
inline constexpr std::size_t k_max_datagram_bytes = 1200;
inline constexpr std::size_t k_max_reliable_bytes = 48 * 1024;

/// The most connections of one socket.
inline constexpr std::size_t k_max_socket_connections = 4095;

/// A transport that carries another one accepts this many more bytes, for the other's headers.
inline constexpr std::size_t k_carrier_reserve_bytes = 32;

enum class Channel : std::uint8_t {
  reliable = 0,    ///< arrives once, whole and in order, or the connection ends
  unreliable = 1,  ///< may be lost, doubled or overtaken
};
[[nodiscard]] std::string_view to_string(Channel channel);

/// The slot of somebody who only watches.
inline constexpr std::uint8_t k_spectator_slot = 254;

/// Who is at the other end, as proven by a token; all else is zero if it is not `authenticated`.
struct PeerIdentity {
  bool authenticated = false;
  std::uint64_t match = 0;
  std::uint64_t player = 0;  ///< the backend's number for the account
  std::uint8_t slot = 0;     ///< the seat it may take, or k_spectator_slot
  friend bool operator==(const PeerIdentity&, const PeerIdentity&) = default;
};

enum class TransportEventKind : std::uint8_t { connected, disconnected, received };
[[nodiscard]] std::string_view to_string(TransportEventKind kind);

/// Something that happened. `bytes` is valid until the next call of `poll`.
struct TransportEvent {
  TransportEventKind kind = TransportEventKind::received;
  ConnectionId connection = k_no_connection;
  Channel channel = Channel::reliable;  ///< of a received packet
  ByteView bytes;                       ///< of a received packet
  /// Of `disconnected`, where it is known: the peer's reason for its refusal, or the limit that was
  /// passed.
  RefuseReason reason = RefuseReason::none;
};

/// Traffic of one connection. Payload bytes, without the headers that a transport adds.
struct TransportStats {
  std::uint64_t bytes_sent = 0;
  std::uint64_t bytes_received = 0;
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_received = 0;
  std::int64_t round_trip_us = -1;  ///< smoothed; -1 while unknown
};

struct DatagramKeys;

class Transport {
 public:
  virtual ~Transport() = default;

  /// Takes the next event. False when nothing is left for now.
  virtual bool poll(std::int64_t now_us, TransportEvent& event) = 0;

  /// Queues one packet. stale_handle: no such connection; invalid_argument: empty or too long;
  /// capacity_exhausted: too much is waiting already.
  virtual Status send(ConnectionId connection, Channel channel, ByteView bytes) = 0;

  /// Hands queued packets to the network now.
  virtual void flush() = 0;

  /// Ends a connection after its reliable packets were sent. This side gets no further event of it.
  virtual void disconnect(ConnectionId connection) = 0;

  /// Zeros for an unknown connection.
  [[nodiscard]] virtual TransportStats stats(ConnectionId connection) const = 0;

  /// True if packets are encrypted and every peer that connects has an identity.
  [[nodiscard]] virtual bool secure() const { return false; }

  /// Who that is. Not authenticated: anybody, or no such connection.
  [[nodiscard]] virtual PeerIdentity identity(ConnectionId /*connection*/) const { return {}; }

  /// The peer plays: limits that are narrower for strangers no longer hold for it.
  virtual void trust(ConnectionId /*connection*/) {}

  /// Both ends have keys of their own now, under which a transport of datagrams seals them. From
  /// the first sealed datagram on, datagrams without a seal are dropped. `peer_has_them`: this side
  /// seals at once; else it begins after that datagram.
  virtual void protect(ConnectionId /*connection*/, const DatagramKeys& /*keys*/,
                       bool /*peer_has_them*/) {}
};

}  // namespace lockstone::net
