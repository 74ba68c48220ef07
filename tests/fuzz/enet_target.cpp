// The ENet commands in one peer's datagrams. The input is the number of the last delivered
// reliable command (u16), whether this side called (u8), and a run of datagrams, each with how many
// more commands were delivered before it (u8), a length (u16) and its commands.

#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "net/transport/enet/enet_commands.h"
#include "tests/fuzz/target.h"

namespace lockstone::fuzz {
namespace {

using net::CommandFilter;
using Verdict = CommandFilter::Verdict;

constexpr std::size_t k_input_head = 3;
constexpr std::size_t k_datagram_head = 3;

// By kind of command; 0: none that passes.
constexpr std::array<std::uint8_t, 16> k_sizes{0, 8, 0, 44, 8, 4, 6, 0, 24, 8, 12, 16, 0, 0, 0, 0};
constexpr std::array<std::uint8_t, 16> k_flags{0,    0,    0,    0x80, 0x80, 0x80, 0x80, 0,
                                               0x80, 0x40, 0x80, 0x80, 0,    0,    0,    0};

std::size_t kind_of(std::byte first) {
  return std::to_integer<std::size_t>(first) & 0x0f;
}

std::size_t number16(ByteView bytes, std::size_t offset) {
  return std::to_integer<std::size_t>(bytes[offset]) << 8 |
         std::to_integer<std::size_t>(bytes[offset + 1]);
}

std::size_t data_bytes(ByteView command) {
  switch (kind_of(command[0])) {
    case 6:
      return number16(command, 4);
    case 8:
    case 9:
      return number16(command, 6);
    default:
      return 0;
  }
}

// Only whole commands of a session have passed, and not too many of them.
void check_passed(ByteView commands) {
  std::size_t count = 0;
  for (; !commands.empty(); ++count) {
    const std::size_t size = k_sizes[kind_of(commands[0])];
    LKS_CHECK(size != 0 && size <= commands.size());
    const std::size_t whole = size + data_bytes(commands);
    LKS_CHECK(whole <= commands.size());
    commands = commands.subspan(whole);
  }
  LKS_CHECK(count <= CommandFilter::k_max_commands);
}

bool run(ByteView bytes) {
  if (bytes.size() < k_input_head) return false;
  auto delivered = static_cast<std::uint16_t>(number16(bytes, 0));
  const bool called = bytes[2] != std::byte{0};
  const std::size_t limit =
      called ? CommandFilter::k_max_waiting_of_server : CommandFilter::k_max_waiting;
  bytes = bytes.subspan(k_input_head);
  CommandFilter filter;
  bool any = false;
  while (bytes.size() >= k_datagram_head) {
    delivered = static_cast<std::uint16_t>(delivered + std::to_integer<unsigned>(bytes[0]));
    const std::size_t size = std::min(number16(bytes, 1), bytes.size() - k_datagram_head);
    const ByteView commands = bytes.subspan(k_datagram_head, size);
    const Verdict verdict = filter.admit(commands, delivered, called);
    LKS_CHECK(filter.waiting() <= limit);
    if (verdict == Verdict::pass) check_passed(commands);
    any = any || (verdict == Verdict::pass && !commands.empty());
    bytes = bytes.subspan(k_datagram_head + size);
  }
  return any;
}

// Kinds keep their usual flags and channels, which would hide all behind them.
void mend(Bytes& bytes) {
  std::size_t at = k_input_head;
  while (at + k_datagram_head <= bytes.size()) {
    const std::size_t end = std::min(bytes.size(), at + k_datagram_head + number16(bytes, at + 1));
    at += k_datagram_head;
    while (at < end) {
      const std::size_t kind = kind_of(bytes[at]), size = k_sizes[kind];
      if (size == 0 || size > end - at) break;
      const bool leaves = kind == 4 && (bytes[at] & std::byte{0xf0}) == std::byte{0x40};
      if (!leaves) bytes[at] = static_cast<std::byte>(k_flags[kind] | kind);
      const bool on_first = kind == 6 || kind == 8 || (kind == 1 && bytes[at + 1] == std::byte{0});
      bytes[at + 1] = on_first ? std::byte{0} : kind == 9 ? std::byte{1} : std::byte{0xff};
      at += size + data_bytes(ByteView(bytes).subspan(at));
    }
    at = end;
  }
}

void put(Bytes& bytes, std::initializer_list<unsigned> values) {
  for (const unsigned value : values)
    bytes.push_back(static_cast<std::byte>(value));
}

void put32(Bytes& bytes, std::initializer_list<std::uint32_t> values) {
  for (const std::uint32_t value : values)
    put(bytes, {value >> 24, value >> 16, value >> 8, value});
}

void append(Bytes& input, const Bytes& commands, unsigned delivered = 0) {
  const auto size = static_cast<unsigned>(commands.size());
  put(input, {delivered, size >> 8, size & 0xff});
  input.insert(input.end(), commands.begin(), commands.end());
}

Bytes reliable(unsigned sequence) {
  Bytes bytes;
  put(bytes, {0x86, 0, sequence >> 8, sequence & 0xff, 0, 1, 7});
  return bytes;
}

Bytes fragment(unsigned first, unsigned number) {
  constexpr std::uint32_t k_full = net::k_enet_fragment_bytes, k_rest = 5;
  const unsigned sequence = first + number, size = number == 0 ? k_full : k_rest;
  Bytes bytes;
  put(bytes, {0x88, 0, sequence >> 8, sequence & 0xff, first >> 8, first & 0xff, size >> 8, size});
  put32(bytes, {2, number, k_full + k_rest, number * k_full});
  bytes.resize(bytes.size() + size);
  return bytes;
}

// One of each kind, as ENet sends them.
Bytes usual() {
  Bytes commands;
  put(commands, {0x01, 0, 0, 5, 0, 5, 0, 100, 0x01, 0xff, 0, 5, 0, 5, 0, 100});
  put(commands, {0x85, 0xff, 0, 3, 0x49, 1, 0, 0, 0, 9, 0, 1, 7});
  put(commands, {0x8a, 0xff, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0x8b, 0xff, 0, 4});
  put32(commands, {net::k_enet_throttle_interval_ms, net::k_enet_throttle_acceleration, 0});
  put(commands, {0x84, 0xff, 0, 2, 0, 0, 0, 0, 0x44, 0xff, 0, 0, 0, 0, 0, 0});
  Bytes input;
  put(input, {0, 0, 0});
  append(input, commands);
  return input;
}

Bytes answer() {
  Bytes commands, input;
  put(commands, {0x83, 0xff, 0, 1, 0, 0, 0, 1});
  put32(commands, {net::k_enet_mtu, net::k_enet_window_bytes, net::k_enet_channels, 0, 0,
                   net::k_enet_throttle_interval_ms, net::k_enet_throttle_acceleration,
                   net::k_enet_throttle_deceleration, 77});
  put(input, {0, 0, 1});
  append(input, commands);
  return input;
}

// Across the wrap of the numbers: a full queue behind a gap, the lowest again, then the gap closes.
Bytes queue() {
  Bytes input;
  put(input, {0xff, 0xf0, 0});
  for (unsigned i = 0; i < CommandFilter::k_max_waiting + 1; ++i)
    append(input, reliable((0xfff2 + i) & 0xffff));
  append(input, reliable(0xfff2));
  append(input, reliable(0xfff1), 70);
  return input;
}

Bytes fragments() {
  Bytes input;
  put(input, {0, 9, 0});
  append(input, fragment(11, 0));
  append(input, fragment(11, 1));
  append(input, reliable(12));
  append(input, reliable(10));
  return input;
}

std::vector<Bytes> seeds() {
  return {usual(), answer(), queue(), fragments()};
}

const Registration k_registration{{.name = "enet", .seeds = seeds, .mend = mend, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
