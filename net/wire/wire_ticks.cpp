// The messages that carry inputs and closed ticks.
#include <lockstone/net/wire.h>

#include "net/wire/record_coder.h"
#include "net/wire/tick_record.h"
#include "net/wire/wire_io.h"

namespace lockstone::net {

std::size_t encode(const Inputs& message, std::span<std::byte> out) {
  if (message.hash_count > k_max_hashes_per_message) return 0;
  WireWriter writer(MessageType::inputs, out);
  writer.put(message.ticks_received);
  writer.put(message.first_tick);
  writer.put(message.count);
  writer.put(message.first_hash_tick);
  writer.put(message.hash_count);
  for (std::size_t i = 0; i < message.hash_count; ++i)
    writer.put(message.hashes[i]);
  writer.put_bytes(message.coded);
  return writer.finish();
}

Status decode(ByteView packet, std::size_t input_bytes, Inputs& message) {
  WireReader reader(MessageType::inputs, packet);
  message.ticks_received = reader.get_tick();
  message.first_tick = reader.get_tick();
  message.count = reader.get<std::uint8_t>();
  message.first_hash_tick = reader.get_tick();
  message.hash_count = reader.get<std::uint8_t>();
  if (message.hash_count > k_max_hashes_per_message) return Status::malformed;
  for (std::size_t i = 0; i < message.hash_count; ++i) {
    message.hashes[i] = reader.get<std::uint64_t>();
  }
  message.coded = reader.get_rest();
  RecordReader records(message.coded, input_bytes);
  for (std::size_t i = 0; i < message.count; ++i)
    reader.require(records.next());
  reader.require(records.at_end());
  return reader.finish();
}

std::size_t encode(const Ticks& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::ticks, out);
  writer.put(message.first_tick);
  writer.put(message.count);
  writer.put(message.ticks_closed);
  writer.put(message.inputs_received);
  writer.put(message.hashes_received);
  writer.put(message.waiting_mask);
  writer.put(static_cast<std::uint8_t>(message.margin_quarters));
  writer.put_bytes(message.coded);
  return writer.finish();
}

Status decode(ByteView packet, TickShape shape, Ticks& message) {
  WireReader reader(MessageType::ticks, packet);
  message.first_tick = reader.get_tick();
  message.count = reader.get<std::uint8_t>();
  message.ticks_closed = reader.get_tick();
  message.inputs_received = reader.get_tick();
  message.hashes_received = reader.get_tick();
  message.waiting_mask = reader.get<std::uint16_t>();
  message.margin_quarters = static_cast<std::int8_t>(reader.get<std::uint8_t>());
  reader.require(message.first_tick + message.count <= message.ticks_closed);
  reader.require(message.hashes_received <= message.ticks_closed);
  message.coded = reader.get_rest();
  RecordReader records(message.coded, shape.record_bytes());
  for (std::size_t i = 0; i < message.count; ++i) {
    const bool found = records.next();
    reader.require(found && valid_record(records.record(), shape));
  }
  reader.require(records.at_end());
  return reader.finish();
}

std::size_t encode(const Resend& message, std::span<std::byte> out) {
  WireWriter writer(MessageType::resend, out);
  writer.put(message.first_tick);
  writer.put(message.count);
  return writer.finish();
}

Status decode(ByteView packet, Resend& message) {
  WireReader reader(MessageType::resend, packet);
  message.first_tick = reader.get_tick();
  message.count = reader.get<std::uint16_t>();
  reader.require(message.count > 0);
  return reader.finish();
}

}  // namespace lockstone::net
