#include <sodium.h>

#include <lockstone/assert.h>

#include "net/security/crypto.h"

namespace lockstone::net {
namespace {

const unsigned char* raw(const std::byte* bytes) {
  return reinterpret_cast<const unsigned char*>(bytes);
}
unsigned char* raw(std::byte* bytes) {
  return reinterpret_cast<unsigned char*>(bytes);
}

static_assert(crypto_aead_xchacha20poly1305_ietf_KEYBYTES == k_key_bytes);
static_assert(crypto_aead_xchacha20poly1305_ietf_NPUBBYTES == crypto::k_token_nonce_bytes);
static_assert(crypto_aead_xchacha20poly1305_ietf_ABYTES == crypto::k_tag_bytes);
static_assert(crypto_aead_chacha20poly1305_ietf_KEYBYTES == k_key_bytes);
static_assert(crypto_aead_chacha20poly1305_ietf_NPUBBYTES == crypto::k_packet_nonce_bytes);
static_assert(crypto_aead_chacha20poly1305_ietf_ABYTES == crypto::k_tag_bytes);
static_assert(crypto_scalarmult_BYTES == k_key_bytes);
static_assert(crypto_shorthash_siphash24_KEYBYTES == k_link_key_bytes);

}  // namespace

void SystemRandom::fill(std::span<std::byte> out) {
  if (!crypto::crypto_available()) misused("net::SystemRandom: libsodium did not start");
  randombytes_buf(out.data(), out.size());
}

namespace crypto {

bool crypto_available() {
  return sodium_init() >= 0;
}

void seal_token(const Key& key, const TokenNonce& nonce, ByteView context, ByteView plain,
                std::span<std::byte> out) {
  LKS_CHECK(out.size() == plain.size() + k_tag_bytes);
  crypto_aead_xchacha20poly1305_ietf_encrypt(raw(out.data()), nullptr, raw(plain.data()),
                                             plain.size(), raw(context.data()), context.size(),
                                             nullptr, raw(nonce.data()), raw(key.bytes.data()));
}

bool open_token(const Key& key, const TokenNonce& nonce, ByteView context, ByteView sealed,
                std::span<std::byte> out) {
  LKS_CHECK(sealed.size() == out.size() + k_tag_bytes);
  return crypto_aead_xchacha20poly1305_ietf_decrypt(
             raw(out.data()), nullptr, nullptr, raw(sealed.data()), sealed.size(),
             raw(context.data()), context.size(), raw(nonce.data()), raw(key.bytes.data())) == 0;
}

void seal_packet(const Key& key, const PacketNonce& nonce, ByteView plain,
                 std::span<std::byte> out) {
  LKS_CHECK(out.size() == plain.size() + k_tag_bytes);
  crypto_aead_chacha20poly1305_ietf_encrypt(raw(out.data()), nullptr, raw(plain.data()),
                                            plain.size(), nullptr, 0, nullptr, raw(nonce.data()),
                                            raw(key.bytes.data()));
}

bool open_packet(const Key& key, const PacketNonce& nonce, ByteView sealed,
                 std::span<std::byte> out) {
  LKS_CHECK(sealed.size() == out.size() + k_tag_bytes);
  return crypto_aead_chacha20poly1305_ietf_decrypt(raw(out.data()), nullptr, nullptr,
                                                   raw(sealed.data()), sealed.size(), nullptr, 0,
                                                   raw(nonce.data()), raw(key.bytes.data())) == 0;
}

Key derive(const Key& key, std::initializer_list<ByteView> parts) {
  crypto_generichash_state state;
  crypto_generichash_init(&state, raw(key.bytes.data()), key.bytes.size(), k_key_bytes);
  for (const ByteView part : parts)
    crypto_generichash_update(&state, raw(part.data()), part.size());
  Key derived;
  crypto_generichash_final(&state, raw(derived.bytes.data()), derived.bytes.size());
  sodium_memzero(&state, sizeof(state));
  return derived;
}

Key public_half(const Key& secret) {
  Key half;
  crypto_scalarmult_base(raw(half.bytes.data()), raw(secret.bytes.data()));
  return half;
}

bool agree(const Key& secret, const Key& other_half, Key& shared) {
  return crypto_scalarmult(raw(shared.bytes.data()), raw(secret.bytes.data()),
                           raw(other_half.bytes.data())) == 0;
}

std::uint64_t short_hash(const LinkKey& key, ByteView bytes) {
  std::array<std::byte, crypto_shorthash_siphash24_BYTES> hash;
  crypto_shorthash_siphash24(raw(hash.data()), raw(bytes.data()), bytes.size(),
                             raw(key.bytes.data()));
  return ByteReader(hash).get<std::uint64_t>();
}

void wipe(std::span<std::byte> bytes) {
  sodium_memzero(bytes.data(), bytes.size());
}

}  // namespace crypto
}  // namespace lockstone::net
