// The name that a player gives itself when it joins: text for people, beside the number of its
// slot. It proves nothing: two players may have the same one.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

namespace lockstone::net {

inline constexpr std::size_t k_max_name_bytes = 32;

/// UTF-8 of at most k_max_name_bytes without characters that change how the text around it looks:
/// controls (U+0000 … U+001F, U+007F … U+009F), breaks of lines and paragraphs and changes of
/// direction (U+2028 … U+202E, U+2066 … U+2069). Empty: the player gave none.
class PlayerName {
 public:
  PlayerName() = default;

  /// From the player's own program: '?' for each character that is not allowed, and for each byte
  /// of none; cut after the last character that fits.
  explicit PlayerName(std::string_view text);

  /// From outside: malformed unless it is a name as it stands.
  [[nodiscard]] static Result<PlayerName> from_bytes(ByteView bytes);

  [[nodiscard]] std::string_view view() const { return {chars_.data(), size_}; }
  friend bool operator==(const PlayerName&, const PlayerName&) = default;

 private:
  std::array<char, k_max_name_bytes> chars_{};
  std::size_t size_ = 0;
};

/// `player 2 "Ann"`; `player 2` where the name is empty.
[[nodiscard]] std::string player_text(unsigned slot, std::string_view name);

}  // namespace lockstone::net
