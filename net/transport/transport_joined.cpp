#include <lockstone/assert.h>
#include <lockstone/net/transport_joined.h>

namespace lockstone::net {
namespace {

constexpr ConnectionId k_number_mask = (ConnectionId{1} << k_connection_bits) - 1;

ConnectionId number_of(ConnectionId connection) {
  return connection & k_number_mask;
}

}  // namespace

JoinedTransport::JoinedTransport(std::vector<Transport*> parts) : parts_(std::move(parts)) {
  LKS_CHECK(!parts_.empty() && parts_.size() <= k_most);
}

Transport* JoinedTransport::part_of(ConnectionId connection) const {
  const std::size_t part = connection >> k_connection_bits;
  return part < parts_.size() ? parts_[part] : nullptr;
}

bool JoinedTransport::poll(std::int64_t now_us, TransportEvent& event) {
  for (std::size_t tries = 0; tries < parts_.size(); ++tries) {
    const std::size_t part = next_;
    next_ = (next_ + 1) % parts_.size();
    if (!parts_[part]->poll(now_us, event)) continue;
    LKS_CHECK(event.connection <= k_number_mask);
    event.connection |= static_cast<ConnectionId>(part) << k_connection_bits;
    return true;
  }
  return false;
}

Status JoinedTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  Transport* part = part_of(connection);
  if (part == nullptr) return Status::stale_handle;
  return part->send(number_of(connection), channel, bytes);
}

void JoinedTransport::flush() {
  for (Transport* part : parts_)
    part->flush();
}

void JoinedTransport::disconnect(ConnectionId connection) {
  if (Transport* part = part_of(connection)) part->disconnect(number_of(connection));
}

TransportStats JoinedTransport::stats(ConnectionId connection) const {
  const Transport* part = part_of(connection);
  return part == nullptr ? TransportStats{} : part->stats(number_of(connection));
}

bool JoinedTransport::secure() const {
  for (const Transport* part : parts_) {
    if (!part->secure()) return false;
  }
  return true;
}

PeerIdentity JoinedTransport::identity(ConnectionId connection) const {
  const Transport* part = part_of(connection);
  return part == nullptr ? PeerIdentity{} : part->identity(number_of(connection));
}

void JoinedTransport::trust(ConnectionId connection) {
  if (Transport* part = part_of(connection)) part->trust(number_of(connection));
}

void JoinedTransport::protect(ConnectionId connection, const DatagramKeys& keys,
                              bool peer_has_them) {
  if (Transport* part = part_of(connection))
    part->protect(number_of(connection), keys, peer_has_them);
}

}  // namespace lockstone::net
