#include <algorithm>
#include <charconv>

#include <lockstone/net/token.h>

#include "net/security/hexadecimal.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_mapped_prefix_bytes = 12;  // ten zeros and two ones before an IPv4 address

bool is_mapped(const std::array<std::byte, 16>& address) {
  for (std::size_t i = 0; i < k_mapped_prefix_bytes; ++i) {
    if (address[i] != (i < 10 ? std::byte{0} : std::byte{0xff})) return false;
  }
  return true;
}

// Takes a decimal number of at most `last` and the character `end` after it ('\0': end of text).
bool take_number(std::string_view& text, unsigned last, char end, unsigned& value) {
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || value > last) return false;
  const auto digits = static_cast<std::size_t>(stop - text.data());
  if (digits > 1 && text[0] == '0') return false;  // some read that as octal
  text.remove_prefix(digits);
  if (end == '\0') return text.empty();
  if (text.empty() || text[0] != end) return false;
  text.remove_prefix(1);
  return true;
}

}  // namespace

Result<ServerAddress> ServerAddress::from_text(std::string_view text) {
  ServerAddress result;
  result.address[10] = result.address[11] = std::byte{0xff};
  for (std::size_t i = 0; i < 4; ++i) {
    unsigned value = 0;
    if (!take_number(text, 255, i < 3 ? '.' : ':', value)) return Status::malformed;
    result.address[k_mapped_prefix_bytes + i] = static_cast<std::byte>(value);
  }
  unsigned port = 0;
  if (!take_number(text, 65535, '\0', port) || port == 0) return Status::malformed;
  result.port = static_cast<std::uint16_t>(port);
  return result;
}

std::string ServerAddress::to_text() const {
  std::string text;
  if (!is_mapped(address)) {
    text.append("[").append(hexadecimal(address)).append("]:");
    return text.append(std::to_string(port));
  }
  for (std::size_t i = k_mapped_prefix_bytes; i < address.size(); ++i) {
    text += std::to_string(std::to_integer<unsigned>(address[i]));
    text += i + 1 < address.size() ? '.' : ':';
  }
  return text + std::to_string(port);
}

bool ServerList::add(const ServerAddress& address) {
  if (count >= entries.size()) return false;
  entries[count++] = address;
  return true;
}

bool ServerList::contains(const ServerAddress& address) const {
  return std::find(entries.begin(), entries.begin() + count, address) != entries.begin() + count;
}

}  // namespace lockstone::net
