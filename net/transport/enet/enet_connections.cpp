#include "net/transport/enet/enet_connections.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::uint32_t k_index_bits = 12;  // of a ConnectionId; the rest is the generation
constexpr std::uint32_t k_index_mask = (1U << k_index_bits) - 1;
constexpr std::uint32_t k_generations = 1U << (k_connection_bits - k_index_bits);
static_assert(k_max_socket_connections <= k_index_mask + 1);

// A session counts its own time-outs; ENet's, in which this plays a part, shall not be the first.
constexpr std::uint32_t k_timeout_doublings = 32;
// But a connection that was asked for and never confirmed holds a place.
constexpr std::int64_t k_half_open_us = 2'000'000;
// A stranger that was sent away need not confirm that it heard why.
constexpr std::int64_t k_farewell_us = 2'000'000;

}  // namespace

EnetConnections::EnetConnections(EnetData& data, const EnetOptions& options)
    : data_(data),
      limits_(options.limits),
      places_per_address_(options.max_connections_per_address),
      strangers_per_address_(options.max_strangers_per_address),
      timeout_ms_(options.timeout_ms),
      connections_(options.max_connections) {}

std::size_t EnetConnections::index_of(const ENetPeer* peer) const {
  const auto index = static_cast<std::size_t>(peer - data_.host->peers);
  LKS_ASSERT(index < connections_.size());
  return index;
}

ConnectionId EnetConnections::id_at(std::size_t index) const {
  return (connections_[index].generation << k_index_bits) | static_cast<std::uint32_t>(index);
}

EnetConnection* EnetConnections::find(ConnectionId connection) {
  const std::size_t index = connection & k_index_mask;
  if (index >= connections_.size() || !connections_[index].open) return nullptr;
  return id_at(index) == connection ? &connections_[index] : nullptr;
}

// ENet sends to one peer after another, so that the next one is seldom far from the last.
EnetConnection* EnetConnections::find_numbered(enet_uint32 connect_id) {
  const std::size_t count = data_.host->peerCount;
  std::size_t index = last_numbered_;
  for (std::size_t i = 0; i < count; ++i, index = index + 1 < count ? index + 1 : 0) {
    const ENetPeer& peer = data_.host->peers[index];
    if (peer.state == ENET_PEER_STATE_DISCONNECTED || peer.connectID != connect_id) continue;
    last_numbered_ = index;
    return &connections_[index];
  }
  return nullptr;
}

bool EnetConnections::is_source(const ENetPeer& peer) const {
  return connections_[index_of(&peer)].remote == data_.source;
}

ConnectionId EnetConnections::adopt(ENetPeer* peer) {
  EnetConnection& connection = of(peer);
  connection.peer = peer;
  connection.open = true;
  connection.ending = RefuseReason::none;
  connection.stats = {};
  if (!data_.listens) prepare(connection, data_.checksum);
  // Never zero, so that no id is k_no_connection.
  connection.generation = connection.generation + 1 >= k_generations ? 1 : connection.generation + 1;
  enet_peer_timeout(peer, k_timeout_doublings, timeout_ms_, timeout_ms_);
  return id_of(peer);
}

bool EnetConnections::is_taken_elsewhere(enet_uint32 connect_id) const {
  const ENetHost& host = *data_.host;
  return std::any_of(host.peers, host.peers + host.peerCount, [&](const ENetPeer& peer) {
    return peer.state != ENET_PEER_STATE_DISCONNECTED && peer.connectID == connect_id &&
           !is_source(peer);
  });
}

bool EnetConnections::holds_place(enet_uint32 connect_id) const {
  const ENetHost& host = *data_.host;
  return std::any_of(host.peers, host.peers + host.peerCount, [&](const ENetPeer& peer) {
    return peer.state != ENET_PEER_STATE_DISCONNECTED && peer.connectID == connect_id &&
           is_source(peer);
  });
}

// Places of connections that this side has ended are free as soon as somebody wants one, and count
// for no address.
bool EnetConnections::is_crowded() const {
  std::size_t neighbours = 0;
  std::size_t strangers = 0;
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    const EnetConnection& connection = connections_[i];
    const bool used = data_.host->peers[i].state != ENET_PEER_STATE_DISCONNECTED;
    if (!used || connection.closing) continue;
    if (!from_one_site(connection.remote, data_.source)) continue;
    ++neighbours;
    if (!connection.trusted) ++strangers;
  }
  return neighbours >= places_per_address_ || strangers >= strangers_per_address_;
}

