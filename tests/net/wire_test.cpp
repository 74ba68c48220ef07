#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/net/wire.h>

#include "net/transport/random.h"
#include "net/wire/record_coder.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {
namespace {

constexpr TickShape k_shape{3, 5};

// A message's bytes, and a decoder that returns its status and the bytes of encoding it again.
struct Sample {
  const char* name;
  std::vector<std::byte> bytes;
  std::vector<std::byte> (*again)(ByteView packet, Status& status);
};

template <class Message>
std::vector<std::byte> encoded(const Message& message) {
  std::vector<std::byte> out(k_max_message_bytes);
  out.resize(encode(message, out));
  return out;
}

Status decode_any(ByteView packet, Inputs& message) {
  return decode(packet, std::size_t{k_shape.input_bytes}, message);
}
Status decode_any(ByteView packet, Ticks& message) {
  return decode(packet, k_shape, message);
}
template <class Message>
Status decode_any(ByteView packet, Message& message) {
  return decode(packet, message);
}

template <class Message>
Sample sample(const char* name, const Message& message) {
  return {name, encoded(message), [](ByteView packet, Status& status) {
            Message decoded;
            status = decode_any(packet, decoded);
            return status == Status::ok ? encoded(decoded) : std::vector<std::byte>{};
          }};
}

std::vector<std::byte> random_bytes(Random& random, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes)
    byte = static_cast<std::byte>(random.below(256));
  return bytes;
}

Inputs some_inputs(Random& random, std::span<std::byte> room) {
  RecordWriter writer(room, k_shape.input_bytes);
  Inputs inputs{20, 24, 0, 18, 2, {}, {}};
  inputs.hashes[0] = random.next();
  inputs.hashes[1] = random.next();
  std::vector<std::byte> record(k_shape.input_bytes);
  for (int i = 0; i < 12; ++i) {
    if (i % 3 == 0) record = random_bytes(random, k_shape.input_bytes);
    EXPECT_TRUE(writer.add(record));
    ++inputs.count;
  }
  inputs.coded = writer.written();
  return inputs;
}

Ticks some_ticks(Random& random, std::span<std::byte> room) {
  RecordWriter writer(room, k_shape.record_bytes());
  std::vector<std::byte> record(k_shape.record_bytes());
  const std::vector<std::byte> zeros(k_shape.input_bytes);
  Ticks ticks{7, 0, 40, 44, 5, 0b10, -9, {}};
  for (int i = 0; i < 9; ++i) {
    const std::vector<std::byte> pressed = random_bytes(random, k_shape.input_bytes);
    set_slot(record, k_shape, 0, InputOrigin::received, pressed);
    set_slot(record, k_shape, 1, InputOrigin::absent, zeros);
    set_slot(record, k_shape, 2, i % 2 == 0 ? InputOrigin::repeated : InputOrigin::received,
             i % 4 == 0 ? pressed : zeros);
    EXPECT_TRUE(writer.add(record));
    ++ticks.count;
  }
  ticks.coded = writer.written();
  return ticks;
}

