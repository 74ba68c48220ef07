// Stubs for a build without libsodium: none of them is ever called but crypto_available.
#include <lockstone/assert.h>

#include "net/security/crypto.h"

namespace lockstone::net {

void SystemRandom::fill(std::span<std::byte>) {
  misused("this build of lockstone::net has no libsodium: build it with LOCKSTONE_WITH_SODIUM");
}

namespace crypto {

bool crypto_available() {
  return false;
}
void seal_token(const Key&, const TokenNonce&, ByteView, ByteView, std::span<std::byte>) {
  misused("this build of lockstone::net has no libsodium: build it with LOCKSTONE_WITH_SODIUM");
}
bool open_token(const Key&, const TokenNonce&, ByteView, ByteView, std::span<std::byte>) {
  return false;
}
void seal_packet(const Key&, const PacketNonce&, ByteView, std::span<std::byte>) {
  misused("this build of lockstone::net has no libsodium: build it with LOCKSTONE_WITH_SODIUM");
}
bool open_packet(const Key&, const PacketNonce&, ByteView, std::span<std::byte>) {
  return false;
}
Key derive(const Key&, std::initializer_list<ByteView>) {
  misused("this build of lockstone::net has no libsodium: build it with LOCKSTONE_WITH_SODIUM");
  return {};
}
Key public_half(const Key&) {
  misused("this build of lockstone::net has no libsodium: build it with LOCKSTONE_WITH_SODIUM");
  return {};
}
bool agree(const Key&, const Key&, Key&) {
  return false;
}
std::uint64_t short_hash(const LinkKey&, ByteView) {
  misused("this build of lockstone::net has no libsodium: build it with LOCKSTONE_WITH_SODIUM");
  return 0;
}
void wipe(std::span<std::byte>) {}

}  // namespace crypto
}  // namespace lockstone::net
