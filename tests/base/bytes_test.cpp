#include <array>

#include <gtest/gtest.h>

#include <lockstone/bytes.h>
#include <lockstone/hash.h>

namespace lockstone {
namespace {

TEST(ByteWriter, WritesLittleEndian) {
  std::array<std::byte, 4> buffer{};
  ByteWriter writer(buffer);
  writer.put<std::uint32_t>(0x04030201);
  ASSERT_TRUE(writer.ok());
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(std::to_integer<std::size_t>(buffer[i]), i + 1);
}

TEST(ByteWriter, RefusesBytesThatDoNotFitAndStaysFailed) {
  std::array<std::byte, 3> buffer{};
  ByteWriter writer(buffer);
  writer.put<std::uint32_t>(1);
  EXPECT_FALSE(writer.ok());
  writer.put<std::uint8_t>(1);
  EXPECT_FALSE(writer.ok());
  EXPECT_EQ(writer.size(), 0U);
}

TEST(ByteReader, ReturnsTheWrittenValues) {
  std::array<std::byte, 32> buffer{};
  ByteWriter writer(buffer);
  writer.put<std::int64_t>(-5);
  writer.put<std::uint16_t>(0xbeef);
  writer.put<std::int8_t>(-128);
  ByteReader reader(writer.written());
  EXPECT_EQ(reader.get<std::int64_t>(), -5);
  EXPECT_EQ(reader.get<std::uint16_t>(), 0xbeef);
  EXPECT_EQ(reader.get<std::int8_t>(), -128);
  EXPECT_TRUE(reader.ok());
  EXPECT_EQ(reader.remaining(), 0U);
}

TEST(ByteReader, GivesZeroBeyondTheEndAndStaysFailed) {
  const std::array<std::byte, 2> buffer{std::byte{7}, std::byte{7}};
  ByteReader reader(buffer);
  EXPECT_EQ(reader.get<std::uint32_t>(), 0U);
  EXPECT_EQ(reader.get<std::uint8_t>(), 0U);
  EXPECT_FALSE(reader.ok());
}

TEST(Hash64, IsXxh3) {
  // XXH3_64bits of the empty input, from the xxHash specification's test vectors.
  EXPECT_EQ(hash64({}), 0x2D06800538D394C2ULL);
}

}  // namespace
}  // namespace lockstone
