#include "net/security/secure_server_handshake.h"

#include <algorithm>
#include <array>

#include <lockstone/net/wire.h>

namespace lockstone::net {
namespace {

std::uint64_t unix_seconds(const SecureServerOptions& options, std::int64_t now_us) {
  const std::int64_t unix_us = options.unix_us_at_zero + now_us;
  return unix_us < 0 ? 0 : static_cast<std::uint64_t>(unix_us / 1'000'000);
}

PeerIdentity identity_of(const SealedGrant& grant) {
  return {true, grant.grant.match, grant.grant.player, grant.grant.slot};
}

// A session without encryption says so in its own words.
bool is_plain_hello(ByteView packet) {
  Hello hello;
  return decode(packet, hello) == Status::ok;
}

}  // namespace

bool SecureServerHandshake::on_hello(SecureLink& link, ByteView packet, TransportEvent& event) {
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
void SecureServerHandshake::end_older_handshake(const SealedGrant& grant) {
  for (SecureLink& link : data_.links.all()) {
    if (link.stage != SecureStage::proving || link.identity != identity_of(grant)) continue;
    TransportEvent unheard;
    static_cast<void>(data_.links.close(link, RefuseReason::replaced, unheard));
    ++data_.counters.handshakes_replaced;
  }
}

bool SecureServerHandshake::hosts(std::uint64_t match) const {
  return options_.matches != nullptr ? options_.matches->contains(match) : match == options_.match;
}

RefuseReason SecureServerHandshake::judge(const SecureHello& hello, SealedGrant& grant) const {
  if (!hosts(hello.token.match)) return RefuseReason::wrong_match;
  if (open_sealed(options_.backend_key, hello.token, grant) != Status::ok) {
    return RefuseReason::token_refused;
  }
  if (hello.token.expires_unix_s <= unix_seconds(options_, data_.now_us)) {
    return RefuseReason::token_expired;
  }
  const ServerList& own = options_.own_addresses;
  if (own.count == 0 || grant.grant.servers.count == 0) return RefuseReason::none;
  const bool meant = std::any_of(
      own.entries.begin(), own.entries.begin() + own.count,
      [&grant](const ServerAddress& address) { return grant.grant.servers.contains(address); });
  return meant ? RefuseReason::none : RefuseReason::wrong_server;
}

bool SecureServerHandshake::challenge(SecureLink& link, const SecureHello& hello,
                                      const SealedGrant& grant, ByteView packet,
                                      TransportEvent& event) {
  Key secret = make_key(data_.secrets);
  const Key half = crypto::public_half(secret);
  Key shared;
  const bool agreed = crypto::agree(secret, hello.half, shared);
  crypto::wipe(secret.bytes);
  if (!agreed) return refuse(link, RefuseReason::token_refused, event);
  const ConnectionKeys keys =
      derive_keys({grant.client_key, grant.server_key, shared, packet, half.bytes});
  link.sealer = PacketSealer(keys.server);
  link.opener = PacketOpener(keys.client);
  data_.carrier.protect(link.connection, {keys.server_datagrams, keys.client_datagrams}, false);
  link.identity = identity_of(grant);
  link.stage = SecureStage::proving;
  std::array<std::byte, k_challenge_bytes> answer{};
  ByteWriter writer(answer);
  writer.put(SecureKind::challenge);
  writer.put_bytes(half.bytes);
  link.sealer.prove(std::span(answer).last(crypto::k_tag_bytes));
  if (!data_.links.send_plain(link, answer))
    static_cast<void>(data_.links.close(link, RefuseReason::none, event));
  return false;
}

bool SecureServerHandshake::on_confirm(SecureLink& link, ByteView packet, TransportEvent& event) {
  const bool proven = packet.size() == k_confirm_bytes &&
                      packet[0] == static_cast<std::byte>(SecureKind::confirm) &&
                      link.opener.check_proof(packet.subspan(1));
  if (!proven) return refuse(link, RefuseReason::token_refused, event);
  if (!entries_.take(link.identity, data_.now_us)) {
    // The connection ends without a reason: an honest player calls again, after a longer pause.
    ++data_.counters.handshakes_limited;
    static_cast<void>(data_.links.close(link, RefuseReason::none, event));
    return false;
  }
  ++data_.counters.handshakes_completed;
  data_.carrier.trust(link.connection);
  for (SecureLink& other : data_.links.all()) {
    const bool same =
        &other != &link && other.stage == SecureStage::open && other.identity == link.identity;
    if (!same) continue;
    // There is at most one: the player came back before the old connection was found dead.
    static_cast<void>(SecureLinks::open(link, event));
    pending_ = event;
    return data_.links.close(other, RefuseReason::replaced, event);
  }
  return SecureLinks::open(link, event);
}

// A server's no. Its own session never hears of such a connection.
bool SecureServerHandshake::refuse(SecureLink& link, RefuseReason reason, TransportEvent& event) {
  ++data_.counters.handshakes_refused;
  std::array<std::byte, 64> out{};
  std::size_t size = k_refusal_bytes;
  if (reason == RefuseReason::insecure_not_allowed) {
    size = encode(Refuse{reason, RefuseField::insecure, 0, 1}, out);
  } else {
    encode_refusal(reason, out);
  }
  static_cast<void>(data_.links.send_plain(link, ByteView(out).first(size)));
  static_cast<void>(data_.links.close(link, reason, event));
  return false;
}

bool SecureServerHandshake::take_pending(TransportEvent& event) {
  if (!pending_) return false;
  event = *pending_;
  pending_.reset();
  return true;
}

void SecureServerHandshake::expire() {
  for (SecureLink& link : data_.links.all()) {
    if (link.stage == SecureStage::unused || link.stage == SecureStage::open) continue;
    if (data_.now_us - link.since_us <= options_.handshake_us) continue;
    ++data_.counters.handshakes_timed_out;
    TransportEvent unheard;
    static_cast<void>(data_.links.close(link, RefuseReason::handshake_timeout, unheard));
  }
}

}  // namespace lockstone::net
