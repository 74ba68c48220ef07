#include "tools/arena/arena_command.h"

#include <lockstone/utf8.h>

namespace lockstone::arena {
namespace {

bool is_kind(ByteView command, CommandKind kind) {
  return command.size() > 1 && command[0] == static_cast<std::byte>(kind);
}

}  // namespace

std::vector<std::byte> chat_command(std::string_view text) {
  std::vector<std::byte> bytes{static_cast<std::byte>(CommandKind::chat)};
  for (const char c : text.substr(0, k_max_chat_bytes))
    bytes.push_back(static_cast<std::byte>(c));
  return bytes;
}

std::vector<std::byte> gift_command(std::uint8_t slot) {
  return {static_cast<std::byte>(CommandKind::gift), std::byte{slot}};
}

std::optional<std::string> chat_text(ByteView command) {
  if (!is_kind(command, CommandKind::chat)) return std::nullopt;
  const ByteView text = command.subspan(1);
  if (text.size() > k_max_chat_bytes || !is_text(text)) return std::nullopt;
  return std::string(reinterpret_cast<const char*>(text.data()), text.size());
}

std::optional<std::uint8_t> gift_slot(ByteView command) {
  if (!is_kind(command, CommandKind::gift) || command.size() != 2) return std::nullopt;
  return std::to_integer<std::uint8_t>(command[1]);
}

}  // namespace lockstone::arena