// Of equally old ones, the last.
std::optional<std::size_t> EnetConnections::oldest_closing() const {
  std::optional<std::size_t> oldest;
  for (std::size_t i = connections_.size(); i-- > 0;) {
    const bool used = data_.host->peers[i].state != ENET_PEER_STATE_DISCONNECTED;
    if (!used || !connections_[i].closing) continue;
    if (!oldest || connections_[i].since_us < connections_[*oldest].since_us) oldest = i;
  }
  return oldest;
}

bool EnetConnections::make_place(const LinkChecksum& checksum) {
  if (is_crowded()) {
    ++data_.counters.crowded;
    return false;
  }
  const ENetPeer* peers = data_.host->peers;
  const ENetPeer* end = peers + connections_.size();
  const ENetPeer* found = std::find_if(
      peers, end, [](const ENetPeer& peer) { return peer.state == ENET_PEER_STATE_DISCONNECTED; });
  std::optional<std::size_t> place;
  if (found != end) {
    place = static_cast<std::size_t>(found - peers);
  } else {
    place = oldest_closing();
    if (place) free_place(*place);
  }
  if (place) {
    prepare(connections_[*place], checksum);
    connections_[*place].remote = data_.source;
  }
  return true;
}

void EnetConnections::prepare(EnetConnection& connection, const LinkChecksum& checksum) const {
  connection.trusted = connection.closing = false;
  connection.since_us = data_.now_us;
  connection.hearsay = RefuseReason::none;
  connection.commands = {};
  connection.checksum = checksum;
  connection.seal = {};
  connection.datagrams = connection.packets = {};
  if (!data_.listens) return;
  connection.datagrams =
      FloodWatch(limits_.stranger_packets_per_second, limits_.stranger_bytes_per_second);
  connection.packets = FloodWatch(limits_.stranger_packets_per_second, 0);
}

void EnetConnections::trust(EnetConnection& connection) const {
  if (!data_.listens) return;
  connection.trusted = true;
  connection.datagrams = FloodWatch(limits_.packets_per_second, limits_.bytes_per_second);
  connection.packets = FloodWatch(limits_.packets_per_second, 0);
}

void EnetConnections::begin_closing(EnetConnection& connection) const {
  connection.closing = true;
  connection.since_us = data_.now_us;
}

void EnetConnections::free_place(std::size_t index) {
  connections_[index].closing = false;
  enet_peer_reset(&data_.host->peers[index]);
}

// ENet would keep a connection that was requested and never confirmed for 30 s, and a peer that
// does not confirm the end of a connection for timeout_ms.
void EnetConnections::free_silent() {
  for (std::size_t i = 0; i < data_.host->peerCount; ++i) {
    const ENetPeer& peer = data_.host->peers[i];
    const EnetConnection& connection = connections_[i];
    const std::int64_t silent_us = data_.now_us - connection.since_us;
    const bool half_open =
        peer.state == ENET_PEER_STATE_ACKNOWLEDGING_CONNECT && silent_us >= k_half_open_us;
    const bool sent_away = connection.closing && !connection.trusted && silent_us >= k_farewell_us;
    if (half_open || sent_away) free_place(i);
  }
}

bool EnetConnections::count_excess(EnetConnection& connection, const FloodWatch& watch) {
  ++data_.counters.limited;
  if (connection.open && watch.flooding() && connection.ending == RefuseReason::none) {
    end(connection, RefuseReason::flooding);
    ++data_.counters.floods;
  }
  return false;
}

void EnetConnections::end(EnetConnection& connection, RefuseReason reason) {
  LKS_ASSERT(connection.open && reason != RefuseReason::none);
  connection.ending = reason;
  any_ending_ = true;
}

bool EnetConnections::tell_ended(TransportEvent& event) {
  if (!any_ending_) return false;
  for (std::size_t index = 0; index < connections_.size(); ++index) {
    EnetConnection& connection = connections_[index];
    if (!connection.open || connection.ending == RefuseReason::none) continue;
    event = {};
    event.kind = TransportEventKind::disconnected;
    event.connection = id_at(index);
    event.reason = connection.ending;
    connection.open = false;
    // Told to the peer as well, unless it is the peer that refuses.
    if (connection.peer->state == ENET_PEER_STATE_CONNECTING) {
      enet_peer_reset(connection.peer);
    } else {
      enet_peer_disconnect(connection.peer, static_cast<enet_uint32>(connection.ending));
      begin_closing(connection);
    }
    return true;
  }
  any_ending_ = false;
  return false;
}

}  // namespace lockstone::net
