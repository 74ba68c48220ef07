// The calls of EnetTransport.
#include <algorithm>
#include <string>

#include <lockstone/net/token.h>

#include "net/transport/enet/enet_state.h"

namespace lockstone::net {
namespace {

constexpr std::int64_t k_longest_wait_us = 3'600'000'000;

}  // namespace

EnetTransport::EnetTransport(std::unique_ptr<State> state) : state_(std::move(state)) {}
EnetTransport::~EnetTransport() = default;

Result<std::unique_ptr<EnetTransport>> EnetTransport::listen(const EnetOptions& options,
                                                             std::string* problem) {
  std::string reason;
  Result<std::unique_ptr<State>> state = State::listen(options, &reason);
  if (!state) {
    if (reason.empty()) reason = to_string(state.status());
    const HostPort where{options.bind_address, options.port};
    if (problem != nullptr) *problem = where.to_text() + ": " + reason;
    return state.status();
  }
  return std::unique_ptr<EnetTransport>(new EnetTransport(std::move(state).value()));
}

Result<std::unique_ptr<EnetTransport>> EnetTransport::open(const EnetOptions& options) {
  Result<std::unique_ptr<State>> state = State::create(options, nullptr);
  if (!state) return state.status();
  return std::unique_ptr<EnetTransport>(new EnetTransport(std::move(state).value()));
}

Result<ConnectionId> EnetTransport::connect(const std::string& address, std::uint16_t port) {
  ENetAddress target{};
  DatagramSource remote;
  if (read_ipv4(address, port, target)) {
    remote = source_of(target);
  } else {
    const std::optional<DatagramSource> ipv6 = read_ipv6(address, port);
    if (!ipv6) return Status::invalid_argument;
    if (!state_->add_ipv6(nullptr)) return Status::io_error;
    remote = *ipv6;
    target = state_->data.ipv6->own();
  }
  ENetPeer* peer =
      enet_host_connect(state_->data.host, &target, k_channels, state_->data.match_tag);
  if (peer == nullptr) return Status::capacity_exhausted;
  const ConnectionId connection = state_->connections.adopt(peer);
  state_->connections.of(peer).remote = remote;
  return connection;
}

std::uint16_t EnetTransport::port() const {
  return state_->port();
}

bool EnetTransport::poll(std::int64_t now_us, TransportEvent& event) {
  return state_->poll(now_us, event);
}

Status EnetTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  EnetConnection* target = state_->connections.find(connection);
  if (target == nullptr) return Status::stale_handle;
  const bool reliable = channel == Channel::reliable;
  const std::size_t limit = reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
  if (bytes.empty() || bytes.size() > limit + k_carrier_reserve_bytes)
    return Status::invalid_argument;
  const auto flag = reliable ? ENET_PACKET_FLAG_RELIABLE : ENET_PACKET_FLAG_UNSEQUENCED;
  ENetPacket* packet =
      enet_packet_create(bytes.data(), bytes.size(), static_cast<enet_uint32>(flag));
  if (packet == nullptr) return Status::capacity_exhausted;
  if (enet_peer_send(target->peer, static_cast<enet_uint8>(channel), packet) != 0) {
    enet_packet_destroy(packet);
    return Status::capacity_exhausted;
  }
  ++target->stats.packets_sent;
  target->stats.bytes_sent += bytes.size();
  return Status::ok;
}

void EnetTransport::flush() {
  enet_host_flush(state_->data.host);
}

bool EnetTransport::wait(std::int64_t limit_us) {
  enet_uint32 condition = ENET_SOCKET_WAIT_RECEIVE | ENET_SOCKET_WAIT_INTERRUPT;
  const auto limit_ms = static_cast<enet_uint32>(
      (std::clamp<std::int64_t>(limit_us, 0, k_longest_wait_us) + 999) / 1000);
  const ENetHost& host = *state_->data.host;
  if (state_->data.ipv6 != nullptr) return state_->data.ipv6->wait(host, limit_ms);
  const int result = enet_socket_wait(host.socket, &condition, limit_ms);
  return result == 0 && (condition & ENET_SOCKET_WAIT_RECEIVE) != 0;
}

void EnetTransport::disconnect(ConnectionId connection) {
  EnetConnection* target = state_->connections.find(connection);
  if (target == nullptr) return;
  target->open = false;
  state_->connections.begin_closing(*target);
  enet_peer_disconnect_later(target->peer, 0);
}

TransportStats EnetTransport::stats(ConnectionId connection) const {
  const EnetConnection* target = state_->connections.find(connection);
  if (target == nullptr) return {};
  TransportStats stats = target->stats;
  stats.round_trip_us = static_cast<std::int64_t>(target->peer->roundTripTime) * 1000;
  return stats;
}

void EnetTransport::trust(ConnectionId connection) {
  if (EnetConnection* target = state_->connections.find(connection)) {
    state_->connections.trust(*target);
  }
}

void EnetTransport::protect(ConnectionId connection, const DatagramKeys& keys, bool peer_has_them) {
  if (EnetConnection* target = state_->connections.find(connection))
    target->seal = {keys, peer_has_them};
}

const EnetCounters& EnetTransport::counters() const {
  return state_->data.counters;
}

}  // namespace lockstone::net
