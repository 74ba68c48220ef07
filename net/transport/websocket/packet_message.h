// Packets as messages of a WebSocket: one byte for the channel, then the payload. Bytes:
// docs/reference/wire-format.md, "WebSockets".
#pragma once

#include <cstddef>
#include <optional>

#include <lockstone/bytes.h>
#include <lockstone/net/reasons.h>
#include <lockstone/net/transport.h>

namespace lockstone::net {

inline constexpr std::size_t k_message_head_bytes = 1;
inline constexpr std::size_t k_max_websocket_bytes =
    k_message_head_bytes + k_max_reliable_bytes + k_carrier_reserve_bytes;
inline constexpr const char* k_websocket_protocol = "lockstone";

/// A peer that is refused is told why by the code that closes its WebSocket: this, and the reason.
inline constexpr unsigned k_close_reason_base = 4000;

[[nodiscard]] inline RefuseReason reason_of_close(unsigned code) {
  const unsigned last = k_close_reason_base + static_cast<unsigned>(k_last_refuse_reason);
  if (code < k_close_reason_base || code > last) return RefuseReason::none;
  return static_cast<RefuseReason>(code - k_close_reason_base);
}

[[nodiscard]] inline std::size_t max_payload_bytes(Channel channel) {
  const std::size_t most =
      channel == Channel::reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
  return most + k_carrier_reserve_bytes;
}

struct PacketMessage {
  Channel channel = Channel::reliable;
  ByteView payload;
};

/// Nothing: no channel of this number, or a payload that is empty or too long.
[[nodiscard]] inline std::optional<PacketMessage> read_message(ByteView message) {
  if (message.size() <= k_message_head_bytes) return std::nullopt;
  const auto number = std::to_integer<unsigned>(message.front());
  if (number > static_cast<unsigned>(Channel::unreliable)) return std::nullopt;
  const PacketMessage read{static_cast<Channel>(number), message.subspan(k_message_head_bytes)};
  if (read.payload.size() > max_payload_bytes(read.channel)) return std::nullopt;
  return read;
}

}  // namespace lockstone::net
