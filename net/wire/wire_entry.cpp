// The messages of joining late, of pausing, of requests and of parts of the state.
#include <algorithm>

#include <lockstone/net/wire.h>

#include "net/wire/wire_io.h"

namespace lockstone::net {

std::size_t encode(const Snapshot& message, std::span<std::byte> out) {
  if (message.chunk.size() > k_max_chunk_bytes) return 0;
  WireWriter writer(MessageType::snapshot, out);
  writer.put(message.ticks);
  writer.put(message.hash);
  writer.put(message.total_bytes);
  writer.put(message.offset_bytes);
  writer.put(static_cast<std::uint16_t>(message.chunk.size()));
  writer.put_bytes(message.chunk);
  return writer.finish();
}

Status decode(ByteView packet, Snapshot& message) {
  WireReader reader(MessageType::snapshot, packet);
  message.ticks = reader.get_tick();
  message.hash = reader.get<std::uint64_t>();
  message.total_bytes = reader.get<std::uint32_t>();
  message.offset_bytes = reader.get<std::uint32_t>();
  const auto chunk_bytes = reader.get<std::uint16_t>();
  reader.require(chunk_bytes > 0 && chunk_bytes <= k_max_chunk_bytes);
  reader.require(message.offset_bytes <= message.total_bytes);
  reader.require(chunk_bytes <= message.total_bytes - message.offset_bytes);
  message.chunk = reader.get_bytes(chunk_bytes);
  return reader.finish();
}

std::size_t encode(const SnapshotTaken& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::snapshot_taken, out);
  writer.put(message.ticks);
  writer.put_flag(message.good);
  return writer.finish();
}

Status decode(ByteView packet, SnapshotTaken& message) {
  WireReader reader(MessageType::snapshot_taken, packet);
  message.ticks = reader.get_tick();
  message.good = reader.get_flag();
  return reader.finish();
}

std::size_t encode(const Activate& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::activate, out);
  writer.put(message.slot);
  writer.put(message.tick);
  return writer.finish();
}

Status decode(ByteView packet, Activate& message) {
  WireReader reader(MessageType::activate, packet);
  message.slot = reader.get<std::uint8_t>();
  reader.require(message.slot < k_max_players);
  message.tick = reader.get_tick();
  return reader.finish();
}

std::size_t encode(const Ask& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::ask, out);
  writer.put(message.kind);
  writer.put(message.topic);
  writer.put(message.choice);
  return writer.finish();
}

Status decode(ByteView packet, Ask& message) {
  WireReader reader(MessageType::ask, packet);
  message.kind = reader.get_enum(AskKind::vote);
  message.topic = reader.get<std::uint8_t>();
  message.choice = reader.get<std::uint8_t>();
  reader.require(message.kind == AskKind::vote || (message.topic == 0 && message.choice == 0));
  return reader.finish();
}

std::size_t encode(const Paused& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::paused, out);
  writer.put_flag(message.paused);
  return writer.finish();
}

Status decode(ByteView packet, Paused& message) {
  WireReader reader(MessageType::paused, packet);
  message.paused = reader.get_flag();
  return reader.finish();
}

std::size_t encode(const Parts& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::parts, out);
  writer.put(message.ticks);
  writer.put(message.count);
  for (std::size_t part = 0; part < message.count; ++part) {
    writer.put(message.hashes[part].low);
    writer.put(message.hashes[part].high);
  }
  return writer.finish();
}

Status decode(ByteView packet, Parts& message) {
  WireReader reader(MessageType::parts, packet);
  message = {};
  message.ticks = reader.get_tick();
  reader.require(message.ticks > 0 && message.ticks % k_parts_interval_ticks == 0);
  message.count = reader.get<std::uint8_t>();
  reader.require(message.count >= 1 && message.count <= k_max_state_parts);
  const std::size_t count = std::min<std::size_t>(message.count, k_max_state_parts);
  for (std::size_t part = 0; part < count; ++part) {
    message.hashes[part].low = reader.get<std::uint64_t>();
    message.hashes[part].high = reader.get<std::uint64_t>();
  }
  return reader.finish();
}

}  // namespace lockstone::net
