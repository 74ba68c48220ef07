#include "net/security/packet_seal.h"

#include <set>

#include <gtest/gtest.h>

#include "net/security/rate_limit.h"
#include "tests/net/security/secure_fixture.h"

namespace lockstone::net::test {
namespace {

using Outcome = PacketOpener::Outcome;
using Bytes = std::vector<std::byte>;

Key key_of(std::uint64_t seed) {
  TestRandom random(seed);
  return make_key(random);
}

Bytes sealed(PacketSealer& sealer, Channel channel, ByteView plain) {
  Bytes out(plain.size() + k_carrier_reserve_bytes);
  out.resize(sealer.seal(channel, plain, out));
  if (channel == Channel::reliable) sealer.reliable_sent();
  return out;
}

Outcome open(PacketOpener& opener, Channel channel, const Bytes& packet, Bytes* plain = nullptr) {
  Bytes out(packet.size());
  std::size_t size = 0;
  const Outcome outcome = opener.open(channel, packet, out, size);
  out.resize(size);
  if (plain != nullptr) *plain = out;
  return outcome;
}

TEST(PacketSeal, OpensSealedPackets) {
  PacketSealer sealer(key_of(1));
  PacketOpener opener(key_of(1));
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    Bytes plain(random.below(1200));
    for (std::byte& byte : plain)
      byte = static_cast<std::byte>(random.below(256));
    const Channel channel = random.below(2) == 0 ? Channel::reliable : Channel::unreliable;
    Bytes opened;
    ASSERT_EQ(open(opener, channel, sealed(sealer, channel, plain), &opened), Outcome::ok);
    ASSERT_EQ(opened, plain);
  }
}

TEST(PacketSeal, EqualBytesNeverLookEqual) {
  PacketSealer sealer(key_of(1));
  const Bytes plain(32, std::byte{7});
  std::set<Bytes> seen;
  for (const Channel channel : {Channel::reliable, Channel::unreliable}) {
    for (int i = 0; i < 1000; ++i) {
      const Bytes packet = sealed(sealer, channel, plain);
      // Their encrypted parts, without the bytes in clear.
      seen.insert(Bytes(packet.end() - 48, packet.end()));
    }
  }
  EXPECT_EQ(seen.size(), 2000U);
}

TEST(PacketSeal, NoChangedOrMissingByteOpens) {
  for (const Channel channel : {Channel::reliable, Channel::unreliable}) {
    PacketSealer sealer(key_of(1));
    const Bytes packet = sealed(sealer, channel, Bytes(20, std::byte{7}));
    PacketOpener opener(key_of(1));
    for (std::size_t bit = 0; bit < 8 * packet.size(); ++bit) {
      Bytes changed = packet;
      changed[bit / 8] ^= std::byte{1} << bit % 8;
      EXPECT_EQ(open(opener, channel, changed), Outcome::forged) << bit;
    }
    for (std::size_t size = 0; size < packet.size(); ++size) {
      EXPECT_EQ(open(opener, channel, Bytes(packet.begin(), packet.begin() + std::ptrdiff_t(size))),
                Outcome::forged);
    }
    PacketOpener stranger(key_of(2));
    EXPECT_EQ(open(stranger, channel, packet), Outcome::forged);
    EXPECT_EQ(open(opener, channel, packet), Outcome::ok);
  }
}

TEST(PacketSeal, AReliablePacketOpensOnceAndInItsPlace) {
  PacketSealer sealer(key_of(1));
  PacketOpener opener(key_of(1));
  const Bytes first = sealed(sealer, Channel::reliable, Bytes(4));
  const Bytes second = sealed(sealer, Channel::reliable, Bytes(4));
  EXPECT_EQ(open(opener, Channel::reliable, second), Outcome::forged);
  EXPECT_EQ(open(opener, Channel::reliable, first), Outcome::ok);
  EXPECT_EQ(open(opener, Channel::reliable, first), Outcome::forged);
  EXPECT_EQ(open(opener, Channel::unreliable, second), Outcome::forged);
  EXPECT_EQ(open(opener, Channel::reliable, second), Outcome::ok);
}

TEST(PacketSeal, AnUnreliablePacketOpensOnce) {
  PacketSealer sealer(key_of(1));
  PacketOpener opener(key_of(1));
  std::vector<Bytes> packets;
  for (int i = 0; i < 600; ++i)
    packets.push_back(sealed(sealer, Channel::unreliable, Bytes(4)));
  EXPECT_EQ(open(opener, Channel::unreliable, packets[400]), Outcome::ok);
  EXPECT_EQ(open(opener, Channel::unreliable, packets[400]), Outcome::replayed);
  EXPECT_EQ(open(opener, Channel::unreliable, packets[401 - ReplayWindow::k_size]), Outcome::ok);
  EXPECT_EQ(open(opener, Channel::unreliable, packets[400 - ReplayWindow::k_size]),
            Outcome::replayed);
  EXPECT_EQ(open(opener, Channel::unreliable, packets[599]), Outcome::ok);
  EXPECT_EQ(open(opener, Channel::unreliable, packets[400]), Outcome::replayed);
}

// Against a set of everything that was ever marked.
TEST(ReplayWindow, AgreesWithASetThatForgetsNothing) {
  Random random(11);
  ReplayWindow window;
  std::set<std::uint64_t> seen;
  std::uint64_t next = 0;
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t back = random.below(300);
    std::uint64_t counter = next > back ? next - back : 0;
    if (random.below(50) == 0) counter = next + random.below(700);
    const bool known = seen.count(counter) != 0 || counter + ReplayWindow::k_size < next;
    ASSERT_EQ(window.accepts(counter), !known) << counter << " of " << next;
    if (known) continue;
    window.mark(counter);
    seen.insert(counter);
    next = std::max(next, counter + 1);
  }
}

TEST(ReplayWindow, CountsBeyondThirtyTwoBits) {
  ReplayWindow window;
  EXPECT_EQ(window.expand(5), 5U);
  EXPECT_EQ(window.expand(0xffffffff), 0xffffffffU);
  std::uint64_t counter = 0xffffff00;
  window.mark(counter);
  for (int i = 0; i < 1000; ++i) {
    counter += 3;
    ASSERT_EQ(window.expand(static_cast<std::uint32_t>(counter & 0xffffffff)), counter);
    const std::uint64_t older = counter - 100;
    ASSERT_EQ(window.expand(static_cast<std::uint32_t>(older & 0xffffffff)), older);
    window.mark(counter);
  }
}

TEST(RateLimit, LetsThroughTheRateAndOneBurst) {
  RateLimit limit(100, 50);
  std::int64_t now_us = 1'000'000;
  int passed = 0;
  for (int i = 0; i < 200; ++i)
    passed += limit.take(now_us, 1) ? 1 : 0;
  EXPECT_EQ(passed, 50);
  for (passed = 0; now_us < 11'000'000; now_us += 1000)
    passed += limit.take(now_us, 1) ? 1 : 0;
  EXPECT_NEAR(passed, 1000, 1);
}

TEST(RateLimit, ZeroIsNoLimit) {
  RateLimit limit(0, 0);
  for (int i = 0; i < 1000; ++i)
    EXPECT_TRUE(limit.take(0, 1'000'000));
}

}  // namespace
}  // namespace lockstone::net::test
