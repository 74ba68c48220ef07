#include "net/routing/routed_transport.h"

#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone::net {

RoutedTransport::RoutedTransport(const MatchRouterOptions& options)
    : inbox(options.queue_bytes),
      outbox(options.queue_bytes),
      known_(options.max_connections_per_match) {}

bool RoutedTransport::poll(std::int64_t /*now_us*/, TransportEvent& event) {
  Parcel parcel;
  ByteView bytes;
  while (inbox.take(parcel, bytes)) {
    if (translate(parcel, bytes, event)) return true;
  }
  return false;
}

// False for an event of a connection that the match has ended itself.
bool RoutedTransport::translate(const Parcel& parcel, ByteView bytes, TransportEvent& event) {
  event = {};
  event.connection = parcel.connection;
  if (parcel.kind == ParcelKind::connected) {
    Known* place = find(k_no_connection);
    LKS_ASSERT(place != nullptr);  // the router knows no fewer connections of the match
    if (place == nullptr) return false;
    *place = {parcel.connection, false, parcel.identity, {}};
    event.kind = TransportEventKind::connected;
    return true;
  }
  Known* known = find(parcel.connection);
  if (known == nullptr) return false;
  if (parcel.kind == ParcelKind::disconnected) {
    *known = {};
    event.kind = TransportEventKind::disconnected;
    event.reason = parcel.reason;
    return true;
  }
  LKS_ASSERT(parcel.kind == ParcelKind::received);
  known->received = parcel.stats;
  event.channel = parcel.channel;
  event.bytes = bytes;
  return true;
}

Status RoutedTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  if (connection == k_no_connection || find(connection) == nullptr) return Status::stale_handle;
  const bool reliable = channel == Channel::reliable;
  const std::size_t limit = reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
  if (bytes.empty() || bytes.size() > limit) return Status::invalid_argument;
  Parcel parcel;
  parcel.kind = ParcelKind::send;
  parcel.channel = channel;
  parcel.connection = connection;
  parcel.size = bytes.size();
  // Room stays for two orders about each connection.
  return outbox.put(parcel, bytes, 2 * known_.size()) ? Status::ok : Status::capacity_exhausted;
}

void RoutedTransport::disconnect(ConnectionId connection) {
  Known* known = find(connection);
  if (connection == k_no_connection || known == nullptr) return;
  *known = {};
  order(ParcelKind::disconnect, connection);
}

void RoutedTransport::trust(ConnectionId connection) {
  Known* known = find(connection);
  if (connection == k_no_connection || known == nullptr) return;
  if (!std::exchange(known->trusted, true)) order(ParcelKind::trust, connection);
}

TransportStats RoutedTransport::stats(ConnectionId connection) const {
  const Known* known = connection == k_no_connection ? nullptr : find(connection);
  return known == nullptr ? TransportStats{} : known->received;
}

PeerIdentity RoutedTransport::identity(ConnectionId connection) const {
  const Known* known = connection == k_no_connection ? nullptr : find(connection);
  return known == nullptr ? PeerIdentity{} : known->identity;
}

void RoutedTransport::reset() {
  inbox.clear();
  outbox.clear();
  order_lost = false;
  std::fill(known_.begin(), known_.end(), Known{});
}

const RoutedTransport::Known* RoutedTransport::find(ConnectionId connection) const {
  const auto found = std::find_if(known_.begin(), known_.end(), [connection](const Known& known) {
    return known.connection == connection;
  });
  return found == known_.end() ? nullptr : &*found;
}

RoutedTransport::Known* RoutedTransport::find(ConnectionId connection) {
  return const_cast<Known*>(std::as_const(*this).find(connection));
}

void RoutedTransport::order(ParcelKind kind, ConnectionId connection) {
  Parcel parcel;
  parcel.kind = kind;
  parcel.connection = connection;
  if (!outbox.put(parcel, {}, 0)) order_lost = true;
}

}  // namespace lockstone::net
