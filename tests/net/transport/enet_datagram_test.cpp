#include "net/transport/enet/enet_datagram.h"

#include <gtest/gtest.h>

#include "net/transport/flood_watch.h"
#include "tests/net/security/secure_fixture.h"

namespace lockstone::net::test {
namespace {

using Bytes = std::vector<std::byte>;

Bytes connect_datagram(std::byte id) {
  Bytes bytes(56);
  bytes[0] = std::byte{0x8f};  // with a time; to nobody yet
  bytes[1] = std::byte{0xff};
  bytes[8] = std::byte{0x82};
  bytes[48] = id;
  return bytes;
}

TEST(EnetDatagram, ReadsTheHeadOfARequestForAConnection) {
  const Bytes bytes = connect_datagram(std::byte{7});
  const auto head = read_head(bytes);
  ASSERT_TRUE(head.has_value());
  EXPECT_EQ(head->peer, k_no_peer);
  EXPECT_EQ(head->checksum_offset, 4U);
  EXPECT_EQ(read_connect(bytes, *head), (Word{std::byte{7}}));
  for (std::size_t size = 0; size < 12; ++size)
    EXPECT_FALSE(read_head(ByteView(bytes).first(size)).has_value());
  for (std::size_t size = 12; size < bytes.size(); ++size) {
    const auto shorter = ByteView(bytes).first(size);
    EXPECT_FALSE(read_connect(shorter, read_head(shorter).value()).has_value());
  }
}

TEST(EnetDatagram, RefusesCompressedOnes) {
  Bytes bytes = connect_datagram(std::byte{7});
  bytes[0] |= std::byte{0x40};
  EXPECT_FALSE(read_head(bytes).has_value());
}

TEST(EnetDatagram, TheChecksumFindsEveryChangedBitAndAnotherKey) {
  std::vector<std::optional<LinkKey>> keys{std::nullopt};
  if (security_available()) keys.emplace_back(make_link_key(backend_key(), k_match));
  for (const auto& key : keys) {
    const LinkChecksum checksum(key);
    Bytes bytes = connect_datagram(std::byte{7});
    const auto head = read_head(bytes).value();
    const Word sum = checksum.of(bytes);
    std::copy(sum.begin(), sum.end(), bytes.begin() + 4);
    const Bytes sent = bytes;
    EXPECT_TRUE(checksum.verify(bytes, head, Word{}));
    EXPECT_FALSE(checksum.verify(bytes, head, Word{std::byte{1}}));
    EXPECT_EQ(bytes, sent);
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      bytes[bit / 8] ^= std::byte{1} << bit % 8;
      EXPECT_FALSE(checksum.verify(bytes, head, Word{}));
      bytes[bit / 8] ^= std::byte{1} << bit % 8;
    }
  }
}

// The open checksum is part of the wire format: it must not change.
TEST(EnetDatagram, TheOpenChecksumStaysTheSame) {
  const Word sum = LinkChecksum(std::nullopt).of(connect_datagram(std::byte{7}));
  EXPECT_EQ(ByteReader(sum).get<std::uint32_t>(), 0x85f5c1d8U);
}

TEST(EnetDatagram, ARefusalSurvivesBytesAndIsNoDatagramOfEnet) {
  const LinkRefusal refusal{RefuseReason::insecure_not_allowed, Word{std::byte{9}}};
  const auto bytes = encode(refusal);
  const auto read = decode_link_refusal(bytes);
  ASSERT_TRUE(read.has_value());
  EXPECT_EQ(read->reason, refusal.reason);
  EXPECT_EQ(read->connection, refusal.connection);
  EXPECT_FALSE(read_head(bytes).has_value());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(decode_link_refusal(ByteView(bytes).first(size)).has_value());
}

TEST(ConnectMemory, KnowsWhoAskedFirst) {
  ConnectMemory memory(2);
  const DatagramSource here{.address = {}, .port = 2}, there{.address = {}, .port = 3};
  const Word a{std::byte{1}}, b{std::byte{2}}, c{std::byte{3}};
  EXPECT_TRUE(memory.admit(a, here));
  EXPECT_TRUE(memory.admit(a, here));
  EXPECT_FALSE(memory.admit(a, there));
  EXPECT_TRUE(memory.admit(b, there));
  EXPECT_TRUE(memory.admit(c, there));  // forgets a
  EXPECT_TRUE(memory.admit(a, there));
}

TEST(FloodWatch, CallsAnExcessThatLastsForSecondsAFlood) {
  FloodWatch honest(100, 0), flood(100, 0);
  bool flooded = false;
  for (std::int64_t now_us = 0; now_us < 60'000'000; now_us += 20'000) {
    ASSERT_TRUE(honest.admit(now_us, 50));
    for (int i = 0; i < 10; ++i)  // 500 a second
      static_cast<void>(flood.admit(now_us, 50));
    flooded = flooded || flood.flooding();
    ASSERT_EQ(flood.flooding() && now_us < 2'000'000, false);
  }
  EXPECT_FALSE(honest.flooding());
  EXPECT_TRUE(flooded);
}

}  // namespace
}  // namespace lockstone::net::test
