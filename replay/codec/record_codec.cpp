#include "replay/codec/record_codec.h"

#include <algorithm>

#include <lockstone/utf8.h>

#include "replay/codec/field_codec.h"

namespace lockstone::replay {
namespace {

// The integers of an end, in the order of the file.
template <class End, class Visit>
void visit_end(End& end, Visit visit) {
  visit(end.final_tick);
  visit(end.final_hash);
  visit(end.ticks);
  visit(end.events);
  visit(end.keyframes);
  visit(end.kind);
}

DecodeFault get_text(ByteReader& reader, std::string& text) {
  const std::size_t start = reader.position();
  const std::size_t length = reader.get<std::uint16_t>();
  if (length > k_max_text_bytes) return malformed(start, "text too long");
  const ByteView bytes = reader.get_bytes(length);
  if (!reader.ok()) return malformed(start, "record ends early");
  if (!is_text(bytes)) return malformed(start, "control byte in text, or no UTF-8");
  text.assign(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return {};
}

DecodeFault decode_event(ByteReader& reader, std::size_t player_count, LogEvent& event) {
  const std::size_t start = reader.position();
  event.tick = reader.get<std::uint64_t>();
  event.kind = static_cast<EventKind>(reader.get<std::uint8_t>());
  event.slot = reader.get<std::uint8_t>();
  const DecodeFault fault = get_text(reader, event.text);
  if (!fault.ok()) return fault;
  if (event.kind == EventKind{0}) return malformed(start + 8, "event kind 0");
  if (event.slot != k_no_slot && event.slot >= player_count) {
    return malformed(start + 9, "event of a slot that does not exist");
  }
  return {};
}

}  // namespace

void put_text(ByteWriter& writer, std::string_view text) {
  const std::string_view kept = text.substr(0, k_max_text_bytes);
  writer.put(static_cast<std::uint16_t>(kept.size()));
  put_as_text(writer, kept);
}

std::size_t event_bytes(std::string_view text) {
  return k_event_fixed_bytes + std::min(text.size(), k_max_text_bytes);
}

void encode_event(ByteWriter& writer, std::uint64_t tick, EventKind kind, std::uint8_t slot,
                  std::string_view text) {
  writer.put(tick);
  writer.put(kind);
  writer.put(slot);
  put_text(writer, text);
}

DecodeFault decode_events(ByteView payload, std::uint32_t count, std::size_t player_count,
                          std::vector<LogEvent>& events) {
  events.clear();
  if (count == 0 || count > payload.size() / k_event_fixed_bytes) {
    return malformed(0, "more or fewer events announced than there are bytes for");
  }
  ByteReader reader(payload);
  for (std::uint32_t i = 0; i < count; ++i) {
    LogEvent event;
    const DecodeFault fault = decode_event(reader, player_count, event);
    if (!fault.ok()) return fault;
    events.push_back(std::move(event));
  }
  if (reader.remaining() != 0) return malformed(reader.position(), "bytes after the last event");
  return {};
}

void encode_end(ByteWriter& writer, const LogEnd& end, std::string_view reason) {
  visit_end(end, put_with(writer));
  writer.put_bytes(end.transcript);
  put_text(writer, reason);
}

DecodeFault decode_end(ByteView payload, LogEnd& end) {
  ByteReader reader(payload);
  visit_end(end, get_with(reader));
  const ByteView transcript = reader.get_bytes(end.transcript.size());
  std::copy(transcript.begin(), transcript.end(), end.transcript.begin());
  if (reader.ok() && end.kind > EndKind::repaired) return malformed(36, "unknown kind of end");
  const DecodeFault fault = get_text(reader, end.reason);
  if (!fault.ok()) return fault;
  if (reader.remaining() != 0) return malformed(reader.position(), "bytes after the reason");
  return {};
}

}  // namespace lockstone::replay
