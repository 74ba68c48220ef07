#include "net/security/secure_client_handshake.h"

#include <algorithm>
#include <array>

#include <lockstone/net/wire.h>

namespace lockstone::net {

bool SecureClientHandshake::greet(SecureLink& link, TransportEvent& event) {
  SecureHello hello;
  hello.token = {token_.grant.match, token_.grant.expires_unix_s, token_.nonce, token_.sealed};
  link.secret = make_key(data_.secrets);
  hello.half = crypto::public_half(link.secret);
  encode_hello(hello, link.hello);
  return !data_.links.send_plain(link, link.hello) &&
         data_.links.close(link, RefuseReason::none, event);
}

bool SecureClientHandshake::on_challenge(SecureLink& link, ByteView packet, TransportEvent& event) {
  RefuseReason reason = RefuseReason::none;
  if (decode_refusal(packet, reason) == Status::ok) return data_.links.close(link, reason, event);
  Refuse plain;
  if (decode(packet, plain) == Status::ok) return data_.links.close(link, plain.reason, event);
  const bool fits = packet.size() == k_challenge_bytes &&
                    packet[0] == static_cast<std::byte>(SecureKind::challenge);
  if (!fits) return data_.links.close(link, RefuseReason::token_refused, event);
  const ByteView half = packet.subspan(1, k_key_bytes);
  Key other_half;
  std::copy(half.begin(), half.end(), other_half.bytes.begin());
  Key shared;
  if (!crypto::agree(link.secret, other_half, shared)) {
    return data_.links.close(link, RefuseReason::token_refused, event);
  }
  const ConnectionKeys keys =
      derive_keys({token_.client_key, token_.server_key, shared, link.hello, half});
  crypto::wipe(link.secret.bytes);
  link.sealer = PacketSealer(keys.client);
  link.opener = PacketOpener(keys.server);
  if (!link.opener.check_proof(packet.last(crypto::k_tag_bytes))) {
    return data_.links.close(link, RefuseReason::token_refused, event);
  }
  data_.carrier.protect(link.connection, {keys.client_datagrams, keys.server_datagrams}, true);
  std::array<std::byte, k_confirm_bytes> answer{};
  answer[0] = static_cast<std::byte>(SecureKind::confirm);
  link.sealer.prove(std::span(answer).last(crypto::k_tag_bytes));
  if (!data_.links.send_plain(link, answer))
    return data_.links.close(link, RefuseReason::none, event);
  link.identity = {true, token_.grant.match, token_.grant.player, token_.grant.slot};
  return SecureLinks::open(link, event);
}

}  // namespace lockstone::net
