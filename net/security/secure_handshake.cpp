// Hello, challenge, confirm: after them both sides have proven that they hold the token's keys, and
// share fresh ones. docs/reference/wire-format.md has the bytes, docs/explanation/security.md the
// reasons.
#include <algorithm>

#include <lockstone/net/wire.h>

#include "net/security/transport_secure_impl.h"

namespace lockstone::net {
namespace {

std::uint64_t unix_seconds(const SecureServerOptions& options, std::int64_t now_us) {
  const std::int64_t unix_us = options.unix_us_at_zero + now_us;
  return unix_us < 0 ? 0 : static_cast<std::uint64_t>(unix_us / 1'000'000);
}

// A session without encryption says so in its own words.
bool is_plain_hello(ByteView packet) {
  Hello hello;
  return decode(packet, hello) == Status::ok;
}

}  // namespace

bool SecureTransport::Impl::accept(ConnectionId connection, TransportEvent& event) {
  const auto place = std::find_if(links.begin(), links.end(),
                                  [](const Link& link) { return link.stage == Stage::unused; });
  if (place == links.end()) {
    carrier.disconnect(connection);
    return false;
  }
  place->connection = connection;
  place->stage = Stage::greeting;
  place->since_us = now_us;
  return !server && greet(*place, event);
}

bool SecureTransport::Impl::greet(Link& link, TransportEvent& event) {
  SecureHello hello;
  hello.token = {token.grant.match, token.grant.expires_unix_s, token.nonce, token.sealed};
  link.secret = make_key(secrets);
  hello.half = crypto::public_half(link.secret);
  encode_hello(hello, link.hello);
  return !send_plain(link, link.hello) && close(link, RefuseReason::none, event);
}

bool SecureTransport::Impl::on_hello(Link& link, ByteView packet, TransportEvent& event) {
  SecureHello hello;
  switch (decode_hello(packet, hello)) {
    case Status::ok:
      break;
    case Status::unsupported_version:
      return refuse(link, RefuseReason::protocol_mismatch, event);
    default:
      return refuse(
          link,
          is_plain_hello(packet) ? RefuseReason::insecure_not_allowed : RefuseReason::token_refused,
          event);
  }
  SealedGrant grant;
  const RefuseReason reason = judge(hello, grant);
  if (reason != RefuseReason::none) return refuse(link, reason, event);
  end_older_handshake(grant);
  return challenge(link, hello, grant, packet, event);
}

// A token has one place before its proof, independent of its sender and address.
void SecureTransport::Impl::end_older_handshake(const SealedGrant& grant) {
  for (Link& link : links) {
    const bool same = link.stage == Stage::proving && link.identity.player == grant.grant.player &&
                      link.identity.slot == grant.grant.slot;
    if (!same) continue;
    TransportEvent unheard;
    static_cast<void>(close(link, RefuseReason::replaced, unheard));
    ++counters.handshakes_replaced;
  }
}

RefuseReason SecureTransport::Impl::judge(const SecureHello& hello, SealedGrant& grant) const {
  if (hello.token.match != server->match) return RefuseReason::wrong_match;
  if (open_sealed(server->backend_key, hello.token, grant) != Status::ok) {
    return RefuseReason::token_refused;
  }
  if (hello.token.expires_unix_s <= unix_seconds(*server, now_us)) {
    return RefuseReason::token_expired;
  }
  const ServerList& own = server->own_addresses;
  if (own.count == 0 || grant.grant.servers.count == 0) return RefuseReason::none;
  const bool meant = std::any_of(
      own.entries.begin(), own.entries.begin() + own.count,
      [&grant](const ServerAddress& address) { return grant.grant.servers.contains(address); });
  return meant ? RefuseReason::none : RefuseReason::wrong_server;
}

bool SecureTransport::Impl::challenge(Link& link, const SecureHello& hello,
                                      const SealedGrant& grant, ByteView packet,
                                      TransportEvent& event) {
  Key secret = make_key(secrets);
  const Key half = crypto::public_half(secret);
  Key shared;
  const bool agreed = crypto::agree(secret, hello.half, shared);
  crypto::wipe(secret.bytes);
  if (!agreed) return refuse(link, RefuseReason::token_refused, event);
  const ConnectionKeys keys =
      derive_keys({grant.client_key, grant.server_key, shared, packet, half.bytes});
  link.sealer = PacketSealer(keys.server);
  link.opener = PacketOpener(keys.client);
  carrier.protect(link.connection, {keys.server_datagrams, keys.client_datagrams}, false);
  link.identity = {true, grant.grant.match, grant.grant.player, grant.grant.slot};
  link.stage = Stage::proving;
  std::array<std::byte, k_challenge_bytes> answer{};
  ByteWriter writer(answer);
  writer.put(SecureKind::challenge);
  writer.put_bytes(half.bytes);
  link.sealer.prove(std::span(answer).last(crypto::k_tag_bytes));
  if (!send_plain(link, answer)) static_cast<void>(close(link, RefuseReason::none, event));
  return false;
}

bool SecureTransport::Impl::on_challenge(Link& link, ByteView packet, TransportEvent& event) {
  RefuseReason reason = RefuseReason::none;
  if (decode_refusal(packet, reason) == Status::ok) return close(link, reason, event);
  Refuse plain;
  if (decode(packet, plain) == Status::ok) return close(link, plain.reason, event);
  const bool fits = packet.size() == k_challenge_bytes &&
                    packet[0] == static_cast<std::byte>(SecureKind::challenge);
  if (!fits) return close(link, RefuseReason::token_refused, event);
  const ByteView half = packet.subspan(1, k_key_bytes);
  Key other_half;
  std::copy(half.begin(), half.end(), other_half.bytes.begin());
  Key shared;
  if (!crypto::agree(link.secret, other_half, shared)) {
    return close(link, RefuseReason::token_refused, event);
  }
  const ConnectionKeys keys =
      derive_keys({token.client_key, token.server_key, shared, link.hello, half});
  crypto::wipe(link.secret.bytes);
  link.sealer = PacketSealer(keys.client);
  link.opener = PacketOpener(keys.server);
  if (!link.opener.check_proof(packet.last(crypto::k_tag_bytes))) {
    return close(link, RefuseReason::token_refused, event);
  }
  carrier.protect(link.connection, {keys.client_datagrams, keys.server_datagrams}, true);
  std::array<std::byte, k_confirm_bytes> answer{};
  answer[0] = static_cast<std::byte>(SecureKind::confirm);
  link.sealer.prove(std::span(answer).last(crypto::k_tag_bytes));
  if (!send_plain(link, answer)) return close(link, RefuseReason::none, event);
  link.identity = {true, token.grant.match, token.grant.player, token.grant.slot};
  return open(link, event);
}

bool SecureTransport::Impl::on_confirm(Link& link, ByteView packet, TransportEvent& event) {
  const bool proven = packet.size() == k_confirm_bytes &&
                      packet[0] == static_cast<std::byte>(SecureKind::confirm) &&
                      link.opener.check_proof(packet.subspan(1));
  if (!proven) return refuse(link, RefuseReason::token_refused, event);
  if (!entries.take(link.identity, now_us)) {
    // The connection ends without a reason: an honest player calls again, after a longer pause.
    ++counters.handshakes_limited;
    static_cast<void>(close(link, RefuseReason::none, event));
    return false;
  }
  ++counters.handshakes_completed;
  carrier.trust(link.connection);
  for (Link& other : links) {
    const bool same = &other != &link && other.stage == Stage::open &&
                      other.identity.player == link.identity.player &&
                      other.identity.slot == link.identity.slot;
    if (!same) continue;
    // There is at most one: the player came back before the old connection was found dead.
    static_cast<void>(open(link, event));
    pending = event;
    return close(other, RefuseReason::replaced, event);
  }
  return open(link, event);
}

bool SecureTransport::Impl::open(Link& link, TransportEvent& event) {
  link.stage = Stage::open;
  event = {};
  event.kind = TransportEventKind::connected;
  event.connection = link.connection;
  return true;
}

// A server's no. Its own session never hears of such a connection.
bool SecureTransport::Impl::refuse(Link& link, RefuseReason reason, TransportEvent& event) {
  ++counters.handshakes_refused;
  std::array<std::byte, 64> out{};
  std::size_t size = k_refusal_bytes;
  if (reason == RefuseReason::insecure_not_allowed) {
    size = encode(Refuse{reason, RefuseField::insecure, 0, 1}, out);
  } else {
    encode_refusal(reason, out);
  }
  static_cast<void>(send_plain(link, ByteView(out).first(size)));
  static_cast<void>(close(link, reason, event));
  return false;
}

bool SecureTransport::Impl::send_plain(const Link& link, ByteView bytes) {
  return carrier.send(link.connection, Channel::reliable, bytes) == Status::ok;
}

}  // namespace lockstone::net
