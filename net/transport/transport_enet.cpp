// The only file that includes ENet.
// Behaviour relied upon: http://enet.bespin.org/ (1.3.17), "Features and Architecture".
#include <vector>

#include <enet/enet.h>

#include <lockstone/net/transport_enet.h>

namespace lockstone::net {
namespace {

constexpr std::size_t k_channels = 2;
constexpr std::size_t k_max_connections = 1024;
constexpr std::uint32_t k_index_bits = 10;  // of a ConnectionId; the rest is the generation
constexpr std::uint32_t k_index_mask = (1U << k_index_bits) - 1;

// A session counts its own time-outs; ENet's shall not be the first to fire by much.
constexpr std::uint32_t k_timeout_doublings = 32;

}  // namespace

struct EnetTransport::State {
  struct Entry {
    ENetPeer* peer = nullptr;
    std::uint32_t generation = 1;
    bool open = false;
    TransportStats stats;
  };

  // ENet counts start-ups per process where the system needs it (Windows), so each transport pairs
  // its own call with one shutdown.
  bool initialized = enet_initialize() == 0;
  ENetHost* host = nullptr;
  ENetPacket* current = nullptr;
  std::uint32_t timeout_ms = 0;
  std::vector<Entry> entries;  // by ENet's peer number

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  ~State() {
    release_current();
    if (host != nullptr) enet_host_destroy(host);
    if (initialized) enet_deinitialize();
  }

  void release_current() {
    if (current != nullptr) enet_packet_destroy(current);
    current = nullptr;
  }

  [[nodiscard]] std::size_t index_of(const ENetPeer* peer) const {
    return static_cast<std::size_t>(peer - host->peers);
  }

  [[nodiscard]] ConnectionId id_of(std::size_t index) const {
    return (entries[index].generation << k_index_bits) | static_cast<std::uint32_t>(index);
  }

  [[nodiscard]] Entry* find(ConnectionId connection) {
    const std::size_t index = connection & k_index_mask;
    if (index >= entries.size() || !entries[index].open) return nullptr;
    return id_of(index) == connection ? &entries[index] : nullptr;
  }

  ConnectionId adopt(ENetPeer* peer) {
    const std::size_t index = index_of(peer);
    Entry& entry = entries[index];
    entry.peer = peer;
    entry.open = true;
    entry.stats = {};
    // 22 bits of generation, never zero, so that no id is k_no_connection.
    entry.generation = entry.generation + 1 >= (1U << 22) ? 1 : entry.generation + 1;
    enet_peer_timeout(peer, k_timeout_doublings, timeout_ms, timeout_ms);
    return id_of(index);
  }

  // False for what the session shall not see, such as the end of a connection that it ended.
  bool translate(const ENetEvent& source, TransportEvent& event) {
    const std::size_t index = index_of(source.peer);
    Entry& entry = entries[index];
    if (source.type == ENET_EVENT_TYPE_CONNECT) {
      event = {};
      event.kind = TransportEventKind::connected;
      event.connection = entry.open ? id_of(index) : adopt(source.peer);
      // Not before: ENet refuses a connection whose first datagram carries this as well.
      enet_peer_throttle_configure(source.peer, ENET_PEER_PACKET_THROTTLE_INTERVAL,
                                   ENET_PEER_PACKET_THROTTLE_ACCELERATION, 0);
      return true;
    }
    if (source.type == ENET_EVENT_TYPE_RECEIVE) current = source.packet;
    if (!entry.open) return false;
    event.connection = id_of(index);
    if (source.type == ENET_EVENT_TYPE_DISCONNECT) {
      entry.open = false;
      event.kind = TransportEventKind::disconnected;
      event.bytes = {};
      return true;
    }
    event.kind = TransportEventKind::received;
    event.channel = source.channelID == 0 ? Channel::reliable : Channel::unreliable;
    event.bytes = std::as_bytes(std::span(current->data, current->dataLength));
    ++entry.stats.packets_received;
    entry.stats.bytes_received += current->dataLength;
    return true;
  }

