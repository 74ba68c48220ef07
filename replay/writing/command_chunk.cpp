#include "replay/writing/command_chunk.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "replay/codec/command_codec.h"

namespace lockstone::replay {
namespace {

constexpr std::size_t k_room_bytes = k_chunk_header_bytes + k_max_command_chunk_bytes;

std::size_t record_bytes(std::span<const PlayerCommand> commands) {
  std::size_t bytes = 0;
  for (const PlayerCommand& command : commands)
    bytes += k_command_fixed_bytes + command.bytes.size();
  return bytes;
}

}  // namespace

CommandChunk::CommandChunk()
    : bytes_(new std::byte[k_room_bytes]),
      end_(k_chunk_header_bytes),
      next_end_(k_chunk_header_bytes) {
  next_.reserve(k_max_tick_commands);
}

std::span<std::byte> CommandChunk::room() const {
  return {bytes_.get(), k_room_bytes};
}

bool CommandChunk::takes(std::span<const PlayerCommand> commands, std::size_t players) const {
  const bool good =
      std::all_of(commands.begin(), commands.end(),
                  [players](const PlayerCommand& command) { return is_command(command, players); });
  const std::size_t bytes = next_end_ - end_ + record_bytes(commands);
  return good && next_.size() + commands.size() <= k_max_tick_commands &&
         bytes <= k_max_command_chunk_bytes;
}

bool CommandChunk::has_room(std::span<const PlayerCommand> commands) const {
  return record_bytes(commands) <= k_room_bytes - next_end_;
}

void CommandChunk::add(std::uint64_t tick, std::span<const PlayerCommand> commands) {
  for (const PlayerCommand& command : commands) {
    ByteWriter writer(room().subspan(next_end_));
    encode_command(writer, tick, command);
    LKS_CHECK(writer.ok());
    next_end_ += writer.size();
    next_.push_back({command.slot, writer.written().last(command.bytes.size())});
  }
}

void CommandChunk::note_tick() {
  end_ = next_end_;
  count_ += static_cast<std::uint32_t>(next_.size());
  next_.clear();
}

std::span<std::byte> CommandChunk::seal(ChunkWriter& writer, std::uint64_t first_tick) {
  const std::span<std::byte> chunk = room().first(end_);
  writer.seal({.type = ChunkType::command, .count = count_, .first_tick = first_tick}, chunk);
  return chunk;
}

// The commands of the next tick move to the beginning.
void CommandChunk::restart() {
  const std::size_t moved = end_ - k_chunk_header_bytes;
  const std::span<std::byte> next = room().subspan(end_, next_end_ - end_);
  std::copy(next.begin(), next.end(), room().subspan(k_chunk_header_bytes).begin());
  for (PlayerCommand& command : next_)
    command.bytes = {command.bytes.data() - moved, command.bytes.size()};
  next_end_ -= moved;
  end_ = k_chunk_header_bytes;
  count_ = 0;
}

}  // namespace lockstone::replay
