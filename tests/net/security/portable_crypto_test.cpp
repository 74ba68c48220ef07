// The primitives for WebAssembly against libsodium's, bit for bit.
#include <gtest/gtest.h>

#include "net/security/crypto.h"
#include "net/security/portable/chacha20_poly1305.h"
#include "net/security/portable/hashes.h"
#include "net/security/portable/x25519.h"

namespace lockstone::net::test {
namespace {

struct Draws {
  SystemRandom random;

  template <std::size_t N>
  std::array<std::byte, N> array() {
    std::array<std::byte, N> bytes;
    random.fill(bytes);
    return bytes;
  }
  Key key() { return {array<k_key_bytes>()}; }
  std::vector<std::byte> bytes(std::size_t size) {
    std::vector<std::byte> drawn(size);
    random.fill(drawn);
    return drawn;
  }
};

TEST(PortableCrypto, SealsPacketsOfEveryLengthAsLibsodium) {
  Draws draw;
  for (std::size_t size = 0; size < 700; ++size) {
    const Key key = draw.key();
    const auto nonce = draw.array<crypto::k_packet_nonce_bytes>();
    const std::vector<std::byte> plain = draw.bytes(size);
    std::vector<std::byte> here(size + 16), there(size + 16), back(size);
    portable::seal(key, nonce, {}, plain, here);
    crypto::seal_packet(key, nonce, plain, there);
    ASSERT_EQ(here, there) << size;
    ASSERT_TRUE(portable::open(key, nonce, {}, there, back));
    ASSERT_EQ(back, plain);
    there[size / 2] ^= std::byte{4};
    ASSERT_FALSE(portable::open(key, nonce, {}, there, back));
  }
}

TEST(PortableCrypto, SealsTokensAsLibsodium) {
  Draws draw;
  for (std::size_t size = 0; size < 300; ++size) {
    const Key key = draw.key();
    const auto nonce = draw.array<crypto::k_token_nonce_bytes>();
    const std::vector<std::byte> plain = draw.bytes(size), context = draw.bytes(size * 7 % 90);
    std::vector<std::byte> here(size + 16), there(size + 16);
    portable::seal(key, nonce, context, plain, here);
    crypto::seal_token(key, nonce, context, plain, there);
    ASSERT_EQ(here, there) << size;
  }
}

// The sums of Poly1305 reach the modulus and the ends of limbs only where bytes are extreme.
TEST(PortableCrypto, SealsExtremeBytesAsLibsodium) {
  Draws draw;
  for (int i = 0; i < 2000; ++i) {
    const Key key = draw.key();
    const crypto::PacketNonce nonce{};
    std::vector<std::byte> plain(64), here(80), there(80);
    crypto::seal_packet(key, nonce, plain, there);
    for (std::size_t at = 0; at < 64; ++at)  // so that the sealed bytes are all ones
      plain[at] = there[at] ^ std::byte{0xff};
    portable::seal(key, nonce, {}, plain, here);
    crypto::seal_packet(key, nonce, plain, there);
    ASSERT_EQ(here, there);
  }
}

TEST(PortableCrypto, HashesAsLibsodium) {
  Draws draw;
  for (std::size_t size = 0; size < 600; ++size) {
    const Key key = draw.key();
    const LinkKey link{draw.array<k_link_key_bytes>()};
    const std::vector<std::byte> first = draw.bytes(size), second = draw.bytes(size / 3);
    ASSERT_EQ(portable::blake2b(key, {first, second}), crypto::derive(key, {first, second}));
    ASSERT_EQ(portable::siphash(link, first), crypto::short_hash(link, first));
  }
}

TEST(PortableCrypto, AgreesOnSecretsAsLibsodium) {
  Draws draw;
  for (int i = 0; i < 200; ++i) {
    const Key secret = draw.key(), other = draw.key();
    Key shared;
    ASSERT_EQ(portable::x25519(secret, portable::x25519_base()), crypto::public_half(secret));
    ASSERT_TRUE(crypto::agree(secret, other, shared));
    ASSERT_EQ(portable::x25519(secret, other), shared);
  }
}

// Numbers at and beyond the modulus, and the points that give everybody the same.
TEST(PortableCrypto, AgreesOnExtremePointsAsLibsodium) {
  Draws draw;
  for (unsigned low = 0; low < 256; ++low) {
    for (const std::byte fill : {std::byte{0}, std::byte{0xff}}) {
      Key other, shared;
      other.bytes.fill(fill);
      other.bytes[0] = static_cast<std::byte>(low);
      const Key secret = draw.key();
      const bool good = crypto::agree(secret, other, shared);
      const Key here = portable::x25519(secret, other);
      EXPECT_EQ(here != Key{}, good) << low;
      if (good) {
        EXPECT_EQ(here, shared);
      }
      other.bytes[31] &= std::byte{0x7f};
      if (crypto::agree(secret, other, shared)) {
        EXPECT_EQ(portable::x25519(secret, other), shared);
      }
    }
  }
}

}  // namespace
}  // namespace lockstone::net::test