std::vector<Sample> samples() {
  static Random random(1);
  static std::array<std::byte, 1000> inputs_room, ticks_room;
  static const std::vector<std::byte> config = random_bytes(random, 50);
  const SimulationInfo info{1, 2, 3, 4, 60, 2, 4};
  return {
      sample("hello",
             Hello{k_protocol_version, true, 3, 77, 1200, 99, PlayerName("Ann"), BuildText("1.2")}),
      sample("offer", Offer{true, config}),
      sample("answer", Answer{info}),
      sample("welcome",
             Welcome{1, 2, 6, LatePolicy::strict, Pacing::fast, 3600, Entry::snapshot, 88, 9}),
      sample("refuse", Refuse{RefuseReason::simulation_mismatch, RefuseField::canary, 5, 6}),
      sample("start", Start{0b11}),
      sample("inputs", some_inputs(random, inputs_room)),
      sample("ticks", some_ticks(random, ticks_room)),
      sample("resend", Resend{100, 17}),
      sample("desync", DesyncNotice{1842, 2, Verdict::minority, 7, 8, true, 17, FieldText("body"),
                                    FieldText("crate"), FieldText("velocity.y"), FieldText("0x1"),
                                    FieldText("0x2")}),
      sample("dump_request", DumpRequest{1842}),
      sample("dump", Dump{1842, 200, 100, config}),
      sample("finish", Finish{FinishReason::stopped, 99, true, 5}),
      sample("bye", Bye{k_last_leave_reason}),
      sample("snapshot", Snapshot{1800, 5, 200, 100, config}),
      sample("snapshot_taken", SnapshotTaken{1800, true}),
      sample("activate", Activate{2, 1900}),
      sample("ask", Ask{AskKind::vote, 3, 200}),
      sample("paused", Paused{true}),
      sample("parts", Parts{1920, 2, {{{1, 2}, {3, 4}}}}),
      sample("named", Named{3, PlayerName("Zo\u00eb")}),
      sample("command", CommandPiece{200, 100, config}),
      sample("tick_command", TickCommand{1842, k_server_slot, 200, 100, config}),
      sample("command_result", CommandResult{7, true}),
  };
}

TEST(Wire, SamplesAreOneOfEachTypeInOrder) {
  std::size_t type = 0;
  for (const Sample& message : samples())
    EXPECT_EQ(message.bytes.at(0), static_cast<std::byte>(++type)) << message.name;
  EXPECT_EQ(type, static_cast<std::size_t>(MessageType::command_result));
}

TEST(Wire, EveryMessageSurvivesTheRoundTrip) {
  for (const Sample& message : samples()) {
    ASSERT_FALSE(message.bytes.empty()) << message.name;
    Status status = Status::malformed;
    EXPECT_EQ(message.again(message.bytes, status), message.bytes) << message.name;
    EXPECT_EQ(status, Status::ok) << message.name;
  }
}

TEST(Wire, RefusesEveryTruncation) {
  for (const Sample& message : samples()) {
    for (std::size_t size = 0; size < message.bytes.size(); ++size) {
      // A copy of exactly that size, so that a sanitizer sees the first byte read too many.
      const std::vector<std::byte> cut(message.bytes.begin(),
                                       message.bytes.begin() + static_cast<std::ptrdiff_t>(size));
      Status status = Status::ok;
      message.again(cut, status);
      EXPECT_NE(status, Status::ok) << message.name << " cut to " << size;
    }
  }
}

TEST(Wire, RefusesTrailingBytes) {
  for (const Sample& message : samples()) {
    for (int junk : {0x00, 0x05, 0x80, 0xff}) {
      std::vector<std::byte> longer = message.bytes;
      longer.push_back(static_cast<std::byte>(junk));
      Status status = Status::ok;
      message.again(longer, status);
      EXPECT_NE(status, Status::ok) << message.name << " and " << junk;
    }
  }
}

TEST(Wire, DecodedValuesAreInRangeAfterCorruption) {
  constexpr std::uint64_t k_seed = 20260721;
  Random random(k_seed);
  for (const Sample& message : samples()) {
    for (int round = 0; round < 5000; ++round) {
      std::vector<std::byte> bytes = message.bytes;
      const std::uint64_t changes = 1 + random.below(4);
      for (std::uint64_t i = 0; i < changes; ++i) {
        bytes[random.below(bytes.size())] = static_cast<std::byte>(random.below(256));
      }
      Status status = Status::ok;
      const std::vector<std::byte> again = message.again(bytes, status);
      if (status != Status::ok || again == bytes) continue;
      // Hello of another version keeps only its beginning; nothing else has two spellings.
      EXPECT_STREQ(message.name, "hello") << "seed " << k_seed << ", round " << round;
    }
  }
}

