// The commands of the arena: a byte for the kind, then its content. All others mean nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/simulation.h>

namespace lockstone::arena {

enum class CommandKind : std::uint8_t {
  chat = 1,  ///< text for the other players; the state does not know it
  gift = 2,  ///< a byte: the slot that gets a point of the sender
};

inline constexpr std::size_t k_max_chat_bytes = 500;

[[nodiscard]] std::vector<std::byte> chat_command(std::string_view text);
[[nodiscard]] std::vector<std::byte> gift_command(std::uint8_t slot);

/// The text of a line of chat: UTF-8 without control characters, at most k_max_chat_bytes.
[[nodiscard]] std::optional<std::string> chat_text(ByteView command);

/// The slot that is to get a point.
[[nodiscard]] std::optional<std::uint8_t> gift_slot(ByteView command);

}  // namespace lockstone::arena
