// The messages around a match. Those of its ticks are in wire_ticks.cpp.
#include <lockstone/net/wire.h>

#include "net/wire/wire_io.h"

namespace lockstone::net {

Result<MessageType> message_type(ByteView packet) {
  if (packet.empty()) return Status::truncated;
  const auto type = std::to_integer<std::uint8_t>(packet[0]);
  if (type < static_cast<std::uint8_t>(MessageType::hello)) return Status::malformed;
  if (type > static_cast<std::uint8_t>(MessageType::parts)) return Status::malformed;
  return static_cast<MessageType>(type);
}

std::size_t encode(const Hello& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::hello, out);
  writer.put(k_protocol_magic);
  writer.put(message.protocol);
  writer.put_flag(message.insecure);
  writer.put(message.wanted_slot);
  writer.put(message.rejoin_key);
  writer.put(message.ticks_stepped);
  writer.put(message.state_hash);
  writer.put_text(message.name);
  writer.put_text(message.build);
  return writer.finish();
}

Status decode(ByteView packet, Hello& message) {
  message = {};
  WireReader reader(MessageType::hello, packet);
  reader.require(reader.get<std::uint32_t>() == k_protocol_magic);
  message.protocol = reader.get<std::uint16_t>();
  // Another version may have another layout: all it shares with this one is the beginning.
  if (message.protocol != k_protocol_version) return reader.status();
  message.insecure = reader.get_flag();
  message.wanted_slot = reader.get<std::uint8_t>();
  reader.require(message.wanted_slot < k_max_players || message.wanted_slot == k_any_slot ||
                 message.wanted_slot == k_spectator_slot);
  message.rejoin_key = reader.get<std::uint64_t>();
  message.ticks_stepped = reader.get_tick();
  message.state_hash = reader.get<std::uint64_t>();
  reader.get_text(message.name);
  reader.get_text(message.build);
  return reader.finish();
}

std::size_t encode(const Offer& message, std::span<std::byte> out) {
  if (message.config.size() > k_max_config_bytes) return 0;
  WireWriter writer(MessageType::offer, out);
  writer.put_flag(message.insecure);
  writer.put(static_cast<std::uint16_t>(message.config.size()));
  writer.put_bytes(message.config);
  return writer.finish();
}

Status decode(ByteView packet, Offer& message) {
  WireReader reader(MessageType::offer, packet);
  message.insecure = reader.get_flag();
  const auto config_bytes = reader.get<std::uint16_t>();
  reader.require(config_bytes <= k_max_config_bytes);
  message.config = reader.get_bytes(config_bytes);
  return reader.finish();
}

std::size_t encode(const Answer& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::answer, out);
  writer.put(message.info.abi);
  writer.put(message.info.config_hash);
  writer.put(message.info.scene_hash);
  writer.put(message.info.canary);
  writer.put(message.info.tick_rate);
  writer.put(message.info.player_count);
  writer.put(message.info.input_bytes);
  return writer.finish();
}

Status decode(ByteView packet, Answer& message) {
  WireReader reader(MessageType::answer, packet);
  message.info.abi = reader.get<std::uint32_t>();
  message.info.config_hash = reader.get<std::uint64_t>();
  message.info.scene_hash = reader.get<std::uint64_t>();
  message.info.canary = reader.get<std::uint64_t>();
  message.info.tick_rate = reader.get<std::uint16_t>();
  message.info.player_count = reader.get<std::uint8_t>();
  message.info.input_bytes = reader.get<std::uint8_t>();
  // Ranges are left to the comparison with the server's own values, which names the field.
  return reader.finish();
}

std::size_t encode(const Welcome& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::welcome, out);
  writer.put(message.slot);
  writer.put(message.player_count);
  writer.put(message.input_delay_ticks);
  writer.put(message.late_policy);
  writer.put(message.pacing);
  writer.put(message.tick_count);
  writer.put(message.entry);
  writer.put(message.rejoin_key);
  return writer.finish();
}

Status decode(ByteView packet, Welcome& message) {
  WireReader reader(MessageType::welcome, packet);
  message.slot = reader.get<std::uint8_t>();
  message.player_count = reader.get<std::uint8_t>();
  reader.require(message.player_count <= k_max_players);
  reader.require(message.slot < message.player_count || message.slot == k_spectator_slot);
  message.input_delay_ticks = reader.get<std::uint8_t>();
  reader.require(message.input_delay_ticks <= k_max_input_delay_ticks);
  message.late_policy = reader.get_enum(LatePolicy::strict);
  message.pacing = reader.get_enum(Pacing::fast);
  message.tick_count = reader.get_tick();
  message.entry = reader.get_enum(Entry::snapshot);
  message.rejoin_key = reader.get<std::uint64_t>();
  return reader.finish();
}

