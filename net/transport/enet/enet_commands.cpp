#include "net/transport/enet/enet_commands.h"

#include <algorithm>

#include <lockstone/net/transport.h>

namespace lockstone::net {
namespace {

enum Kind : std::uint8_t {
  k_acknowledge = 1,
  k_connect = 2,
  k_verify_connect = 3,
  k_disconnect = 4,
  k_ping = 5,
  k_send_reliable = 6,
  k_send_fragment = 8,
  k_send_unsequenced = 9,
  k_bandwidth_limit = 10,
  k_throttle_configure = 11,
};
constexpr std::uint8_t k_kind_mask = 0x0f;
constexpr std::uint8_t k_wants_acknowledgement = 0x80;
constexpr std::uint8_t k_is_unsequenced = 0x40;

// By kind. 0: a session never sends it, such as ENet's unreliable commands, which it would sort.
constexpr std::array<std::uint8_t, 16> k_sizes{0, 8, 0, 44, 8, 4, 6, 0, 24, 8, 12, 16, 0, 0, 0, 0};

constexpr std::uint8_t k_no_channel = 0xff;
constexpr std::size_t k_head_bytes = 4;
constexpr std::uint16_t k_half_circle = 0x8000;
constexpr std::uint32_t k_max_packet_bytes = k_max_reliable_bytes + k_carrier_reserve_bytes;

std::uint16_t number16(ByteView bytes, std::size_t offset) {
  return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[offset]) << 8 |
                                    std::to_integer<unsigned>(bytes[offset + 1]));
}

std::uint32_t number32(ByteView bytes, std::size_t offset) {
  return std::uint32_t{number16(bytes, offset)} << 16 | number16(bytes, offset + 2);
}

// How far `number` lies beyond `origin` on the circle of 2^16.
std::uint16_t ahead_of(std::uint16_t origin, std::uint16_t number) {
  return static_cast<std::uint16_t>(number - origin);
}

}  // namespace

struct CommandFilter::Command {
  ByteView bytes;  ///< without data
  std::uint32_t data_bytes = 0;

  [[nodiscard]] std::uint8_t kind() const { return first_byte() & k_kind_mask; }
  [[nodiscard]] std::uint8_t flags() const {
    return static_cast<std::uint8_t>(first_byte() & ~k_kind_mask);
  }
  [[nodiscard]] std::uint8_t channel() const { return std::to_integer<std::uint8_t>(bytes[1]); }
  [[nodiscard]] std::uint16_t sequence() const { return number16(bytes, 2); }

 private:
  [[nodiscard]] std::uint8_t first_byte() const { return std::to_integer<std::uint8_t>(bytes[0]); }
};

namespace {

// Takes the next command and its data off `rest`. False if there is no whole command.
template <class Command>
bool take_command(ByteView& rest, Command& command) {
  if (rest.size() < k_head_bytes) return false;
  const std::uint8_t kind = std::to_integer<std::uint8_t>(rest[0]) & k_kind_mask;
  const std::size_t size = k_sizes[kind];
  if (size == 0 || rest.size() < size) return false;
  command.bytes = rest.first(size);
  command.data_bytes = 0;
  if (kind == k_send_reliable) command.data_bytes = number16(rest, 4);
  if (kind == k_send_fragment || kind == k_send_unsequenced) {
    command.data_bytes = number16(rest, 6);
  }
  if (rest.size() < size + command.data_bytes) return false;
  rest = rest.subspan(size + command.data_bytes);
  return true;
}

bool has_usual_flags(std::uint8_t kind, std::uint8_t flags, std::uint8_t channel) {
  switch (kind) {
    case k_acknowledge:
      return flags == 0 && (channel == 0 || channel == k_no_channel);
    case k_disconnect:
      return (flags == k_wants_acknowledgement || flags == k_is_unsequenced) &&
             channel == k_no_channel;
    case k_send_reliable:
    case k_send_fragment:
      return flags == k_wants_acknowledgement && channel == 0;
    case k_send_unsequenced:
      return flags == k_is_unsequenced && channel == 1;
    default:
      return flags == k_wants_acknowledgement && channel == k_no_channel;
  }
}

// Channels, bandwidths and throttle, which a request for a connection and its answer both have.
bool has_usual_terms(ByteView bytes) {
  return number32(bytes, 0) == k_enet_channels && number32(bytes, 4) == 0 &&
         number32(bytes, 8) == 0 && number32(bytes, 12) == k_enet_throttle_interval_ms &&
         number32(bytes, 16) == k_enet_throttle_acceleration &&
         number32(bytes, 20) == k_enet_throttle_deceleration;
}

// As ENet cuts packets: all fragments full but the last.
bool is_usual_fragment(ByteView bytes, std::uint32_t data_bytes) {
  const std::uint32_t count = number32(bytes, 8), number = number32(bytes, 12);
  const std::uint32_t total = number32(bytes, 16), offset = number32(bytes, 20);
  if (total <= k_enet_fragment_bytes || total > k_max_packet_bytes) return false;
  if (count != (total + k_enet_fragment_bytes - 1) / k_enet_fragment_bytes) return false;
  if (number >= count || offset != number * k_enet_fragment_bytes) return false;
  if (data_bytes != std::min(k_enet_fragment_bytes, total - offset)) return false;
  return number16(bytes, 2) == static_cast<std::uint16_t>(number16(bytes, 4) + number);
}

}  // namespace

