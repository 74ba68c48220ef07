// The records of EVENT and END chunks as bytes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/replay/format.h>

#include "replay/codec/decode_fault.h"

namespace lockstone::replay {

/// Bytes of an event record without its text, and of the END payload without its reason.
inline constexpr std::size_t k_event_fixed_bytes = 12;
inline constexpr std::size_t k_end_fixed_bytes = 71;

/// Writes text cut to k_max_text_bytes, with control bytes replaced by '?', after its length (u16).
void put_text(ByteWriter& writer, std::string_view text);

/// Bytes that encode_event() writes.
[[nodiscard]] std::size_t event_bytes(std::string_view text);

void encode_event(ByteWriter& writer, std::uint64_t tick, EventKind kind, std::uint8_t slot,
                  std::string_view text);

/// Replaces `events`. `count` is the chunk's claim and is not trusted.
[[nodiscard]] DecodeFault decode_events(ByteView payload, std::uint32_t count,
                                        std::size_t player_count, std::vector<LogEvent>& events);

void encode_end(ByteWriter& writer, const LogEnd& end, std::string_view reason);

[[nodiscard]] DecodeFault decode_end(ByteView payload, LogEnd& end);

}  // namespace lockstone::replay