TEST(Wire, NeverCrashesOnRandomBytes) {
  constexpr std::uint64_t k_seed = 4711;
  Random random(k_seed);
  std::size_t refused = 0;
  for (const Sample& message : samples()) {
    for (int round = 0; round < 1000; ++round) {
      std::vector<std::byte> bytes = random_bytes(random, 1 + random.below(80));
      bytes[0] = message.bytes[0];
      Status status = Status::ok;
      message.again(bytes, status);
      if (status != Status::ok) ++refused;
    }
  }
  EXPECT_GT(refused, 10'000U);
}

TEST(Wire, RefusesTicksThatNoServerBuilds) {
  std::vector<std::byte> record(k_shape.record_bytes());
  const std::vector<std::byte> pressed(k_shape.input_bytes, std::byte{1});
  set_slot(record, k_shape, 1, InputOrigin::absent, pressed);
  std::array<std::byte, 100> room{};
  RecordWriter writer(room, k_shape.record_bytes());
  ASSERT_TRUE(writer.add(record));
  Ticks ticks;
  ticks.count = 1;
  ticks.ticks_confirmed = 1;
  ticks.coded = writer.written();
  EXPECT_EQ(decode(encoded(ticks), k_shape, ticks), Status::malformed);
}

TEST(Wire, HelloOfAnotherVersionTellsItsVersion) {
  std::vector<std::byte> bytes = encoded(Hello{});
  bytes[5] = std::byte{9};
  bytes.push_back(std::byte{77});
  Hello hello;
  EXPECT_EQ(decode(bytes, hello), Status::ok);
  EXPECT_EQ(hello.protocol, 9);
}

TEST(Wire, HasTheDocumentedBytes) {
  const std::vector<std::byte> bytes =
      encoded(Hello{k_protocol_version, true, 255, 3, 4, 5, PlayerName("A"), BuildText("B")});
  const std::array<int, 37> expected{1, 'L', 'K', 'S', 'N', 5, 0, 1, 255, 3, 0,  0, 0,
                                     0, 0,   0,   0,   4,   0, 0, 0, 0,   0, 0,  0, 5,
                                     0, 0,   0,   0,   0,   0, 0, 1, 'A', 1, 'B'};
  ASSERT_EQ(bytes.size(), expected.size());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << i;
  }
}

TEST(Wire, RefusesCommandsOfNoBytesOrTooMany) {
  const std::array<std::byte, 1> one{};
  CommandPiece piece;
  EXPECT_EQ(decode(encoded(CommandPiece{k_max_command_bytes, 0, one}), piece), Status::ok);
  EXPECT_EQ(decode(encoded(CommandPiece{k_max_command_bytes + 1, 0, one}), piece),
            Status::malformed);
  EXPECT_EQ(decode(encoded(CommandPiece{8, 8, {}}), piece), Status::malformed);
  EXPECT_EQ(decode(encoded(CommandPiece{8, 8, one}), piece), Status::malformed);
}

TEST(Wire, RefusesANameWithControlCharacters) {
  std::vector<std::byte> bytes = encoded(Named{3, PlayerName("Ann")});
  Named named;
  ASSERT_EQ(decode(bytes, named), Status::ok);
  EXPECT_EQ(named.name.view(), "Ann");
  bytes.back() = std::byte{0x1b};
  EXPECT_EQ(decode(bytes, named), Status::malformed);
}

TEST(RecordCoder, GivesBackRandomRuns) {
  constexpr std::uint64_t k_seed = 99;
  Random random(k_seed);
  for (int round = 0; round < 300; ++round) {
    const std::size_t record_bytes = 1 + random.below(40);
    std::vector<std::byte> room(random.below(600));
    RecordWriter writer(room, record_bytes);
    std::vector<std::vector<std::byte>> records;
    std::vector<std::byte> record(record_bytes);
    for (int i = 0; i < 400; ++i) {
      if (random.below(3) == 0) {
        record[random.below(record_bytes)] = static_cast<std::byte>(random.below(256));
      }
      if (!writer.add(record)) break;
      records.push_back(record);
    }
    RecordReader reader(writer.written(), record_bytes);
    for (const std::vector<std::byte>& expected : records) {
      ASSERT_TRUE(reader.next()) << "seed " << k_seed << ", round " << round;
      ASSERT_TRUE(std::equal(expected.begin(), expected.end(), reader.record().begin()));
    }
    EXPECT_TRUE(reader.at_end());
    EXPECT_FALSE(reader.next());
  }
}

