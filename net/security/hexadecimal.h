// Bytes as hexadecimal digits.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

namespace lockstone::net {

[[nodiscard]] inline std::string hexadecimal(ByteView bytes) {
  constexpr std::string_view k_digits = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const std::byte byte : bytes) {
    text += k_digits[std::to_integer<unsigned>(byte) >> 4];
    text += k_digits[std::to_integer<unsigned>(byte) & 15];
  }
  return text;
}

[[nodiscard]] inline int hexadecimal_digit(char letter) {
  if (letter >= '0' && letter <= '9') return letter - '0';
  if (letter >= 'a' && letter <= 'f') return letter - 'a' + 10;
  return letter >= 'A' && letter <= 'F' ? letter - 'A' + 10 : -1;
}

/// malformed unless `text` has exactly the digits of `bytes`.
[[nodiscard]] inline Status from_hexadecimal(std::string_view text, std::span<std::byte> bytes) {
  if (text.size() != 2 * bytes.size()) return Status::malformed;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const int high = hexadecimal_digit(text[2 * i]);
    const int low = hexadecimal_digit(text[2 * i + 1]);
    if (high < 0 || low < 0) return Status::malformed;
    bytes[i] = static_cast<std::byte>(high * 16 + low);
  }
  return Status::ok;
}

}  // namespace lockstone::net
