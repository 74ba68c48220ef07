// The primitives for WebAssembly, where there is no libsodium.
#include <algorithm>

#include <unistd.h>

#include <lockstone/assert.h>

#include "net/security/crypto.h"
#include "net/security/portable/chacha20_poly1305.h"
#include "net/security/portable/hashes.h"
#include "net/security/portable/x25519.h"

namespace lockstone::net {

// The system gives at most 256 bytes at once.
void SystemRandom::fill(std::span<std::byte> out) {
  constexpr std::size_t k_most = 256;
  while (!out.empty()) {
    const std::size_t size = std::min(k_most, out.size());
    if (getentropy(out.data(), size) != 0) misused("net::SystemRandom: there is no random source");
    out = out.subspan(size);
  }
}

namespace crypto {

bool crypto_available() {
  return true;
}

void seal_token(const Key& key, const TokenNonce& nonce, ByteView context, ByteView plain,
                std::span<std::byte> out) {
  LKS_CHECK(out.size() == plain.size() + k_tag_bytes);
  portable::seal(key, nonce, context, plain, out);
}

bool open_token(const Key& key, const TokenNonce& nonce, ByteView context, ByteView sealed,
                std::span<std::byte> out) {
  LKS_CHECK(sealed.size() == out.size() + k_tag_bytes);
  return portable::open(key, nonce, context, sealed, out);
}

void seal_packet(const Key& key, const PacketNonce& nonce, ByteView plain,
                 std::span<std::byte> out) {
  LKS_CHECK(out.size() == plain.size() + k_tag_bytes);
  portable::seal(key, nonce, {}, plain, out);
}

bool open_packet(const Key& key, const PacketNonce& nonce, ByteView sealed,
                 std::span<std::byte> out) {
  LKS_CHECK(sealed.size() == out.size() + k_tag_bytes);
  return portable::open(key, nonce, {}, sealed, out);
}

Key derive(const Key& key, std::initializer_list<ByteView> parts) {
  return portable::blake2b(key, parts);
}

Key public_half(const Key& secret) {
  return portable::x25519(secret, portable::x25519_base());
}

bool agree(const Key& secret, const Key& other_half, Key& shared) {
  shared = portable::x25519(secret, other_half);
  return shared != Key{};
}

std::uint64_t short_hash(const LinkKey& key, ByteView bytes) {
  return portable::siphash(key, bytes);
}

void wipe(std::span<std::byte> bytes) {
  volatile std::byte* begin = bytes.data();
  for (std::size_t i = 0; i < bytes.size(); ++i)
    begin[i] = std::byte{0};
}

}  // namespace crypto
}  // namespace lockstone::net
