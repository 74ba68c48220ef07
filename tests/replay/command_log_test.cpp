// Commands of players and of the server in a log.
#include <gtest/gtest.h>

#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/log_info.h>
#include <lockstone/replay/seek.h>
#include <lockstone/replay/tick_reader.h>

#include "replay/codec/command_codec.h"
#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

ToyMatch talkative() {
  ToyMatch match;
  match.ticks = 60;
  match.command_every = 3;
  return match;
}

TEST(CommandLog, VerifiesAndHoldsEveryCommandAtItsTick) {
  const ToyMatch match = talkative();
  const Bytes log = record(match);
  EXPECT_EQ(verify_toy(log).outcome, VerifyOutcome::same);
  MemorySource source(log);
  TickReader ticks(source);
  ASSERT_EQ(ticks.open(), Status::ok);
  ToyCommands expected(match);
  for (std::uint64_t tick = 0; tick < 60; ++tick) {
    ASSERT_TRUE(ticks.next());
    const auto commands = expected.at(tick);
    ASSERT_EQ(ticks.commands().size(), commands.size()) << tick;
    for (std::size_t i = 0; i < commands.size(); ++i) {
      EXPECT_EQ(ticks.commands()[i].slot, commands[i].slot);
      EXPECT_TRUE(std::ranges::equal(ticks.commands()[i].bytes, commands[i].bytes));
    }
  }
  EXPECT_FALSE(ticks.next());
}

TEST(CommandLog, DivergesWithoutItsCommands) {
  const Bytes with = record(talkative());
  ToyMatch match = talkative();
  match.command_every = 0;
  const Bytes without = record(match);
  MemorySource a(with), b(without);
  const LogComparison comparison = compare_logs(a, b);
  ASSERT_TRUE(comparison.command && comparison.hash);
  EXPECT_EQ(comparison.command->tick, 0U);
  ASSERT_TRUE(comparison.command->here && !comparison.command->there);
  const ToyMatch again = talkative();
  ToyCommands commands(again);
  const PlayerCommand first = commands.at(0)[0];
  EXPECT_EQ(comparison.command->here->slot, first.slot);
  EXPECT_EQ(comparison.command->here->size, first.bytes.size());
  EXPECT_EQ(comparison.hash->tick, 0U);
  EXPECT_FALSE(comparison.input);
  EXPECT_EQ(comparison.first_difference(), 0U);
}

TEST(CommandLog, IsAsBeforeWhereThereAreNone) {
  ToyMatch match = talkative();
  match.command_every = 0;
  const Bytes log = record(match);
  for (const ChunkPlace& place : chunks_of(log))
    EXPECT_NE(place.frame.header.type, ChunkType::command);
}

TEST(CommandLog, IsCountedInTheSummary) {
  const Bytes log = record(talkative());
  MemorySource source(log);
  const Result<LogInfo> info = read_log_info(source);
  ASSERT_TRUE(info.ok());
  EXPECT_EQ(info.value().commands, 30U);  // 20 ticks, half of them with one of the server's
  EXPECT_EQ(info.value().command_bytes, 20U * 20 + 10);
}

TEST(CommandLog, IsCutSoughtAndRepaired) {
  ToyMatch match = talkative();
  match.index = true;
  const Bytes log = record(match);
  for (std::uint64_t tick = 0; tick <= 60; tick += 7) {
    MemorySource source(log);
    const SeekResult found = seek(source, toy_factory(), tick);
    ASSERT_EQ(found.status, Status::ok);
    EXPECT_FALSE(found.diverged);
  }
  MemorySource source(log);
  MemorySink part;
  ASSERT_EQ(cut(source, toy_factory(), 13, 47, part).status, Status::ok);
  EXPECT_EQ(verify_toy(part.bytes()).outcome, VerifyOutcome::same);
  EXPECT_EQ(verify_toy(part.bytes()).ticks_verified, 34U);
  for (std::size_t length = chunks_of(log)[2].offset; length < log.size(); length += 11) {
    MemorySource torn(ByteView(log).first(length));
    MemorySink saved;
    ASSERT_EQ(repair(torn, saved).status, Status::ok);
    EXPECT_EQ(verify_toy(saved.bytes(), {.strict = true}).outcome, VerifyOutcome::same) << length;
  }
}

TEST(CommandLog, SealsTicksEarlyWhereTheirCommandsAreLong) {
  ToyMatch match = talkative();
  match.command_bytes = k_max_command_bytes;
  match.command_every = 1;
  match.chunk_ticks = 60;
  match.keyframe_interval = 0;
  const Bytes log = record(match);
  std::size_t chunks = 0;
  for (const ChunkPlace& place : chunks_of(log)) {
    if (place.frame.header.type != ChunkType::command) continue;
    ++chunks;
    EXPECT_LE(place.frame.header.raw_bytes, k_max_command_chunk_bytes);
  }
  EXPECT_EQ(chunks, 4U);  // 60 × 64 KiB, at most 15 in a chunk of 1 MiB
  EXPECT_EQ(verify_toy(log).outcome, VerifyOutcome::same);
}

