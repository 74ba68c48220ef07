// ENet's events, translated into the session's.
#include "net/transport/enet/enet_state.h"

namespace lockstone::net {
namespace {

// ENet ends a round of receiving after this many datagrams, and at each that is empty or longer
// than its buffer.
constexpr unsigned k_enet_datagrams_a_round = 256;
constexpr unsigned k_max_cut_rounds_a_poll = 64;

}  // namespace

bool EnetTransport::State::poll(std::int64_t now_us, TransportEvent& event) {
  release_current();
  data.now_us = now_us;
  Ipv6Side* ipv6 = data.ipv6.get();
  ENetEvent source{};
  if (ipv6 != nullptr) ipv6->begin_poll();
  for (unsigned cut = 0; cut < k_max_cut_rounds_a_poll;) {
    if (ipv6 != nullptr && ipv6->fetch(data.counters)) ipv6->wake(*data.host);
    datagrams_a_round_ = 0;
    const int result = enet_host_service(data.host, &source, 0);
    if (result > 0) {
      if (translate(source, event)) return true;
      release_current();
      continue;
    }
    if (result == 0 && !was_cut_short()) break;
    ++cut;
    if (result < 0) ++data.counters.oversized;
  }
  if (data.listens) {
    connections.free_silent();
  } else {
    refusals.believe();
  }
  return connections.tell_ended(event);
}

void EnetTransport::State::release_current() {
  if (current_ != nullptr) enet_packet_destroy(current_);
  current_ = nullptr;
}

// ENet takes an empty datagram for the end of the queue.
bool EnetTransport::State::was_cut_short() const {
  if (datagrams_a_round_ >= k_enet_datagrams_a_round) return false;
  enet_uint32 condition = ENET_SOCKET_WAIT_RECEIVE;
  return enet_socket_wait(data.host->socket, &condition, 0) == 0 &&
         (condition & ENET_SOCKET_WAIT_RECEIVE) != 0;
}

// False for events that the session must not see, such as the end of a connection that it ended.
bool EnetTransport::State::translate(const ENetEvent& from, TransportEvent& event) {
  EnetConnection& connection = connections.of(from.peer);
  event = {};
  if (from.type == ENET_EVENT_TYPE_CONNECT) {
    event.kind = TransportEventKind::connected;
    event.connection =
        connection.open ? connections.id_of(from.peer) : connections.adopt(from.peer);
    // Not before: ENet refuses a connection whose first datagram carries this as well.
    enet_peer_throttle_configure(from.peer, ENET_PEER_PACKET_THROTTLE_INTERVAL,
                                 ENET_PEER_PACKET_THROTTLE_ACCELERATION, 0);
    return true;
  }
  if (from.type == ENET_EVENT_TYPE_RECEIVE) current_ = from.packet;
  if (from.type == ENET_EVENT_TYPE_DISCONNECT) connection.closing = false;
  if (!connection.open) return false;
  event.connection = connections.id_of(from.peer);
  if (from.type == ENET_EVENT_TYPE_DISCONNECT) {
    connection.open = false;
    event.kind = TransportEventKind::disconnected;
    if (from.data <= static_cast<enet_uint32>(k_last_refuse_reason)) {
      event.reason = static_cast<RefuseReason>(from.data);
    }
    return true;
  }
  if (!connection.packets.admit(data.now_us, 0)) {
    return connections.count_excess(connection, connection.packets);
  }
  event.kind = TransportEventKind::received;
  event.channel = from.channelID == 0 ? Channel::reliable : Channel::unreliable;
  event.bytes = std::as_bytes(std::span(current_->data, current_->dataLength));
  ++connection.stats.packets_received;
  connection.stats.bytes_received += current_->dataLength;
  return true;
}

// Puts the next good datagram in the place of a wake. False if there is none.
bool EnetTransport::State::admit_ipv6() {
  Ipv6Side& ipv6 = *data.ipv6;
  while (ipv6.fetch(data.counters)) {
    if (!gate.admit(ipv6.take(*data.host, data.source))) continue;
    if (ipv6.fetch(data.counters)) ipv6.wake(*data.host);
    return true;
  }
  return false;
}

}  // namespace lockstone::net
