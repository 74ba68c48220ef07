#include <algorithm>

#include "net/security/transport_secure_impl.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_max_client_connections = 8;

}  // namespace

SecureTransport::Impl::Impl(Transport& carrier, RandomSource& secrets, std::size_t max_connections)
    : data{carrier, secrets, SecureLinks(carrier, max_connections), {}},
      sealed(k_max_reliable_bytes + k_carrier_reserve_bytes),
      opened(k_max_reliable_bytes + k_carrier_reserve_bytes) {}

Result<std::unique_ptr<SecureTransport>> SecureTransport::serve(Transport& carrier,
                                                                const SecureServerOptions& options,
                                                                RandomSource& random) {
  if (!security_available()) return Status::incompatible;
  const bool in_range = options.max_connections >= 1 &&
                        options.max_connections <= k_max_socket_connections &&
                        options.handshake_us > 0;
  if (!in_range) return Status::invalid_argument;
  auto impl = std::make_unique<Impl>(carrier, random, options.max_connections);
  impl->server.emplace(impl->data, options);
  return std::unique_ptr<SecureTransport>(new SecureTransport(std::move(impl)));
}

Result<std::unique_ptr<SecureTransport>> SecureTransport::join(Transport& carrier,
                                                               const ConnectToken& token,
                                                               RandomSource& random) {
  if (!security_available()) return Status::incompatible;
  auto impl = std::make_unique<Impl>(carrier, random, k_max_client_connections);
  impl->client.emplace(impl->data, token);
  return std::unique_ptr<SecureTransport>(new SecureTransport(std::move(impl)));
}

SecureTransport::SecureTransport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

SecureTransport::~SecureTransport() = default;

bool SecureTransport::poll(std::int64_t now_us, TransportEvent& event) {
  Impl& impl = *impl_;
  impl.data.now_us = now_us;
  if (impl.server && impl.server->take_pending(event)) return true;
  TransportEvent source;
  while (impl.data.carrier.poll(now_us, source)) {
    if (impl.translate(source, event)) return true;
  }
  if (impl.server) impl.server->expire();  // the session of a client counts that itself
  return false;
}

Status SecureTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  SecureLink* link = impl_->data.links.find(connection);
  if (link == nullptr || link->stage != SecureStage::open) return Status::stale_handle;
  const bool reliable = channel == Channel::reliable;
  const std::size_t limit = reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
  if (bytes.empty() || bytes.size() > limit) return Status::invalid_argument;
  const std::size_t size = link->sealer.seal(channel, bytes, impl_->sealed);
  const Status status =
      impl_->data.carrier.send(connection, channel, ByteView(impl_->sealed).first(size));
  // A packet that the carrier refused never left this machine, so its counter may be used again.
  if (reliable && status == Status::ok) link->sealer.reliable_sent();
  return status;
}

void SecureTransport::flush() {
  impl_->data.carrier.flush();
}

void SecureTransport::disconnect(ConnectionId connection) {
  if (SecureLink* link = impl_->data.links.find(connection)) impl_->data.links.release(*link);
  impl_->data.carrier.disconnect(connection);
}

TransportStats SecureTransport::stats(ConnectionId connection) const {
  return impl_->data.carrier.stats(connection);
}

PeerIdentity SecureTransport::identity(ConnectionId connection) const {
  const SecureLink* link = impl_->data.links.find(connection);
  return link == nullptr ? PeerIdentity{} : link->identity;
}

void SecureTransport::trust(ConnectionId connection) {
  impl_->data.carrier.trust(connection);
}

const SecurityCounters& SecureTransport::counters() const {
  return impl_->data.counters;
}

bool SecureTransport::Impl::translate(const TransportEvent& source, TransportEvent& event) {
  if (source.kind == TransportEventKind::connected) return accept(source.connection, event);
  SecureLink* link = data.links.find(source.connection);
  if (link == nullptr) {
    // A client whose call was refused before there was a connection.
    event = source;
    return !server && source.kind == TransportEventKind::disconnected;
  }
  if (source.kind == TransportEventKind::received) return receive(*link, source, event);
  // A server's session hears of those alone who came in.
  const bool known = link->stage == SecureStage::open || !server;
  data.links.release(*link);
  event = source;
  return known;
}

bool SecureTransport::Impl::receive(SecureLink& link, const TransportEvent& source,
                                    TransportEvent& event) {
  if (link.stage != SecureStage::open) {
    // An unreliable packet may have overtaken the handshake, which is reliable.
    if (source.channel == Channel::unreliable) return false;
    if (client) return client->on_challenge(link, source.bytes, event);
    return link.stage == SecureStage::greeting ? server->on_hello(link, source.bytes, event)
                                               : server->on_confirm(link, source.bytes, event);
  }
  std::size_t size = 0;
  if (source.bytes.size() > opened.size()) return false;
  switch (link.opener.open(source.channel, source.bytes, opened, size)) {
    case PacketOpener::Outcome::ok:
      event = source;
      event.bytes = ByteView(opened).first(size);
      return true;
    case PacketOpener::Outcome::replayed:
      ++data.counters.packets_replayed;
      return false;
    case PacketOpener::Outcome::forged:
      break;
  }
  ++data.counters.packets_forged;
  // An unreliable one may come from anybody. The reliable stream cannot go on without this packet.
  if (source.channel == Channel::unreliable) return false;
  return data.links.close(link, RefuseReason::stream_damaged, event);
}

bool SecureTransport::Impl::accept(ConnectionId connection, TransportEvent& event) {
  SecureLink* link = data.links.add(connection, data.now_us);
  if (link == nullptr) {
    data.carrier.disconnect(connection);
    return false;
  }
  return client && client->greet(*link, event);
}

}  // namespace lockstone::net
