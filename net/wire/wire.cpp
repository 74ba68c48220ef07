// Every message from its list of fields (wire_fields.h).
#include <lockstone/net/wire.h>

#include "net/wire/record_coder.h"
#include "net/wire/tick_record.h"
#include "net/wire/wire_fields.h"
#include "net/wire/wire_io.h"

namespace lockstone::net {
namespace {

template <class Message>
std::size_t encode_fields(MessageType type, const Message& message, std::span<std::byte> out) {
  WireWriter writer(type, out);
  fields(writer, message, message);
  return writer.finish();
}

template <class Message>
Status decode_fields(MessageType type, ByteView packet, Message& message) {
  message = {};
  WireReader reader(type, packet);
  fields(reader, message, message);
  return reader.finish();
}

// Whether `coded` is `count` records, each of which `is_valid` accepts, and no more.
template <class IsValid>
bool holds_records(ByteView coded, std::size_t record_bytes, std::size_t count,
                   IsValid&& is_valid) {
  RecordReader records(coded, record_bytes);
  for (std::size_t i = 0; i < count; ++i)
    if (!records.next() || !is_valid(records.record())) return false;
  return records.at_end();
}

}  // namespace

Result<MessageType> message_type(ByteView packet) {
  if (packet.empty()) return Status::truncated;
  const auto type = std::to_integer<std::uint8_t>(packet[0]);
  if (type < static_cast<std::uint8_t>(MessageType::hello)) return Status::malformed;
  if (type > static_cast<std::uint8_t>(MessageType::command_result)) return Status::malformed;
  return static_cast<MessageType>(type);
}

// The messages that decode by themselves, each with its type.
#define LKS_MESSAGES(X)            \
  X(Hello, hello)                  \
  X(Offer, offer)                  \
  X(Answer, answer)                \
  X(Welcome, welcome)              \
  X(Refuse, refuse)                \
  X(Start, start)                  \
  X(Resend, resend)                \
  X(DesyncNotice, desync)          \
  X(DumpRequest, dump_request)     \
  X(Dump, dump)                    \
  X(Finish, finish)                \
  X(Bye, bye)                      \
  X(Snapshot, snapshot)            \
  X(SnapshotTaken, snapshot_taken) \
  X(Activate, activate)            \
  X(Ask, ask)                      \
  X(Paused, paused)                \
  X(Parts, parts)                  \
  X(Named, named)                  \
  X(CommandPiece, command)         \
  X(TickCommand, tick_command)     \
  X(CommandResult, command_result)

#define LKS_DEFINE_CODEC(Name, type)                                  \
  std::size_t encode(const Name& message, std::span<std::byte> out) { \
    return encode_fields(MessageType::type, message, out);            \
  }                                                                   \
  Status decode(ByteView packet, Name& message) {                     \
    return decode_fields(MessageType::type, packet, message);         \
  }
LKS_MESSAGES(LKS_DEFINE_CODEC)
#undef LKS_DEFINE_CODEC
#undef LKS_MESSAGES

std::size_t encode(const Inputs& message, std::span<std::byte> out) {
  return encode_fields(MessageType::inputs, message, out);
}

Status decode(ByteView packet, std::size_t input_bytes, Inputs& message) {
  const Status status = decode_fields(MessageType::inputs, packet, message);
  if (status != Status::ok) return status;
  const bool valid =
      holds_records(message.coded, input_bytes, message.count, [](ByteView) { return true; });
  return valid ? Status::ok : Status::malformed;
}

std::size_t encode(const Ticks& message, std::span<std::byte> out) {
  return encode_fields(MessageType::ticks, message, out);
}

Status decode(ByteView packet, TickShape shape, Ticks& message) {
  const Status status = decode_fields(MessageType::ticks, packet, message);
  if (status != Status::ok) return status;
  const bool valid = holds_records(message.coded, shape.record_bytes(), message.count,
                                   [&](ByteView record) { return valid_record(record, shape); });
  return valid ? Status::ok : Status::malformed;
}

}  // namespace lockstone::net
