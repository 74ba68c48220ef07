// The commands of a peer, checked before ENet sees them. ENet 1.3 searches lists that a peer can
// fill, and takes values that a peer chooses: only commands in the form that ENet itself sends for
// a session pass, at most as many as ENet puts into one datagram, and few out of order.
// Layouts: ENet 1.3 (Lee Salzman), include/enet/protocol.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <lockstone/bytes.h>

namespace lockstone::net {

/// The settings of ENet at both ends, and therefore the limits that each may demand of the other.
inline constexpr std::uint32_t k_enet_channels = 2;
inline constexpr std::uint32_t k_enet_mtu = 1400;
inline constexpr std::uint32_t k_enet_window_bytes = 65536;
inline constexpr std::uint32_t k_enet_throttle_interval_ms = 5000;
inline constexpr std::uint32_t k_enet_throttle_acceleration = 2;
inline constexpr std::uint32_t k_enet_throttle_deceleration = 2;  ///< until a connection stands
inline constexpr std::uint32_t k_enet_fragment_bytes = k_enet_mtu - 4 - 4 - 24;

/// True if these 48 bytes are ENet's request for a connection as this transport makes it. The last
/// four may be anything.
[[nodiscard]] bool is_usual_connect(ByteView command);

/// The commands of one peer's datagrams. Knows which reliable packets wait for an earlier one.
class CommandFilter {
 public:
  static constexpr std::size_t k_max_commands = 32;  ///< ENet puts no more into a datagram
  /// Packets of a caller behind a gap. At most 8 pieces of a dump are under way within ENet's
  /// window of 64 KiB, 16 reports of parts while a client catches up with 1024 ticks, and single
  /// messages.
  static constexpr std::size_t k_max_waiting = 32;
  /// Of the side that was called: 54 messages of ticks fit into the window.
  static constexpr std::size_t k_max_waiting_of_server = 64;
  static constexpr std::uint16_t k_max_ahead = 4096;  ///< sequence numbers beyond the gap

  enum class Verdict : std::uint8_t {
    pass,
    malformed,  ///< no honest peer sends this
    too_far,    ///< more waits behind a gap than may; an honest peer sends it again later
  };

  /// Judges all commands of a datagram together. `delivered` is the number of the last reliable
  /// command that ENet has put into order; `called` is true where this side asked for the
  /// connection.
  [[nodiscard]] Verdict admit(ByteView commands, std::uint16_t delivered, bool called);

  /// Packets that have passed and may wait in ENet.
  [[nodiscard]] std::size_t waiting() const { return waiting_count_; }

 private:
  /// A packet occupies `count` sequence numbers from `first` on, one for each fragment.
  struct Packet {
    std::uint16_t first = 0;
    std::uint16_t count = 0;
  };
  struct Command;

  [[nodiscard]] Verdict judge(const Command& command, std::uint16_t delivered, bool called);
  [[nodiscard]] Verdict reserve(Packet packet, std::uint16_t delivered, std::size_t limit);
  void forget_delivered(std::uint16_t delivered);

  std::array<Packet, k_max_waiting_of_server> waiting_{};
  std::size_t waiting_count_ = 0;
};

}  // namespace lockstone::net
