// Numbers and bytes for people.
#pragma once

#include <cstdint>
#include <string>

#include <lockstone/bytes.h>

namespace lockstone::replay {

/// "0x" and 16 lower-case digits.
[[nodiscard]] inline std::string to_hex(std::uint64_t value) {
  std::string text = "0x0000000000000000";
  for (std::size_t i = text.size(); i-- > 2; value >>= 4)
    text[i] = "0123456789abcdef"[value & 15];
  return text;
}

/// Two lower-case digits for each byte.
[[nodiscard]] inline std::string hex_digits(ByteView bytes) {
  std::string text;
  for (const std::byte byte : bytes) {
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte) >> 4];
    text += "0123456789abcdef"[std::to_integer<unsigned>(byte) & 15];
  }
  return text;
}

}  // namespace lockstone::replay
