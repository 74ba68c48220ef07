// The secret of an address or a connection on this machine.
#pragma once

#include <cstddef>
#include <random>
#include <string>

namespace lockstone::watch {

/// Bytes of chance in a token, each two of its characters.
inline constexpr std::size_t k_token_bytes = 16;

/// Hexadecimal digits that the system drew.
[[nodiscard]] inline std::string random_token() {
  constexpr char k_digits[] = "0123456789abcdef";
  std::random_device random;
  std::string token;
  for (std::size_t i = 0; i < 2 * k_token_bytes; ++i)
    token += k_digits[random() & 15U];
  return token;
}

}  // namespace lockstone::watch
