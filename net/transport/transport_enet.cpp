// The calls of EnetTransport. Their data is in enet_state.h.
#include <algorithm>
#include <string>

#include <lockstone/net/token.h>

#include "net/transport/enet_state.h"

namespace lockstone::net {

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
    target = state_->ipv6->own();
  }
  ENetPeer* peer = enet_host_connect(state_->host, &target, k_channels, state_->match_tag);
  if (peer == nullptr) return Status::capacity_exhausted;
  const ConnectionId connection = state_->adopt(peer);
  state_->entries[state_->index_of(peer)].remote = remote;
  return connection;
}

std::uint16_t EnetTransport::port() const {
  return state_->port();
}

bool EnetTransport::poll(std::int64_t now_us, TransportEvent& event) {
  state_->release_current();
  state_->now_us = now_us;
  ENetEvent source{};
  if (state_->ipv6 != nullptr) state_->ipv6->begin_poll();
  for (unsigned cut = 0; cut < k_max_cut_rounds_a_poll;) {
    if (state_->ipv6 != nullptr && state_->ipv6->fetch(state_->counters)) state_->wake_for_ipv6();
    state_->datagrams_a_round = 0;
    const int result = enet_host_service(state_->host, &source, 0);
    if (result > 0) {
      if (state_->translate(source, event)) return true;
      state_->release_current();
      continue;
    }
    if (result == 0 && !state_->was_cut_short()) break;
    ++cut;
    if (result < 0) ++state_->counters.oversized;
  }
  state_->let_go_of_the_silent();
  return state_->end_one(event);
}

