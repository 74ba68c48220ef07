#include "net/security/packet_seal.h"

#include <algorithm>
#include <string_view>

namespace lockstone::net {
namespace {

constexpr std::string_view k_client_domain = "lockstone client 1";
constexpr std::string_view k_server_domain = "lockstone server 1";
constexpr std::string_view k_client_datagram_domain = "lockstone client datagrams 1";
constexpr std::string_view k_server_datagram_domain = "lockstone server datagrams 1";

crypto::PacketNonce nonce_of(Channel channel, std::uint64_t counter) {
  crypto::PacketNonce nonce{};
  ByteWriter writer(nonce);
  writer.put(static_cast<std::uint32_t>(channel));
  writer.put(counter);
  return nonce;
}

bool begins_with(ByteView packet, SecureKind kind) {
  return !packet.empty() && packet[0] == static_cast<std::byte>(kind);
}

}  // namespace

void encode_hello(const SecureHello& hello, std::span<std::byte> out) {
  ByteWriter writer(out);
  writer.put(SecureKind::hello);
  writer.put(k_secure_version);
  writer.put(hello.token.match);
  writer.put(hello.token.expires_unix_s);
  writer.put_bytes(hello.token.nonce);
  writer.put_bytes(hello.token.sealed);
  writer.put_bytes(hello.half.bytes);
  LKS_CHECK(writer.ok() && writer.size() == k_hello_bytes);
}

Status decode_hello(ByteView packet, SecureHello& hello) {
  if (!begins_with(packet, SecureKind::hello)) return Status::malformed;
  ByteReader reader(packet.subspan(1));
  const auto version = reader.get<std::uint16_t>();
  if (!reader.ok()) return Status::truncated;
  if (version != k_secure_version) return Status::unsupported_version;
  if (packet.size() != k_hello_bytes) return Status::malformed;
  hello.token.match = reader.get<std::uint64_t>();
  hello.token.expires_unix_s = reader.get<std::uint64_t>();
  const ByteView nonce = reader.get_bytes(k_token_nonce_bytes);
  std::copy(nonce.begin(), nonce.end(), hello.token.nonce.begin());
  hello.token.sealed = reader.get_bytes(k_token_sealed_bytes);
  const ByteView half = reader.get_bytes(k_key_bytes);
  std::copy(half.begin(), half.end(), hello.half.bytes.begin());
  return Status::ok;
}

void encode_refusal(RefuseReason reason, std::span<std::byte> out) {
  ByteWriter writer(out);
  writer.put(SecureKind::refusal);
  writer.put(reason);
  LKS_CHECK(writer.ok() && writer.size() == k_refusal_bytes);
}

Status decode_refusal(ByteView packet, RefuseReason& reason) {
  if (!begins_with(packet, SecureKind::refusal)) return Status::malformed;
  if (packet.size() != k_refusal_bytes) return Status::malformed;
  const auto value = std::to_integer<std::uint8_t>(packet[1]);
  if (value == 0 || value > static_cast<std::uint8_t>(k_last_refuse_reason)) {
    return Status::malformed;
  }
  reason = static_cast<RefuseReason>(value);
  return Status::ok;
}

ConnectionKeys derive_keys(const Agreement& agreement) {
  const auto derive = [&agreement](const Key& key, std::string_view domain) {
    return crypto::derive(key, {std::as_bytes(std::span<const char>(domain.data(), domain.size())),
                                agreement.shared.bytes, agreement.hello, agreement.challenge});
  };
  const auto derive_short = [&derive](const Key& key, std::string_view domain) {
    Key whole = derive(key, domain);
    LinkKey first;
    std::copy_n(whole.bytes.begin(), first.bytes.size(), first.bytes.begin());
    crypto::wipe(whole.bytes);
    return first;
  };
  return {derive(agreement.client_token_key, k_client_domain),
          derive(agreement.server_token_key, k_server_domain),
          derive_short(agreement.client_token_key, k_client_datagram_domain),
          derive_short(agreement.server_token_key, k_server_datagram_domain)};
}

void PacketSealer::prove(std::span<std::byte> tag) {
  crypto::seal_packet(key_, nonce_of(Channel::reliable, reliable_next_++), {}, tag);
}

std::size_t PacketSealer::seal(Channel channel, ByteView plain, std::span<std::byte> out) {
  const bool reliable = channel == Channel::reliable;
  const std::uint64_t counter = reliable ? reliable_next_ : unreliable_next_++;
  ByteWriter writer(out);
  writer.put(reliable ? SecureKind::reliable : SecureKind::unreliable);
  if (!reliable) writer.put(static_cast<std::uint32_t>(counter & 0xffffffff));
  const std::size_t bytes = writer.size() + plain.size() + crypto::k_tag_bytes;
  LKS_CHECK(bytes <= out.size());
  crypto::seal_packet(key_, nonce_of(channel, counter), plain,
                      out.first(bytes).subspan(writer.size()));
  return bytes;
}

bool PacketOpener::check_proof(ByteView tag) {
  if (tag.size() != crypto::k_tag_bytes) return false;
  return crypto::open_packet(key_, nonce_of(Channel::reliable, reliable_next_++), tag, {});
}

PacketOpener::Outcome PacketOpener::open(Channel channel, ByteView packet, std::span<std::byte> out,
                                         std::size_t& plain_bytes) {
  const bool reliable = channel == Channel::reliable;
  const SecureKind kind = reliable ? SecureKind::reliable : SecureKind::unreliable;
  const std::size_t header = reliable ? k_reliable_header_bytes : k_unreliable_header_bytes;
  if (!begins_with(packet, kind) || packet.size() < header + crypto::k_tag_bytes) {
    return Outcome::forged;
  }
  plain_bytes = packet.size() - header - crypto::k_tag_bytes;
  const std::span<std::byte> plain = out.first(plain_bytes);
  return reliable ? open_reliable(packet, plain) : open_unreliable(packet, plain);
}

PacketOpener::Outcome PacketOpener::open_reliable(ByteView packet, std::span<std::byte> plain) {
  const crypto::PacketNonce nonce = nonce_of(Channel::reliable, reliable_next_);
  const ByteView sealed = packet.subspan(k_reliable_header_bytes);
  if (!crypto::open_packet(key_, nonce, sealed, plain)) return Outcome::forged;
  ++reliable_next_;
  return Outcome::ok;
}

PacketOpener::Outcome PacketOpener::open_unreliable(ByteView packet, std::span<std::byte> plain) {
  ByteReader reader(packet.subspan(1));
  const std::uint64_t counter = window_.expand(reader.get<std::uint32_t>());
  if (!window_.accepts(counter)) return Outcome::replayed;
  const ByteView sealed = packet.subspan(k_unreliable_header_bytes);
  if (!crypto::open_packet(key_, nonce_of(Channel::unreliable, counter), sealed, plain)) {
    return Outcome::forged;
  }
  window_.mark(counter);
  return Outcome::ok;
}

}  // namespace lockstone::net
