#include <array>
#include <string_view>

#include <gtest/gtest.h>

#include <lockstone/utf8.h>

namespace lockstone {
namespace {

ByteView bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

TEST(Utf8, TakesTheFirstAndLastCharacterOfEachLength) {
  for (const std::string_view text :
       {" ", "~", "\xc2\x80", "\xdf\xbf", "\xe0\xa0\x80", "\xed\x9f\xbf", "\xee\x80\x80",
        "\xef\xbf\xbf", "\xf0\x90\x80\x80", "\xf4\x8f\xbf\xbf"}) {
    EXPECT_EQ(character_bytes(bytes_of(text)), text.size());
    EXPECT_FALSE(is_text(bytes_of(text.substr(0, text.size() - 1))) && text.size() > 1);
  }
}

TEST(Utf8, RefusesControlsSurrogatesAndOverlongForms) {
  for (const std::string_view text :
       {"\x1f", "\x7f", "\x80", "\xbf", "\xc0\x80", "\xc1\xbf", "\xe0\x9f\xbf", "\xed\xa0\x80",
        "\xf0\x8f\xbf\xbf", "\xf4\x90\x80\x80", "\xf5\x80\x80\x80", "\xff", "\xc3(", "\xe2\x82("}) {
    EXPECT_EQ(character_bytes(bytes_of(text)), 0U);
  }
  EXPECT_EQ(character_bytes({}), 0U);
}

// A reference decoder of two bytes: a character of its own value, spelt shortest.
TEST(Utf8, KnowsEveryPairOfBytes) {
  for (unsigned first = 0; first < 256; ++first) {
    for (unsigned second = 0; second < 256; ++second) {
      const std::array pair{static_cast<std::byte>(first), static_cast<std::byte>(second)};
      const bool one = first >= 0x20 && first < 0x7f;
      const bool two = (first & 0xe0) == 0xc0 && (second & 0xc0) == 0x80 &&
                       (((first & 0x1f) << 6) | (second & 0x3f)) >= 0x80;
      ASSERT_EQ(character_bytes(pair), one ? 1U : two ? 2U : 0U) << first << " " << second;
    }
  }
}

TEST(Utf8, WritesAQuestionMarkForEachByteThatIsNone) {
  std::array<std::byte, 16> out{};
  ByteWriter writer(out);
  put_as_text(writer, "a\n\xc3\xa9\xff\xe2\x82");
  EXPECT_TRUE(is_text(writer.written()));
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(out.data()), writer.size()),
            "a?\xc3\xa9???");
}

}  // namespace
}  // namespace lockstone