// ENet takes an empty datagram for the end of the queue.
bool EnetTransport::State::was_cut_short() const {
  if (datagrams_a_round >= k_enet_datagrams_a_round) return false;
  enet_uint32 condition = ENET_SOCKET_WAIT_RECEIVE;
  return enet_socket_wait(host->socket, &condition, 0) == 0 &&
         (condition & ENET_SOCKET_WAIT_RECEIVE) != 0;
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

bool EnetTransport::wait(std::int64_t limit_us) {
  enet_uint32 condition = ENET_SOCKET_WAIT_RECEIVE | ENET_SOCKET_WAIT_INTERRUPT;
  const auto limit_ms = static_cast<enet_uint32>(
      (std::clamp<std::int64_t>(limit_us, 0, k_longest_wait_us) + 999) / 1000);
  if (state_->ipv6 != nullptr) return state_->wait(limit_ms);
  const int result = enet_socket_wait(state_->host->socket, &condition, limit_ms);
  return result == 0 && (condition & ENET_SOCKET_WAIT_RECEIVE) != 0;
}

void EnetTransport::disconnect(ConnectionId connection) {
  State::Entry* entry = state_->find(connection);
  if (entry == nullptr) return;
  entry->open = false;
  state_->begin_closing(*entry);
  enet_peer_disconnect_later(entry->peer, 0);
}

TransportStats EnetTransport::stats(ConnectionId connection) const {
  const State::Entry* entry = state_->find(connection);
  if (entry == nullptr) return {};
  TransportStats stats = entry->stats;
  stats.round_trip_us = static_cast<std::int64_t>(entry->peer->roundTripTime) * 1000;
  return stats;
}

void EnetTransport::trust(ConnectionId connection) {
  State::Entry* entry = state_->find(connection);
  if (entry == nullptr || !state_->listens) return;
  entry->trusted = true;
  const DatagramLimits& limits = state_->limits;
  State::limit(*entry, limits.packets_per_second, limits.bytes_per_second);
}

void EnetTransport::protect(ConnectionId connection, const DatagramKeys& keys, bool peer_has_them) {
  if (State::Entry* entry = state_->find(connection)) entry->seal = {keys, peer_has_them};
}

const EnetCounters& EnetTransport::counters() const {
  return state_->counters;
}

// Shorter than the request, and seldom: no use for drowning the one whose address it bears.
void EnetTransport::State::refuse(const Word& connect, RefuseReason reason) {
  if (reason == RefuseReason::none) return;
  if (!refusals.take(source, now_us)) return;
  ++counters.refusals;
  auto bytes = encode(LinkRefusal{reason, connect});
  if (!source.is_ipv4()) return ipv6->send(source, bytes);
  ENetBuffer buffer{};
  buffer.data = bytes.data();
  buffer.dataLength = bytes.size();
  enet_socket_send(host->socket, &host->receivedAddress, &buffer, 1);
}

// Why the sender of a request with a wrong checksum cannot come in, if that can be told.
RefuseReason EnetTransport::State::reason_against(std::span<std::byte> request,
                                                  const DatagramHead& head) const {
  // Without a key, anything that has not the open checksum may be of the other kind.
  if (!checksum.keyed() || open_checksum.verify(request, head, Word{})) {
    return RefuseReason::insecure_not_allowed;
  }
  const std::uint32_t tag = read_match_tag(request);
  const bool other = match_tag != 0 && tag != 0 && tag != match_tag;
  return other ? RefuseReason::wrong_match : RefuseReason::none;
}

void EnetTransport::State::take_refusal(const LinkRefusal& refusal) {
  for (Entry& entry : entries) {
    const bool meant = entry.open && entry.peer->state == ENET_PEER_STATE_CONNECTING &&
                       raw_word(entry.peer->connectID) == refusal.connection;
    if (!meant || entry.hearsay != RefuseReason::none) continue;
    entry.hearsay = refusal.reason;
    entry.hearsay_us = now_us;
  }
}

void EnetTransport::State::believe_refusals() {
  for (Entry& entry : entries) {
    const bool waited = entry.open && entry.hearsay != RefuseReason::none &&
                        now_us - entry.hearsay_us >= k_refusal_patience_us;
    if (!waited || entry.peer->state != ENET_PEER_STATE_CONNECTING) continue;
    entry.ending = entry.hearsay;
    any_ending = true;
  }
}

// Nothing of a datagram counts for or against the peer before this. Takes the seal off.
bool EnetTransport::State::authenticate(Entry& entry, std::span<std::byte>& datagram,
                                        const DatagramHead& head) {
  const Word connection = raw_word(host->peers[head.peer].connectID);
  DatagramSeal::Outcome outcome = DatagramSeal::Outcome::forged;
  if (entry.seal.present()) outcome = entry.seal.open(datagram, head, connection);
  if (outcome == DatagramSeal::Outcome::ok) {
    datagram = datagram.first(datagram.size() - DatagramSeal::k_bytes);
    host->receivedDataLength = datagram.size();
    return true;
  }
  if (outcome == DatagramSeal::Outcome::replayed) {
    ++counters.replayed;
    return false;
  }
  if (!entry.seal.required() && checksum.verify(datagram, head, connection)) return true;
  ++counters.forged;
  return false;
}

// The checksum of the gathered datagram, which is sent instead of ENet's buffers: ENet reads them
// after its call of compute_checksum. The system takes one buffer in much less time than 33.
Word EnetTransport::State::finish(std::size_t size) {
  const std::span<std::byte> datagram = std::span(gathered).first(size);
  const std::optional<DatagramHead> head = read_head(datagram);
  if (!head) return checksum.of(datagram);
  Entry* entry = receiver_of(datagram, *head);
  const std::size_t sealed_size = size + DatagramSeal::k_bytes;
  const bool seals = entry != nullptr && entry->seal.sends() && sealed_size <= gathered.size();
  const std::span<std::byte> whole = std::span(gathered).first(seals ? sealed_size : size);
  const Word word = seals ? entry->seal.seal(whole) : checksum.of(whole);
  std::memcpy(gathered.data() + head->checksum_offset, word.data(), word.size());
  if (ipv6 != nullptr && entry != nullptr && !entry->remote.is_ipv4()) {
    send_over_ipv6(*entry, whole);
    return word;
  }
  host->buffers[0].data = whole.data();
  host->buffers[0].dataLength = whole.size();
  host->bufferCount = 1;
  return word;
}

// Null for a call that is given up before an answer: nobody would take that datagram.
EnetTransport::State::Entry* EnetTransport::State::receiver_of(ByteView datagram,
                                                               const DatagramHead& head) {
  const std::optional<Word> connect = read_connect(datagram, head);
  return entry_of(raw_value(connect ? *connect : word_of(datagram, head)));
}

EnetTransport::State::Entry* EnetTransport::State::entry_of(enet_uint32 connection) {
  for (std::size_t i = 0; i < host->peerCount; ++i) {
    const ENetPeer& peer = host->peers[i];
    const bool used = peer.state != ENET_PEER_STATE_DISCONNECTED;
    if (used && peer.connectID == connection) return &entries[i];
  }
  return nullptr;
}

}  // namespace lockstone::net
