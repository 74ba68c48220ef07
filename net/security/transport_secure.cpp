#include <algorithm>

#include <lockstone/assert.h>

#include "net/security/transport_secure_impl.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_max_connections = 1024;
constexpr std::size_t k_max_client_connections = 8;

}  // namespace

SecureTransport::Impl::Impl(Transport& wrapped, RandomSource& random_source,
                            std::size_t max_connections)
    : carrier(wrapped),
      secrets(random_source),
      links(max_connections),
      entries(max_connections),
      sealed(k_max_reliable_bytes + k_carrier_reserve_bytes),
      opened(k_max_reliable_bytes + k_carrier_reserve_bytes) {}

Result<std::unique_ptr<SecureTransport>> SecureTransport::serve(Transport& carrier,
                                                                const SecureServerOptions& options,
                                                                RandomSource& random) {
  if (!security_available()) return Status::incompatible;
  const bool in_range = options.max_connections >= 1 &&
                        options.max_connections <= k_max_connections && options.handshake_us > 0;
  if (!in_range) return Status::invalid_argument;
  auto impl = std::make_unique<Impl>(carrier, random, options.max_connections);
  impl->server = options;
  return std::unique_ptr<SecureTransport>(new SecureTransport(std::move(impl)));
}

Result<std::unique_ptr<SecureTransport>> SecureTransport::join(Transport& carrier,
                                                               const ConnectToken& token,
                                                               RandomSource& random) {
  if (!security_available()) return Status::incompatible;
  auto impl = std::make_unique<Impl>(carrier, random, k_max_client_connections);
  impl->token = token;
  return std::unique_ptr<SecureTransport>(new SecureTransport(std::move(impl)));
}

SecureTransport::SecureTransport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

SecureTransport::~SecureTransport() {
  for (Impl::Link& link : impl_->links)
    impl_->release(link);
}

bool SecureTransport::poll(std::int64_t now_us, TransportEvent& event) {
  Impl& impl = *impl_;
  impl.now_us = now_us;
  if (impl.pending) {
    event = *impl.pending;
    impl.pending.reset();
    return true;
  }
  TransportEvent source;
  while (impl.carrier.poll(now_us, source)) {
    if (impl.translate(source, event)) return true;
  }
  return impl.expire(event);
}

Status SecureTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  Impl::Link* link = impl_->find(connection);
  if (link == nullptr || link->stage != Impl::Stage::open) return Status::stale_handle;
  const bool reliable = channel == Channel::reliable;
  const std::size_t limit = reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
  if (bytes.empty() || bytes.size() > limit) return Status::invalid_argument;
  const std::size_t size = link->sealer.seal(channel, bytes, impl_->sealed);
  const Status status =
      impl_->carrier.send(connection, channel, ByteView(impl_->sealed).first(size));
  // A packet that the carrier refused never left this machine, so its counter may be used again.
  if (reliable && status == Status::ok) link->sealer.reliable_sent();
  return status;
}

void SecureTransport::flush() {
  impl_->carrier.flush();
}

void SecureTransport::disconnect(ConnectionId connection) {
  if (Impl::Link* link = impl_->find(connection)) impl_->release(*link);
  impl_->carrier.disconnect(connection);
}

TransportStats SecureTransport::stats(ConnectionId connection) const {
  return impl_->carrier.stats(connection);
}

PeerIdentity SecureTransport::identity(ConnectionId connection) const {
  const Impl::Link* link = impl_->find(connection);
  return link == nullptr ? PeerIdentity{} : link->identity;
}

void SecureTransport::trust(ConnectionId connection) {
  impl_->carrier.trust(connection);
}

const SecurityCounters& SecureTransport::counters() const {
  return impl_->counters;
}

SecureTransport::Impl::Link* SecureTransport::Impl::find(ConnectionId connection) {
  const auto found = std::find_if(links.begin(), links.end(), [connection](const Link& link) {
    return link.stage != Stage::unused && link.connection == connection;
  });
  return found == links.end() ? nullptr : &*found;
}

bool SecureTransport::Impl::translate(const TransportEvent& source, TransportEvent& event) {
  if (source.kind == TransportEventKind::connected) return accept(source.connection, event);
  Link* link = find(source.connection);
  if (link == nullptr) {
    // A client whose call was refused before there was a connection.
    event = source;
    return !server && source.kind == TransportEventKind::disconnected;
  }
  if (source.kind == TransportEventKind::received) return receive(*link, source, event);
  // A server's session hears of those alone who came in.
  const bool known = link->stage == Stage::open || !server;
  release(*link);
  event = source;
  return known;
}

bool SecureTransport::Impl::receive(Link& link, const TransportEvent& source,
                                    TransportEvent& event) {
  if (link.stage != Stage::open) {
    // An unreliable packet may have overtaken the handshake, which is reliable.
    if (source.channel == Channel::unreliable) return false;
    if (!server) return on_challenge(link, source.bytes, event);
    return link.stage == Stage::greeting ? on_hello(link, source.bytes, event)
                                         : on_confirm(link, source.bytes, event);
  }
  std::size_t size = 0;
  if (source.bytes.size() > opened.size()) return false;
  switch (link.opener.open(source.channel, source.bytes, opened, size)) {
    case PacketOpener::Outcome::ok:
      event = source;
      event.bytes = ByteView(opened).first(size);
      return true;
    case PacketOpener::Outcome::replayed:
      ++counters.packets_replayed;
      return false;
    case PacketOpener::Outcome::forged:
      break;
  }
  ++counters.packets_forged;
  // An unreliable one may come from anybody. The reliable stream cannot go on without this packet.
  if (source.channel == Channel::unreliable) return false;
  return close(link, RefuseReason::stream_damaged, event);
}

// Handshakes that take too long, one a call.
bool SecureTransport::Impl::expire(TransportEvent& event) {
  if (!server) return false;  // the session of a client counts that itself
  for (Link& link : links) {
    if (link.stage == Stage::unused || link.stage == Stage::open) continue;
    if (now_us - link.since_us <= server->handshake_us) continue;
    ++counters.handshakes_timed_out;
    static_cast<void>(close(link, RefuseReason::handshake_timeout, event));
  }
  return false;
}

// Ends a connection from this side and makes the event of it.
bool SecureTransport::Impl::close(Link& link, RefuseReason reason, TransportEvent& event) {
  event = {};
  event.kind = TransportEventKind::disconnected;
  event.connection = link.connection;
  event.reason = reason;
  release(link);
  carrier.disconnect(event.connection);
  return true;
}

void SecureTransport::Impl::release(Link& link) {
  crypto::wipe(std::as_writable_bytes(std::span(&link.sealer, 1)));
  crypto::wipe(std::as_writable_bytes(std::span(&link.opener, 1)));
  crypto::wipe(link.secret.bytes);
  link = {};
}

}  // namespace lockstone::net
