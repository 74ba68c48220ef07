// Every message of a session. Decodable bytes must be the only coding of their message: encoding it
// gives the same bytes.

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/net/wire.h>

#include "net/wire/record_coder.h"
#include "tests/fuzz/target.h"

namespace lockstone::fuzz {
namespace {

using namespace net;

constexpr TickShape k_shape{3, 5};

template <class Message>
Bytes bytes_of(const Message& message) {
  Bytes bytes(k_max_message_bytes);
  bytes.resize(encode(message, bytes));
  return bytes;
}

template <class Message>
bool has_one_coding(const Message& message, ByteView packet) {
  const Bytes again = bytes_of(message);
  LKS_CHECK(std::equal(again.begin(), again.end(), packet.begin(), packet.end()));
  return true;
}

template <class Message>
bool run_plain(ByteView packet) {
  Message message;
  return decode(packet, message) == Status::ok && has_one_coding(message, packet);
}

bool run_hello(ByteView packet) {
  Hello message;
  if (decode(packet, message) != Status::ok) return false;
  // Of another version only the beginning is read.
  return message.protocol != k_protocol_version || has_one_coding(message, packet);
}

// Records may be coded in several ways; they must fit the header.
bool run_inputs(ByteView packet) {
  Inputs message;
  if (decode(packet, k_shape.input_bytes, message) != Status::ok) return false;
  RecordReader records(message.coded, k_shape.input_bytes);
  for (std::size_t i = 0; i < message.count; ++i)
    LKS_CHECK(records.next());
  return has_one_coding(message, packet);
}

bool run_ticks(ByteView packet) {
  Ticks message;
  return decode(packet, k_shape, message) == Status::ok && has_one_coding(message, packet);
}

bool run(ByteView packet) {
  const Result<MessageType> type = message_type(packet);
  if (!type) return false;
  switch (type.value()) {
    case MessageType::hello:
      return run_hello(packet);
    case MessageType::offer:
      return run_plain<Offer>(packet);
    case MessageType::answer:
      return run_plain<Answer>(packet);
    case MessageType::welcome:
      return run_plain<Welcome>(packet);
    case MessageType::refuse:
      return run_plain<Refuse>(packet);
    case MessageType::start:
      return run_plain<Start>(packet);
    case MessageType::inputs:
      return run_inputs(packet);
    case MessageType::ticks:
      return run_ticks(packet);
    case MessageType::resend:
      return run_plain<Resend>(packet);
    case MessageType::desync:
      return run_plain<DesyncNotice>(packet);
    case MessageType::dump_request:
      return run_plain<DumpRequest>(packet);
    case MessageType::dump:
      return run_plain<Dump>(packet);
    case MessageType::finish:
      return run_plain<Finish>(packet);
    case MessageType::bye:
      return run_plain<Bye>(packet);
    case MessageType::snapshot:
      return run_plain<Snapshot>(packet);
    case MessageType::snapshot_taken:
      return run_plain<SnapshotTaken>(packet);
    case MessageType::activate:
      return run_plain<Activate>(packet);
    case MessageType::ask:
      return run_plain<Ask>(packet);
    case MessageType::paused:
      return run_plain<Paused>(packet);
    case MessageType::parts:
      return run_plain<Parts>(packet);
    case MessageType::command:
      return run_plain<CommandPiece>(packet);
    case MessageType::tick_command:
      return run_plain<TickCommand>(packet);
    case MessageType::command_result:
      return run_plain<CommandResult>(packet);
    case MessageType::named:
      return run_plain<Named>(packet);
    default:
      return false;
  }
}

Inputs sample_inputs() {
  static const std::array coded{std::byte{0x80}, std::byte{0x11}, std::byte{5}, std::byte{6},
                                std::byte{0x02}};
  Inputs inputs;
  inputs.first_tick = 7;
  inputs.count = 4;
  inputs.first_hash_tick = 5;
  inputs.hash_count = 2;
  inputs.coded = coded;
  return inputs;
}

Ticks sample_ticks() {
  // The second player was late: its input is repeated.
  static const std::array coded{std::byte{0x80}, std::byte{0x03}, std::byte{0x00}, std::byte{0x00},
                                std::byte{0x04}, std::byte{9},    std::byte{0x01}};
  Ticks ticks;
  ticks.first_tick = 3;
  ticks.count = 3;
  ticks.ticks_confirmed = 6;
  ticks.inputs_received = 9;
  ticks.coded = coded;
  return ticks;
}

std::vector<Bytes> seeds() {
  static const std::array chunk{std::byte{1}, std::byte{2}, std::byte{3}};
  Hello hello;
  hello.name = PlayerName("A");
  Welcome welcome;
  welcome.player_count = 3;
  DesyncNotice notice;
  notice.differs = true;
  notice.field = FieldText("velocity.y");
  return {bytes_of(hello),
          bytes_of(Offer{false, chunk}),
          bytes_of(Answer{}),
          bytes_of(welcome),
          bytes_of(Refuse{RefuseReason::match_full, RefuseField::none, 1, 2}),
          bytes_of(Start{3}),
          bytes_of(sample_inputs()),
          bytes_of(sample_ticks()),
          bytes_of(Resend{4, 9}),
          bytes_of(notice),
          bytes_of(DumpRequest{8}),
          bytes_of(Dump{8, 3, 0, chunk}),
          bytes_of(Finish{FinishReason::completed, 9, true, 77}),
          bytes_of(Bye{LeaveReason::left}),
          bytes_of(Snapshot{8, 77, 3, 0, chunk}),
          bytes_of(SnapshotTaken{8, true}),
          bytes_of(Activate{2, 90}),
          bytes_of(Ask{AskKind::vote, 1, 2}),
          bytes_of(Paused{true}),
          bytes_of(Parts{128, 2, {{{1, 2}, {3, 4}}}}),
          bytes_of(Named{2, PlayerName("Zo\u00eb")}),
          bytes_of(CommandPiece{5, 2, chunk}),
          bytes_of(TickCommand{9, k_server_slot, 5, 2, chunk}),
          bytes_of(CommandResult{3, true})};
}

const Registration k_registration{{.name = "wire", .seeds = seeds, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
