// The primitives for WebAssembly: its host gives them, from a library in JavaScript
// (tools/web/src/crypto.ts). Their names are those of the module `lockstone_crypto`.
#include <algorithm>
#include <vector>

#include <unistd.h>

#include <lockstone/assert.h>

#include "net/security/crypto.h"

#define LOCKSTONE_HOST(name) \
  __attribute__((import_module("lockstone_crypto"), import_name(#name))) extern

extern "C" {

/// Sizes of nonces choose between ChaCha20 (12 bytes) and XChaCha20 (24).
LOCKSTONE_HOST(seal)
void lockstone_crypto_seal(const std::byte* key, const std::byte* nonce, std::size_t nonce_size,
                           const std::byte* context, std::size_t context_size,
                           const std::byte* plain, std::size_t plain_size, std::byte* out);
/// Nonzero where the seal is right.
LOCKSTONE_HOST(open)
int lockstone_crypto_open(const std::byte* key, const std::byte* nonce, std::size_t nonce_size,
                          const std::byte* context, std::size_t context_size,
                          const std::byte* sealed, std::size_t sealed_size, std::byte* out);
LOCKSTONE_HOST(keyed_hash)
void lockstone_crypto_keyed_hash(const std::byte* key, const std::byte* bytes, std::size_t size,
                                 std::byte* out);
LOCKSTONE_HOST(public_half)
void lockstone_crypto_public_half(const std::byte* secret, std::byte* out);
/// Nonzero unless the other half gives everybody the same.
LOCKSTONE_HOST(agree)
int lockstone_crypto_agree(const std::byte* secret, const std::byte* other_half, std::byte* out);

}  // extern "C"

#undef LOCKSTONE_HOST

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
namespace {

void seal(const Key& key, ByteView nonce, ByteView context, ByteView plain,
          std::span<std::byte> out) {
  LKS_CHECK(out.size() == plain.size() + k_tag_bytes);
  lockstone_crypto_seal(key.bytes.data(), nonce.data(), nonce.size(), context.data(),
                        context.size(), plain.data(), plain.size(), out.data());
}

bool open(const Key& key, ByteView nonce, ByteView context, ByteView sealed,
          std::span<std::byte> out) {
  LKS_CHECK(sealed.size() == out.size() + k_tag_bytes);
  return lockstone_crypto_open(key.bytes.data(), nonce.data(), nonce.size(), context.data(),
                               context.size(), sealed.data(), sealed.size(), out.data()) != 0;
}

}  // namespace

bool crypto_available() {
  return true;
}

void seal_token(const Key& key, const TokenNonce& nonce, ByteView context, ByteView plain,
                std::span<std::byte> out) {
  seal(key, nonce, context, plain, out);
}

bool open_token(const Key& key, const TokenNonce& nonce, ByteView context, ByteView sealed,
                std::span<std::byte> out) {
  return open(key, nonce, context, sealed, out);
}

void seal_packet(const Key& key, const PacketNonce& nonce, ByteView plain,
                 std::span<std::byte> out) {
  seal(key, nonce, {}, plain, out);
}

bool open_packet(const Key& key, const PacketNonce& nonce, ByteView sealed,
                 std::span<std::byte> out) {
  return open(key, nonce, {}, sealed, out);
}

Key derive(const Key& key, std::initializer_list<ByteView> parts) {
  std::vector<std::byte> all;
  for (const ByteView part : parts)
    all.insert(all.end(), part.begin(), part.end());
  Key derived;
  lockstone_crypto_keyed_hash(key.bytes.data(), all.data(), all.size(), derived.bytes.data());
  wipe(all);
  return derived;
}

Key public_half(const Key& secret) {
  Key half;
  lockstone_crypto_public_half(secret.bytes.data(), half.bytes.data());
  return half;
}

bool agree(const Key& secret, const Key& other_half, Key& shared) {
  return lockstone_crypto_agree(secret.bytes.data(), other_half.bytes.data(),
                                shared.bytes.data()) != 0;
}

// For datagrams of ENet, which browsers do not send.
std::uint64_t short_hash(const LinkKey&, ByteView) {
  misused("net: the host has no short hash");
}

void wipe(std::span<std::byte> bytes) {
  volatile std::byte* to = bytes.data();
  for (std::size_t i = 0; i < bytes.size(); ++i)
    to[i] = std::byte{};
}

}  // namespace crypto
}  // namespace lockstone::net