std::size_t encode(const Refuse& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::refuse, out);
  writer.put(message.reason);
  writer.put(message.field);
  writer.put(message.here);
  writer.put(message.there);
  return writer.finish();
}

Status decode(ByteView packet, Refuse& message) {
  WireReader reader(MessageType::refuse, packet);
  message.reason = reader.get_enum(k_last_refuse_reason);
  reader.require(message.reason != RefuseReason::none);
  message.field = reader.get_enum(RefuseField::slot);
  message.here = reader.get<std::uint64_t>();
  message.there = reader.get<std::uint64_t>();
  return reader.finish();
}

std::size_t encode(const Start& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::start, out);
  writer.put(message.present_mask);
  return writer.finish();
}

Status decode(ByteView packet, Start& message) {
  WireReader reader(MessageType::start, packet);
  message.present_mask = reader.get<std::uint16_t>();
  reader.require(message.present_mask != 0);
  return reader.finish();
}

std::size_t encode(const DesyncNotice& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::desync, out);
  writer.put(message.tick);
  writer.put(message.slot);
  writer.put(message.verdict);
  writer.put(message.hash_here);
  writer.put(message.hash_there);
  writer.put_flag(message.differs);
  writer.put(message.object);
  for (const FieldText* text :
       {&message.store, &message.name, &message.field, &message.here, &message.there}) {
    writer.put_text(*text);
  }
  return writer.finish();
}

Status decode(ByteView packet, DesyncNotice& message) {
  WireReader reader(MessageType::desync, packet);
  message.tick = reader.get_tick();
  message.slot = reader.get<std::uint8_t>();
  reader.require(message.slot < k_max_players);
  message.verdict = reader.get_enum(Verdict::server_diverged);
  message.hash_here = reader.get<std::uint64_t>();
  message.hash_there = reader.get<std::uint64_t>();
  message.differs = reader.get_flag();
  message.object = reader.get<std::uint64_t>();
  for (FieldText* text :
       {&message.store, &message.name, &message.field, &message.here, &message.there}) {
    reader.get_text(*text);
  }
  return reader.finish();
}

std::size_t encode(const DumpRequest& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::dump_request, out);
  writer.put(message.tick);
  return writer.finish();
}

Status decode(ByteView packet, DumpRequest& message) {
  WireReader reader(MessageType::dump_request, packet);
  message.tick = reader.get_tick();
  return reader.finish();
}

std::size_t encode(const Dump& message, std::span<std::byte> out) {
  if (message.chunk.size() > k_max_chunk_bytes) return 0;
  WireWriter writer(MessageType::dump, out);
  writer.put(message.tick);
  writer.put(message.total_bytes);
  writer.put(message.offset_bytes);
  writer.put(static_cast<std::uint16_t>(message.chunk.size()));
  writer.put_bytes(message.chunk);
  return writer.finish();
}

Status decode(ByteView packet, Dump& message) {
  WireReader reader(MessageType::dump, packet);
  message.tick = reader.get_tick();
  message.total_bytes = reader.get<std::uint32_t>();
  message.offset_bytes = reader.get<std::uint32_t>();
  const auto chunk_bytes = reader.get<std::uint16_t>();
  reader.require(chunk_bytes <= k_max_chunk_bytes);
  reader.require(message.offset_bytes <= message.total_bytes);
  reader.require(chunk_bytes <= message.total_bytes - message.offset_bytes);
  reader.require(chunk_bytes > 0 || message.total_bytes == 0);  // every piece brings progress
  message.chunk = reader.get_bytes(chunk_bytes);
  return reader.finish();
}

std::size_t encode(const Finish& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::finish, out);
  writer.put(message.reason);
  writer.put(message.ticks);
  writer.put_flag(message.has_hash);
  writer.put(message.hash);
  return writer.finish();
}

Status decode(ByteView packet, Finish& message) {
  WireReader reader(MessageType::finish, packet);
  message.reason = reader.get_enum(FinishReason::no_players);
  message.ticks = reader.get_tick();
  message.has_hash = reader.get_flag();
  message.hash = reader.get<std::uint64_t>();
  return reader.finish();
}

std::size_t encode(const Bye& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::bye, out);
  writer.put(message.reason);
  return writer.finish();
}

Status decode(ByteView packet, Bye& message) {
  WireReader reader(MessageType::bye, packet);
  message.reason = reader.get_enum(k_last_leave_reason);
  return reader.finish();
}

}  // namespace lockstone::net
