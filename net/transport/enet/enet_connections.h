// The connections of an EnetTransport: a place for each peer of ENet, with the limits of its
// holder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <enet/enet.h>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet/enet_commands.h"
#include "net/transport/enet/enet_data.h"
#include "net/transport/enet/enet_datagram.h"
#include "net/transport/flood_watch.h"
#include "net/transport/udp/datagram_source.h"

namespace lockstone::net {

static_assert(k_max_socket_connections <= ENET_PROTOCOL_MAXIMUM_PEER_ID);

struct EnetConnection {
  ENetPeer* peer = nullptr;
  DatagramSource remote;  ///< the peer's address; ENet's own record of it holds IPv4 only
  std::uint32_t generation = 1;
  bool open = false;
  bool trusted = false;
  bool closing = false;       ///< this side has ended it; the peer has yet to confirm that
  std::int64_t since_us = 0;  ///< when it was asked for, or when it began to close
  RefuseReason ending = RefuseReason::none;   ///< the session is about to hear of this
  RefuseReason hearsay = RefuseReason::none;  ///< why it was refused, by a word of unknown origin
  std::int64_t hearsay_us = 0;                ///< when that came
  CommandFilter commands;
  LinkChecksum checksum{std::nullopt};  ///< of the match that it was asked for
  DatagramSeal seal;
  FloodWatch datagrams;
  FloodWatch packets;  ///< of which one datagram may hold many
  TransportStats stats;
};

/// Gives places to callers, a limited number to one address; names connections by ids that are not
/// used again; and ends the connections that exceed their limits. Allocates when made only.
class EnetConnections {
 public:
  EnetConnections(EnetData& data, const EnetOptions& options);

  [[nodiscard]] std::vector<EnetConnection>& all() { return connections_; }
  [[nodiscard]] EnetConnection& of(const ENetPeer* peer) { return connections_[index_of(peer)]; }
  [[nodiscard]] ConnectionId id_of(const ENetPeer* peer) const { return id_at(index_of(peer)); }

  /// The open connection of an id, or null.
  [[nodiscard]] EnetConnection* find(ConnectionId connection);

  /// The connection that ENet knows by this number, or null.
  [[nodiscard]] EnetConnection* find_numbered(enet_uint32 connect_id);

  /// Whether `peer` is the one that the datagram at hand comes from.
  [[nodiscard]] bool is_source(const ENetPeer& peer) const;

  /// Makes a connection of ENet's one of the session's.
  ConnectionId adopt(ENetPeer* peer);

  /// Whether the number is in use by another source. A number names one connection, since the keys
  /// of outgoing datagrams are found by it.
  [[nodiscard]] bool is_taken_elsewhere(enet_uint32 connect_id) const;

  /// Whether the source at hand holds a place under this number: ENet has taken the request
  /// already, and its answer was lost.
  [[nodiscard]] bool holds_place(enet_uint32 connect_id) const;

  /// Prepares the place that ENet will give to the source at hand, the first that is free. False:
  /// its address has as many as it may have.
  [[nodiscard]] bool make_place(const LinkChecksum& checksum);

  /// A member of the match has other limits than a stranger.
  void trust(EnetConnection& connection) const;

  /// This side has ended it.
  void begin_closing(EnetConnection& connection) const;

  /// Frees places that ENet would keep for long: requests that were never confirmed, and strangers
  /// that do not confirm the end.
  void free_silent();

  /// Counts a datagram or packet that exceeded a limit; too many end the connection. Returns false.
  bool count_excess(EnetConnection& connection, const FloodWatch& watch);

  /// The session will hear that the connection has ended.
  void end(EnetConnection& connection, RefuseReason reason);

  /// Tells of one connection that a limit or a refusal ends.
  [[nodiscard]] bool tell_ended(TransportEvent& event);

 private:
  [[nodiscard]] std::size_t index_of(const ENetPeer* peer) const;
  [[nodiscard]] ConnectionId id_at(std::size_t index) const;
  void prepare(EnetConnection& connection, const LinkChecksum& checksum) const;
  void free_place(std::size_t index);
  [[nodiscard]] bool is_crowded() const;
  [[nodiscard]] std::optional<std::size_t> oldest_closing() const;

  EnetData& data_;
  DatagramLimits limits_;
  std::size_t places_per_address_;
  std::size_t strangers_per_address_;
  std::uint32_t timeout_ms_;
  std::vector<EnetConnection> connections_;  ///< by ENet's peer number
  std::size_t last_numbered_ = 0;            ///< where find_numbered found one
  bool any_ending_ = false;
};

}  // namespace lockstone::net