TEST(RecordCoder, WritesARecordAsAWholeWhereThatIsShorter) {
  std::array<std::byte, 64> room{};
  RecordWriter writer(room, 16);
  std::array<std::byte, 16> record{};
  record.fill(std::byte{7});
  ASSERT_TRUE(writer.add(record));
  EXPECT_EQ(writer.written().size(), 17U);
  EXPECT_EQ(writer.written()[0], std::byte{0x81});
  record[3] = std::byte{8};
  ASSERT_TRUE(writer.add(record));
  EXPECT_EQ(writer.written().size(), 17U + 1 + 2 + 1);
  RecordReader reader(writer.written(), 16);
  ASSERT_TRUE(reader.next() && reader.next());
  EXPECT_TRUE(std::equal(record.begin(), record.end(), reader.record().begin()));
  EXPECT_TRUE(reader.at_end());
}

TEST(RecordCoder, RefusesAWholeRecordThatEqualsTheOneBefore) {
  const std::array<std::byte, 3> coded{std::byte{0x81}, std::byte{0}, std::byte{0}};
  EXPECT_FALSE(RecordReader(coded, 2).next());
  EXPECT_FALSE(RecordReader(ByteView(coded).first(2), 2).next());
}

TEST(RecordCoder, HasTheDocumentedBytes) {
  std::array<std::byte, 16> room{};
  RecordWriter writer(room, 2);
  const std::array<std::byte, 2> zero{};
  const std::array<std::byte, 2> five{std::byte{5}, std::byte{0}};
  ASSERT_TRUE(writer.add(zero) && writer.add(zero) && writer.add(five));
  const std::array<std::byte, 4> expected{std::byte{1}, std::byte{0x80}, std::byte{1},
                                          std::byte{5}};
  ASSERT_EQ(writer.written().size(), expected.size());
  EXPECT_TRUE(std::equal(expected.begin(), expected.end(), room.begin()));
}

TEST(RecordCoder, CodesARestingPlayerInOneByte) {
  std::array<std::byte, 8> room{};
  RecordWriter writer(room, 4);
  const std::array<std::byte, 4> still{};
  for (int i = 0; i < 128; ++i)
    ASSERT_TRUE(writer.add(still));
  EXPECT_EQ(writer.written().size(), 1U);
}

TEST(TickRecord, LargestFitsOneDatagramUncompressed) {
  constexpr TickShape k_largest{k_max_players, k_max_tick_input_bytes / k_max_players};
  ASSERT_EQ(k_largest.record_bytes(), k_max_record_bytes);
  std::array<std::byte, k_max_datagram_bytes - k_ticks_header_bytes> room{};
  RecordWriter writer(room, k_max_record_bytes);
  std::array<std::byte, k_max_record_bytes> record{};
  record.fill(std::byte{1});
  EXPECT_TRUE(writer.add(record));
}

TEST(TickRecord, RefusesBytesOfAnAbsentPlayerAndStrayBits) {
  std::vector<std::byte> record(k_shape.record_bytes());
  const std::vector<std::byte> pressed(k_shape.input_bytes, std::byte{1});
  set_slot(record, k_shape, 1, InputOrigin::received, pressed);
  EXPECT_TRUE(valid_record(record, k_shape));
  set_slot(record, k_shape, 1, InputOrigin::absent, pressed);
  EXPECT_FALSE(valid_record(record, k_shape));
  set_slot(record, k_shape, 1, InputOrigin::repeated, pressed);
  record[0] |= std::byte{0x40};
  EXPECT_FALSE(valid_record(record, k_shape));
}

}  // namespace
}  // namespace lockstone::net
