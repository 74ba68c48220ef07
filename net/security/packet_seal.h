// The packets of an encrypted connection, after docs/reference/wire-format.md, "Secure layer".
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/net/transport.h>

#include "net/security/crypto.h"
#include "net/security/replay_window.h"
#include "net/security/token_seal.h"

namespace lockstone::net {

/// 2: datagrams are sealed under keys of the connection from the confirm on.
inline constexpr std::uint16_t k_secure_version = 2;

/// The first byte of a packet; no session message begins with one of them.
enum class SecureKind : std::uint8_t {
  hello = 0xc1,
  challenge = 0xc2,
  confirm = 0xc3,
  reliable = 0xc4,
  unreliable = 0xc5,
  refusal = 0xc6,
};

inline constexpr std::size_t k_hello_bytes =
    1 + 2 + 8 + 8 + k_token_nonce_bytes + k_token_sealed_bytes + k_key_bytes;
inline constexpr std::size_t k_challenge_bytes = 1 + k_key_bytes + crypto::k_tag_bytes;
inline constexpr std::size_t k_confirm_bytes = 1 + crypto::k_tag_bytes;
inline constexpr std::size_t k_refusal_bytes = 2;
inline constexpr std::size_t k_reliable_header_bytes = 1;
inline constexpr std::size_t k_unreliable_header_bytes = 1 + 4;
static_assert(k_unreliable_header_bytes + crypto::k_tag_bytes <= k_carrier_reserve_bytes);

/// Client: the token's sealed part, and half of a key agreement.
struct SecureHello {
  ShownToken token;
  Key half;
};

/// Writes k_hello_bytes.
void encode_hello(const SecureHello& hello, std::span<std::byte> out);
/// truncated, malformed, or unsupported_version. `hello.token.sealed` points into the packet.
[[nodiscard]] Status decode_hello(ByteView packet, SecureHello& hello);

/// Writes k_refusal_bytes.
void encode_refusal(RefuseReason reason, std::span<std::byte> out);
[[nodiscard]] Status decode_refusal(ByteView packet, RefuseReason& reason);

/// The keys of one connection: those of the token, made fresh by both sides' halves.
struct ConnectionKeys {
  Key client;  ///< of packets from the client
  Key server;
  LinkKey client_datagrams;  ///< of the seals around the client's datagrams
  LinkKey server_datagrams;
};

/// The data that both sides share after challenge and hello.
struct Agreement {
  Key client_token_key;
  Key server_token_key;
  Key shared;          ///< X25519 of both halves
  ByteView hello;      ///< the packet as sent
  ByteView challenge;  ///< the server's half
};
[[nodiscard]] ConnectionKeys derive_keys(const Agreement& agreement);

/// Seals one direction's packets. No nonce comes twice: each channel counts its own.
class PacketSealer {
 public:
  PacketSealer() = default;
  explicit PacketSealer(const Key& key) : key_(key) {}

  /// Fills `tag` with the proof that the sender has the key: counter 0 of the reliable channel.
  void prove(std::span<std::byte> tag);

  /// Writes a packet of `plain` into `out`, which has room for k_carrier_reserve_bytes more.
  [[nodiscard]] std::size_t seal(Channel channel, ByteView plain, std::span<std::byte> out);

  /// The last sealed reliable packet is on its way. Until then the next one takes its place.
  void reliable_sent() { ++reliable_next_; }

 private:
  Key key_;
  std::uint64_t reliable_next_ = 0;
  std::uint64_t unreliable_next_ = 0;
};

/// Opens the other direction's.
class PacketOpener {
 public:
  enum class Outcome : std::uint8_t { ok, forged, replayed };

  PacketOpener() = default;
  explicit PacketOpener(const Key& key) : key_(key) {}

  [[nodiscard]] bool check_proof(ByteView tag);

  /// The plain bytes of a packet, in `out`, which has as much room as the packet. Anything that is
  /// not a packet of this channel is `forged`.
  [[nodiscard]] Outcome open(Channel channel, ByteView packet, std::span<std::byte> out,
                             std::size_t& plain_bytes);

 private:
  [[nodiscard]] Outcome open_reliable(ByteView packet, std::span<std::byte> plain);
  [[nodiscard]] Outcome open_unreliable(ByteView packet, std::span<std::byte> plain);

  Key key_;
  std::uint64_t reliable_next_ = 0;
  ReplayWindow window_;
};

}  // namespace lockstone::net
