#include "replay/codec/command_codec.h"

#include <algorithm>

namespace lockstone::replay {

bool is_command(const PlayerCommand& command, std::size_t player_count) {
  const bool is_slot = command.slot < player_count || command.slot == k_server_slot;
  return is_slot && !command.bytes.empty() && command.bytes.size() <= k_max_command_bytes;
}

void encode_command(ByteWriter& writer, std::uint64_t tick, const PlayerCommand& command) {
  writer.put(tick);
  writer.put(command.slot);
  writer.put(static_cast<std::uint32_t>(command.bytes.size()));
  writer.put_bytes(command.bytes);
}

void CommandBlock::clear() {
  bytes_.clear();
  ticks_.clear();
  commands_.clear();
}

DecodeFault CommandBlock::decode(ByteView payload, std::uint32_t count, std::uint64_t first_tick,
                                 std::size_t player_count) {
  clear();
  if (count == 0 || count > payload.size() / k_command_fixed_bytes) {
    return malformed(0, "more or fewer commands announced than there are bytes for");
  }
  bytes_.assign(payload.begin(), payload.end());
  ByteReader reader(bytes_);
  for (std::uint32_t i = 0; i < count; ++i) {
    const DecodeFault fault = decode_one(reader, first_tick, player_count);
    if (!fault.ok()) return fault;
  }
  if (reader.remaining() != 0) return malformed(reader.position(), "bytes after the last command");
  return {};
}

DecodeFault CommandBlock::decode_one(ByteReader& reader, std::uint64_t first_tick,
                                     std::size_t player_count) {
  const std::size_t start = reader.position();
  const auto tick = reader.get<std::uint64_t>();
  PlayerCommand command;
  command.slot = reader.get<std::uint8_t>();
  const std::size_t size = reader.get<std::uint32_t>();
  if (!reader.ok()) return malformed(start, "command ends early");
  if (tick < std::max(first_tick, ticks_.empty() ? 0 : ticks_.back())) {
    return malformed(start, "command of an earlier tick");
  }
  if (size > k_max_command_bytes) return malformed(start + 9, "command too long");
  command.bytes = reader.get_bytes(size);
  if (!reader.ok()) return malformed(start, "command ends early");
  if (!is_command(command, player_count)) {
    return malformed(start + 8, "command of no bytes, or of a slot that does not exist");
  }
  ticks_.push_back(tick);
  commands_.push_back(command);
  return {};
}

std::span<const PlayerCommand> CommandBlock::of(std::uint64_t tick) const {
  const auto [begin, end] = std::equal_range(ticks_.begin(), ticks_.end(), tick);
  return std::span(commands_).subspan(static_cast<std::size_t>(begin - ticks_.begin()),
                                      static_cast<std::size_t>(end - begin));
}

}  // namespace lockstone::replay