  static Result<std::unique_ptr<State>> create(const EnetOptions& options,
                                               const ENetAddress* address) {
    if (options.max_connections < 1 || options.max_connections > k_max_connections) {
      return Status::invalid_argument;
    }
    auto state = std::make_unique<State>();
    if (!state->initialized) return Status::io_error;
    state->host = enet_host_create(address, options.max_connections, k_channels, 0, 0);
    if (state->host == nullptr) return Status::io_error;
    state->host->maximumPacketSize = k_max_reliable_bytes + k_carrier_reserve_bytes;
    state->host->maximumWaitingData = options.max_waiting_bytes;
    state->timeout_ms = options.timeout_ms;
    state->entries.resize(options.max_connections);
    return state;
  }
};

EnetTransport::EnetTransport(std::unique_ptr<State> state) : state_(std::move(state)) {}
EnetTransport::~EnetTransport() = default;

Result<std::unique_ptr<EnetTransport>> EnetTransport::listen(const EnetOptions& options) {
  ENetAddress address{};
  if (enet_address_set_host_ip(&address, options.bind_address.c_str()) != 0) {
    return Status::invalid_argument;
  }
  address.port = options.port;
  Result<std::unique_ptr<State>> state = State::create(options, &address);
  if (!state) return state.status();
  return std::unique_ptr<EnetTransport>(new EnetTransport(std::move(state).value()));
}

Result<std::unique_ptr<EnetTransport>> EnetTransport::open(const EnetOptions& options) {
  Result<std::unique_ptr<State>> state = State::create(options, nullptr);
  if (!state) return state.status();
  return std::unique_ptr<EnetTransport>(new EnetTransport(std::move(state).value()));
}

Result<ConnectionId> EnetTransport::connect(const std::string& address, std::uint16_t port) {
  ENetAddress target{};
  if (enet_address_set_host_ip(&target, address.c_str()) != 0) return Status::invalid_argument;
  target.port = port;
  ENetPeer* peer = enet_host_connect(state_->host, &target, k_channels, 0);
  if (peer == nullptr) return Status::capacity_exhausted;
  return state_->adopt(peer);
}

std::uint16_t EnetTransport::port() const {
  ENetAddress address{};
  if (enet_socket_get_address(state_->host->socket, &address) != 0) return 0;
  return address.port;
}

bool EnetTransport::poll(std::int64_t /*now_us*/, TransportEvent& event) {
  state_->release_current();
  ENetEvent source{};
  while (enet_host_service(state_->host, &source, 0) > 0) {
    if (state_->translate(source, event)) return true;
    state_->release_current();
  }
  return false;
}

Status EnetTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  State::Entry* entry = state_->find(connection);
  if (entry == nullptr) return Status::stale_handle;
  const bool reliable = channel == Channel::reliable;
  const std::size_t limit = reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
  if (bytes.empty() || bytes.size() > limit + k_carrier_reserve_bytes)
    return Status::invalid_argument;
  const auto flag = reliable ? ENET_PACKET_FLAG_RELIABLE : ENET_PACKET_FLAG_UNSEQUENCED;
  ENetPacket* packet =
      enet_packet_create(bytes.data(), bytes.size(), static_cast<enet_uint32>(flag));
  if (packet == nullptr) return Status::capacity_exhausted;
  if (enet_peer_send(entry->peer, static_cast<enet_uint8>(channel), packet) != 0) {
    enet_packet_destroy(packet);
    return Status::capacity_exhausted;
  }
  ++entry->stats.packets_sent;
  entry->stats.bytes_sent += bytes.size();
  return Status::ok;
}

void EnetTransport::flush() {
  enet_host_flush(state_->host);
}

void EnetTransport::disconnect(ConnectionId connection) {
  State::Entry* entry = state_->find(connection);
  if (entry == nullptr) return;
  entry->open = false;
  enet_peer_disconnect_later(entry->peer, 0);
}

TransportStats EnetTransport::stats(ConnectionId connection) const {
  const State::Entry* entry = state_->find(connection);
  if (entry == nullptr) return {};
  TransportStats stats = entry->stats;
  stats.round_trip_us = static_cast<std::int64_t>(entry->peer->roundTripTime) * 1000;
  return stats;
}

}  // namespace lockstone::net