bool is_usual_connect(ByteView command) {
  return number32(command, 8) == k_enet_mtu && number32(command, 12) == k_enet_window_bytes &&
         has_usual_terms(command.subspan(16));
}

CommandFilter::Verdict CommandFilter::admit(ByteView commands, std::uint16_t delivered,
                                            bool called) {
  forget_delivered(delivered);
  for (std::size_t count = 0; !commands.empty(); ++count) {
    Command command;
    if (count == k_max_commands || !take_command(commands, command)) return Verdict::malformed;
    const Verdict verdict = judge(command, delivered, called);
    if (verdict != Verdict::pass) return verdict;
  }
  return Verdict::pass;
}

CommandFilter::Verdict CommandFilter::judge(const Command& command, std::uint16_t delivered,
                                            bool called) {
  const auto pass_if = [](bool good) { return good ? Verdict::pass : Verdict::malformed; };
  const ByteView bytes = command.bytes;
  const std::size_t limit = called ? k_max_waiting_of_server : k_max_waiting;
  if (!has_usual_flags(command.kind(), command.flags(), command.channel())) {
    return Verdict::malformed;
  }
  switch (command.kind()) {
    case k_verify_connect:
      return pass_if(called && number32(bytes, 8) == k_enet_mtu &&
                     has_usual_terms(bytes.subspan(16)));
    case k_send_reliable:
      if (command.data_bytes == 0) return Verdict::malformed;
      return reserve({command.sequence(), 1}, delivered, limit);
    case k_send_fragment:
      if (!is_usual_fragment(bytes, command.data_bytes)) return Verdict::malformed;
      return reserve({number16(bytes, 4), number16(bytes, 10)}, delivered, limit);
    case k_send_unsequenced:
      return pass_if(command.data_bytes > 0);
    case k_bandwidth_limit:
      return pass_if(number32(bytes, 4) == 0 && number32(bytes, 8) == 0);
    case k_throttle_configure:
      return pass_if(number32(bytes, 4) == k_enet_throttle_interval_ms &&
                     number32(bytes, 8) == k_enet_throttle_acceleration &&
                     number32(bytes, 12) == 0);
    default:
      return Verdict::pass;
  }
}

// ENet acknowledges packets that it has delivered before and does not store them again.
CommandFilter::Verdict CommandFilter::reserve(Packet packet, std::uint16_t delivered,
                                              std::size_t limit) {
  const std::uint16_t first = ahead_of(delivered, packet.first);
  if (first == 0 || first >= k_half_circle) return Verdict::pass;
  if (first + packet.count > k_max_ahead) return Verdict::too_far;
  for (std::size_t i = 0; i < waiting_count_; ++i) {
    const std::uint16_t other = ahead_of(delivered, waiting_[i].first);
    if (other == first && waiting_[i].count == packet.count) return Verdict::pass;
    if (first < other + waiting_[i].count && other < first + packet.count) {
      return Verdict::malformed;
    }
  }
  if (waiting_count_ == limit) return Verdict::too_far;
  waiting_[waiting_count_++] = packet;
  return Verdict::pass;
}

void CommandFilter::forget_delivered(std::uint16_t delivered) {
  const auto end = waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_);
  const auto kept = std::remove_if(waiting_.begin(), end, [delivered](const Packet& packet) {
    const std::uint16_t first = ahead_of(delivered, packet.first);
    return first == 0 || first >= k_half_circle;
  });
  waiting_count_ = static_cast<std::size_t>(kept - waiting_.begin());
}

}  // namespace lockstone::net
