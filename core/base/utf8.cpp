#include <lockstone/utf8.h>

namespace lockstone {
namespace {

std::size_t announced_bytes(unsigned first) {
  if (first < 0x80) return 1;
  if (first < 0xc2) return 0;
  if (first < 0xe0) return 2;
  if (first < 0xf0) return 3;
  return first < 0xf5 ? 4 : 0;
}

// Longer than the character needs, a surrogate, or beyond U+10FFFF.
bool is_forbidden(unsigned first, unsigned second) {
  return (first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
         (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f);
}

}  // namespace

std::size_t character_bytes(ByteView text) {
  if (text.empty()) return 0;
  const auto at = [&](std::size_t i) { return std::to_integer<unsigned>(text[i]); };
  const unsigned first = at(0);
  const std::size_t bytes = announced_bytes(first);
  if (bytes == 1) return first >= 0x20 && first != 0x7f ? 1 : 0;
  if (bytes == 0 || bytes > text.size() || is_forbidden(first, at(1))) return 0;
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((at(i) & 0xc0) != 0x80) return 0;
  }
  return bytes;
}

bool is_text(ByteView bytes) {
  while (!bytes.empty()) {
    const std::size_t size = character_bytes(bytes);
    if (size == 0) return false;
    bytes = bytes.subspan(size);
  }
  return true;
}

void put_as_text(ByteWriter& writer, std::string_view text) {
  ByteView rest = std::as_bytes(std::span(text.data(), text.size()));
  while (!rest.empty()) {
    const std::size_t size = character_bytes(rest);
    if (size == 0) writer.put(std::byte{'?'});
    writer.put_bytes(rest.first(size));
    rest = rest.subspan(size == 0 ? 1 : size);
  }
}

}  // namespace lockstone
