#include "net/security/ipv6_text.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace lockstone::net {
namespace {

constexpr std::size_t k_groups = 8;
constexpr std::size_t k_mapped_prefix_bytes = 12;  // ten zeros and two ones before an IPv4 address

// Takes the text before the next `separator`, and the separator; all of it if there is none.
std::string_view take_part(std::string_view& text, char separator) {
  const std::size_t end = text.find(separator);
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  return part;
}

std::optional<unsigned> read_number(std::string_view digits, std::size_t most_digits, int base) {
  if (digits.empty() || digits.size() > most_digits) return std::nullopt;
  unsigned value = 0;
  const char* end = digits.data() + digits.size();
  const auto [stop, error] = std::from_chars(digits.data(), end, value, base);
  if (error != std::errc() || stop != end) return std::nullopt;
  return value;
}

// The groups of one side of `::`, or of a whole address.
struct Groups {
  std::array<std::uint16_t, k_groups> values{};
  std::size_t count = 0;

  bool add(unsigned value) {
    if (count == k_groups) return false;
    values[count++] = static_cast<std::uint16_t>(value);
    return true;
  }
};

bool add_ipv4(std::string_view text, Groups& groups) {
  const auto bytes = ipv4_from_text(text);
  if (!bytes) return false;
  const auto pair = [&](std::size_t i) {
    return std::to_integer<unsigned>((*bytes)[i]) << 8 | std::to_integer<unsigned>((*bytes)[i + 1]);
  };
  return groups.add(pair(0)) && groups.add(pair(2));
}

// An IPv4 address may stand for the last two groups.
bool read_groups(std::string_view text, bool may_end_in_ipv4, Groups& groups) {
  if (text.empty()) return true;
  if (text.back() == ':') return false;
  while (!text.empty()) {
    const std::string_view part = take_part(text, ':');
    if (may_end_in_ipv4 && text.empty() && part.find('.') != std::string_view::npos) {
      return add_ipv4(part, groups);
    }
    const std::optional<unsigned> value = read_number(part, 4, 16);
    if (!value || !groups.add(*value)) return false;
  }
  return true;
}

unsigned group_of(const Ipv6Bytes& address, std::size_t index) {
  return std::to_integer<unsigned>(address[2 * index]) << 8 |
         std::to_integer<unsigned>(address[2 * index + 1]);
}

struct Run {
  std::size_t begin = k_groups;
  std::size_t size = 1;  // a single zero is not shortened
};

Run longest_run_of_zeros(const Ipv6Bytes& address) {
  Run longest;
  for (std::size_t begin = 0; begin < k_groups; ++begin) {
    std::size_t end = begin;
    while (end < k_groups && group_of(address, end) == 0)
      ++end;
    if (end - begin > longest.size) longest = {begin, end - begin};
  }
  return longest;
}

}  // namespace

std::optional<std::array<std::byte, 4>> ipv4_from_text(std::string_view text) {
  if (std::count(text.begin(), text.end(), '.') != 3) return std::nullopt;
  std::array<std::byte, 4> bytes{};
  for (std::byte& byte : bytes) {
    const std::string_view part = take_part(text, '.');
    const std::optional<unsigned> value = read_number(part, 3, 10);
    const bool octal = part.size() > 1 && part[0] == '0';  // to some readers
    if (!value || *value > 255 || octal) return std::nullopt;
    byte = static_cast<std::byte>(*value);
  }
  return bytes;
}

std::optional<Ipv6Bytes> ipv6_from_text(std::string_view text) {
  Groups front, back;
  const std::size_t gap = text.find("::");
  const bool has_gap = gap != std::string_view::npos;
  if (!read_groups(text.substr(0, gap), !has_gap, front)) return std::nullopt;
  if (has_gap && !read_groups(text.substr(gap + 2), true, back)) return std::nullopt;
  const std::size_t count = front.count + back.count;
  if (has_gap ? count >= k_groups : count != k_groups) return std::nullopt;
  Groups all = front;
  all.count = k_groups - back.count;
  for (std::size_t i = 0; i < back.count; ++i)
    all.add(back.values[i]);
  Ipv6Bytes address{};
  for (std::size_t i = 0; i < k_groups; ++i) {
    address[2 * i] = static_cast<std::byte>(all.values[i] >> 8);
    address[2 * i + 1] = static_cast<std::byte>(all.values[i] & 0xff);
  }
  return address;
}

std::string ipv6_to_text(const Ipv6Bytes& address) {
  const Run zeros = longest_run_of_zeros(address);
  std::string text;
  for (std::size_t i = 0; i < k_groups; ++i) {
    if (i == zeros.begin) {
      text += "::";
      i += zeros.size - 1;
      continue;
    }
    if (!text.empty() && text.back() != ':') text += ':';
    std::array<char, 4> digits{};
    const auto [end, error] =
        std::to_chars(digits.data(), digits.data() + digits.size(), group_of(address, i), 16);
    static_cast<void>(error);  // four digits hold any group
    text.append(digits.data(), end);
  }
  return text;
}

bool is_mapped_ipv4(const Ipv6Bytes& address) {
  for (std::size_t i = 0; i < k_mapped_prefix_bytes; ++i) {
    if (address[i] != (i < 10 ? std::byte{0} : std::byte{0xff})) return false;
  }
  return true;
}

Ipv6Bytes map_ipv4(const std::array<std::byte, 4>& address) {
  Ipv6Bytes mapped{};
  mapped[10] = mapped[11] = std::byte{0xff};
  std::copy(address.begin(), address.end(), mapped.begin() + k_mapped_prefix_bytes);
  return mapped;
}

}  // namespace lockstone::net
