#include <algorithm>
#include <cstdint>
#include <span>

#include <lockstone/net/player_name.h>
#include <lockstone/utf8.h>

namespace lockstone::net {
namespace {

// The number of a whole character of 1 … 4 bytes. Source: RFC 3629, section 3.
std::uint32_t code_point(ByteView character) {
  const auto first = std::to_integer<std::uint32_t>(character[0]);
  if (character.size() == 1) return first;
  std::uint32_t code = first & (0x7fU >> character.size());
  for (const std::byte next : character.subspan(1))
    code = code << 6 | (std::to_integer<std::uint32_t>(next) & 0x3f);
  return code;
}

// Of characters that `character_bytes` takes, so U+0080 and above.
bool changes_layout(std::uint32_t code) {
  return (code >= 0x80 && code <= 0x9f) || (code >= 0x2028 && code <= 0x202e) ||
         (code >= 0x2066 && code <= 0x2069);
}

// The bytes of the character of a name that `text` begins with; 0 where it begins with none.
std::size_t name_character_bytes(ByteView text) {
  const std::size_t size = character_bytes(text);
  return size > 0 && !changes_layout(code_point(text.first(size))) ? size : 0;
}

}  // namespace

PlayerName::PlayerName(std::string_view text) {
  ByteView rest = std::as_bytes(std::span(text.data(), text.size()));
  while (!rest.empty()) {
    const std::size_t allowed = name_character_bytes(rest);
    const std::size_t size = std::max<std::size_t>(allowed, 1);
    if (size_ + size > chars_.size()) return;
    if (allowed == 0) {
      chars_[size_++] = '?';
    } else {
      for (const std::byte byte : rest.first(size))
        chars_[size_++] = static_cast<char>(byte);
    }
    // A whole character that is not allowed is replaced once.
    rest = rest.subspan(std::max<std::size_t>(character_bytes(rest), 1));
  }
}

Result<PlayerName> PlayerName::from_bytes(ByteView bytes) {
  if (bytes.size() > k_max_name_bytes) return Status::malformed;
  PlayerName name;
  for (const std::byte byte : bytes)
    name.chars_[name.size_++] = static_cast<char>(byte);
  while (!bytes.empty()) {
    const std::size_t size = name_character_bytes(bytes);
    if (size == 0) return Status::malformed;
    bytes = bytes.subspan(size);
  }
  return name;
}

std::string player_text(unsigned slot, std::string_view name) {
  std::string text = "player " + std::to_string(slot);
  if (!name.empty()) text += " \"" + std::string(name) + '"';
  return text;
}

}  // namespace lockstone::net
