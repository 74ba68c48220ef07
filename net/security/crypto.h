// The only door to libsodium. Without it (LOCKSTONE_WITH_SODIUM off) crypto_available is false, and
// nothing else here may be called.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>

#include <lockstone/bytes.h>
#include <lockstone/net/keys.h>

namespace lockstone::net::crypto {

inline constexpr std::size_t k_tag_bytes = 16;          ///< added by sealing
inline constexpr std::size_t k_token_nonce_bytes = 24;  ///< of XChaCha20: random ones never meet
inline constexpr std::size_t k_packet_nonce_bytes = 12;

using TokenNonce = std::array<std::byte, k_token_nonce_bytes>;
using PacketNonce = std::array<std::byte, k_packet_nonce_bytes>;

/// True once the library is started; safe to call again.
[[nodiscard]] bool crypto_available();

/// XChaCha20-Poly1305. `out` has k_tag_bytes more than `plain`.
void seal_token(const Key& key, const TokenNonce& nonce, ByteView context, ByteView plain,
                std::span<std::byte> out);
/// False, and nothing usable in `out`, if a bit was changed or the key is another. `out` has
/// k_tag_bytes less than `sealed`.
[[nodiscard]] bool open_token(const Key& key, const TokenNonce& nonce, ByteView context,
                              ByteView sealed, std::span<std::byte> out);

/// ChaCha20-Poly1305 (RFC 8439), with the same lengths. A nonce must never come twice with a key.
void seal_packet(const Key& key, const PacketNonce& nonce, ByteView plain,
                 std::span<std::byte> out);
[[nodiscard]] bool open_packet(const Key& key, const PacketNonce& nonce, ByteView sealed,
                               std::span<std::byte> out);

/// BLAKE2b-256 of the parts, one after the other, under a key.
[[nodiscard]] Key derive(const Key& key, std::initializer_list<ByteView> parts);

/// X25519 (RFC 7748): the public half of a secret, and the secret that two peers share.
[[nodiscard]] Key public_half(const Key& secret);
/// False if the other half is one of the few that give everybody the same.
[[nodiscard]] bool agree(const Key& secret, const Key& other_half, Key& shared);

/// SipHash-2-4.
[[nodiscard]] std::uint64_t short_hash(const LinkKey& key, ByteView bytes);

/// Overwrites memory in a way that no optimiser removes.
void wipe(std::span<std::byte> bytes);

}  // namespace lockstone::net::crypto
