// Numbers for people.
#pragma once

#include <cstdint>
#include <string>

namespace lockstone::replay {

/// "0x" and 16 lower-case digits.
[[nodiscard]] inline std::string to_hex(std::uint64_t value) {
  std::string text = "0x0000000000000000";
  for (std::size_t i = text.size(); i-- > 2; value >>= 4)
    text[i] = "0123456789abcdef"[value & 15];
  return text;
}

}  // namespace lockstone::replay