TEST(CommandLog, KeepsCommandsThatWaitForTheirTickThroughAFlush) {
  MemorySink sink;
  ToySimulation game({});
  ToyInputs inputs({});
  Recorder recorder(sink, {.keyframe_bytes_max = game.snapshot_bytes_max(SnapshotKind::canonical)});
  ASSERT_EQ(recorder.begin(game.info(), ToyConfig{}.encode(), {}), Status::ok);
  const std::array<std::byte, 3> bytes{std::byte{1}, std::byte{2}, std::byte{3}};
  for (std::uint64_t tick = 0; tick < 4; ++tick) {
    const PlayerCommand command{static_cast<std::uint8_t>(tick % 2),
                                ByteView(bytes).first(1 + tick % 3)};
    ASSERT_EQ(recorder.record_commands(std::span(&command, 1)), Status::ok);
    ASSERT_EQ(recorder.record_commands(std::span(&command, 1)), Status::ok);
    if (tick % 2 == 1) {
      ASSERT_EQ(recorder.keyframe(game), Status::ok);
    }
    const std::array<PlayerCommand, 2> both{command, command};
    step_tick(game, inputs.at(tick), both);
    ASSERT_EQ(recorder.record_tick(tick, inputs.at(tick), game.hash()), Status::ok);
  }
  ASSERT_EQ(recorder.finish(""), Status::ok);
  const VerifyReport report = verify_toy(sink.bytes());
  EXPECT_EQ(report.outcome, VerifyOutcome::same) << report.to_line();
  EXPECT_EQ(report.ticks_verified, 4U);
}

TEST(CommandLog, RecorderRefusesCommandsOutOfRange) {
  MemorySink sink;
  ToySimulation game({});
  Recorder recorder(sink);
  const Bytes long_one(k_max_command_bytes + 1);
  PlayerCommand command{0, long_one};
  EXPECT_EQ(recorder.record_commands(std::span(&command, 1)), Status::invalid_argument);
  ASSERT_EQ(recorder.begin(game.info(), {}, {}), Status::ok);
  EXPECT_EQ(recorder.record_commands(std::span(&command, 1)), Status::invalid_argument);
  command.bytes = {};
  EXPECT_EQ(recorder.record_commands(std::span(&command, 1)), Status::invalid_argument);
  command = {game.info().player_count, ByteView(long_one).first(1)};
  EXPECT_EQ(recorder.record_commands(std::span(&command, 1)), Status::invalid_argument);
  command.slot = k_server_slot;
  EXPECT_EQ(recorder.record_commands(std::span(&command, 1)), Status::ok);
  const std::vector<PlayerCommand> many(k_max_tick_commands, command);
  EXPECT_EQ(recorder.record_commands(many), Status::invalid_argument);
}

TEST(CommandLog, ChangesTheTranscript) {
  const std::array<std::byte, 2> bytes{std::byte{5}, std::byte{6}};
  const std::array<PlayerInput, 1> inputs{PlayerInput{bytes}};
  const auto value = [&](std::span<const PlayerCommand> commands) {
    Transcript transcript;
    transcript.add(3, inputs, commands);
    return transcript.value();
  };
  const std::array<PlayerCommand, 1> one{PlayerCommand{0, bytes}};
  const std::array<PlayerCommand, 1> other{PlayerCommand{k_server_slot, bytes}};
  EXPECT_NE(value({}), value(one));
  EXPECT_NE(value(other), value(one));
}

// Flips one byte at a time, with right checksums: nothing but the commands themselves may change.
TEST(CommandLog, DamagedChunksAreFound) {
  ToyMatch match = talkative();
  match.ticks = 12;
  const Bytes log = record(match);
  const std::size_t index = find_chunk(chunks_of(log), ChunkType::command);
  const ChunkPlace place = chunks_of(log)[index];
  for (std::size_t at = k_chunk_header_bytes; at < place.bytes; ++at) {
    Bytes damaged = log;
    damaged[place.offset + at] ^= std::byte{0x41};
    relink(damaged);
    EXPECT_NE(verify_toy(damaged).outcome, VerifyOutcome::same) << at;
  }
}

TEST(CommandCodec, RefusesRecordsThatNoRecorderWrites) {
  std::array<std::byte, 64> room{};
  const std::array<std::byte, 4> bytes{};
  const auto decode = [&](std::uint64_t first, std::uint64_t second, std::uint8_t slot,
                          std::size_t cut) {
    ByteWriter writer(room);
    encode_command(writer, first, {slot, bytes});
    encode_command(writer, second, {slot, bytes});
    CommandBlock block;
    return block.decode(writer.written().first(writer.size() - cut), 2, 5, 2).ok();
  };
  EXPECT_TRUE(decode(5, 5, 1, 0));
  EXPECT_TRUE(decode(5, 9, k_server_slot, 0));
  EXPECT_FALSE(decode(4, 5, 1, 0));  // before the chunk
  EXPECT_FALSE(decode(7, 6, 1, 0));  // backwards
  EXPECT_FALSE(decode(5, 5, 2, 0));  // no such slot
  for (std::size_t cut = 1; cut < 34; ++cut)
    EXPECT_FALSE(decode(5, 5, 1, cut)) << cut;
}

}  // namespace
}  // namespace lockstone::test
