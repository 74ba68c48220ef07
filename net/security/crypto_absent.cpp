// What a build without libsodium links: nothing here is ever reached but crypto_available.
#include <lockstone/assert.h>

#include "net/security/crypto.h"

namespace lockstone::net {

void SystemRandom::fill(std::span<std::byte>) {
  LKS_CHECK(false);
}

namespace crypto {

bool crypto_available() {
  return false;
}
void seal_token(const Key&, const TokenNonce&, ByteView, ByteView, std::span<std::byte>) {
  LKS_CHECK(false);
}
bool open_token(const Key&, const TokenNonce&, ByteView, ByteView, std::span<std::byte>) {
  return false;
}
void seal_packet(const Key&, const PacketNonce&, ByteView, std::span<std::byte>) {
  LKS_CHECK(false);
}
bool open_packet(const Key&, const PacketNonce&, ByteView, std::span<std::byte>) {
  return false;
}
Key derive(const Key&, std::initializer_list<ByteView>) {
  LKS_CHECK(false);
  return {};
}
Key public_half(const Key&) {
  LKS_CHECK(false);
  return {};
}
bool agree(const Key&, const Key&, Key&) {
  return false;
}
std::uint64_t short_hash(const LinkKey&, ByteView) {
  LKS_CHECK(false);
  return 0;
}
void wipe(std::span<std::byte>) {}

}  // namespace crypto
}  // namespace lockstone::net
