// Repairing, cutting and comparing logs.
#include <gtest/gtest.h>

#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/log_map.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

Bytes repaired(const Bytes& log, RepairReport& report) {
  MemorySource source(log);
  MemorySink sink;
  report = repair(source, sink);
  return sink.bytes();
}

LogComparison compare(const Bytes& a, const Bytes& b) {
  MemorySource here(a), there(b);
  return compare_logs(here, there);
}

TEST(Repair, ClosesALogCutAtAnyByte) {
  const Bytes log = record({.ticks = 40});
  const std::size_t beginning = chunks_of(log).front().end();
  for (std::size_t length = beginning; length < log.size(); length += 7) {
    RepairReport report;
    const Bytes whole =
        repaired(Bytes(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(length)), report);
    ASSERT_EQ(report.status, Status::ok) << report.what;
    const VerifyReport verified = verify_toy(whole, {.strict = true});
    EXPECT_EQ(verified.outcome, VerifyOutcome::same) << length << ": " << verified.to_line();
    EXPECT_EQ(verified.ticks_verified, report.kept_ticks);
    EXPECT_EQ(verified.end_reason.substr(0, 10), "repaired: ");
    MemorySource source(whole);
    EXPECT_TRUE(read_index(source).ok());
  }
}

TEST(Repair, KeepsEverythingBeforeDamage) {
  Bytes log = record({.ticks = 40});
  const auto chunks = chunks_of(log);
  log[chunks[find_chunk(chunks, ChunkType::hash, 3)].offset + 60] ^= std::byte{1};
  RepairReport report;
  const Bytes whole = repaired(log, report);
  ASSERT_TRUE(report.damage.has_value());
  EXPECT_EQ(report.kept_ticks, verify_toy(whole, {.strict = true}).ticks_verified);
  EXPECT_GT(report.kept_ticks, 0U);
  EXPECT_GT(report.lost_bytes, 0U);
}

TEST(Repair, LeavesAWholeLogAsItIs) {
  const Bytes log = record({.ticks = 40, .index = true});
  RepairReport report;
  EXPECT_EQ(repaired(log, report), log);
  EXPECT_TRUE(report.was_whole);
}

TEST(Repair, RefusesBytesThatAreNoLog) {
  RepairReport report;
  EXPECT_TRUE(repaired(Bytes(500), report).empty());
  EXPECT_NE(report.status, Status::ok);
}

TEST(Cut, GivesALogOfItsOwn) {
  const Bytes log = record({.ticks = 100});
  for (const std::uint64_t begin : {0U, 13U, 48U, 89U}) {
    MemorySource source(log);
    MemorySink sink;
    const CutReport report = cut(source, toy_factory(), begin, 90, sink);
    ASSERT_EQ(report.status, Status::ok) << report.what;
    EXPECT_EQ(report.ticks, 90 - begin);
    const VerifyReport verified = verify_toy(sink.bytes(), {.strict = true});
    EXPECT_EQ(verified.outcome, VerifyOutcome::same) << verified.to_line();
    EXPECT_EQ(verified.start_tick, begin);
    EXPECT_EQ(verified.ticks_verified, report.ticks);
    const LogComparison comparison = compare(log, sink.bytes());
    EXPECT_EQ(comparison.ticks, report.ticks);
    EXPECT_FALSE(comparison.first_difference().has_value());
  }
}

TEST(Cut, RefusesALogOfAnotherWay) {
  const Bytes log = record({.ticks = 100, .keyframe_interval = 0, .flip_at = 20});
  MemorySource source(log);
  MemorySink sink;
  EXPECT_EQ(cut(source, toy_factory(), 50, 90, sink).status, Status::incompatible);
  EXPECT_TRUE(sink.bytes().empty());
}

TEST(Cut, RefusesAnEndThatIsNotBehindItsBeginning) {
  const Bytes log = record({.ticks = 100});
  for (const std::uint64_t end : {0U, 30U, 60U}) {
    MemorySource source(log);
    MemorySink sink;
    EXPECT_EQ(cut(source, toy_factory(), 60, end, sink).status, Status::invalid_argument) << end;
    EXPECT_TRUE(sink.bytes().empty());
  }
}

TEST(Cut, RefusesABeginningThatTheLogDoesNotReach) {
  const Bytes log = record({.ticks = 100});
  for (const std::uint64_t begin : {100U, 101U, 5000U}) {
    MemorySource source(log);
    MemorySink sink;
    EXPECT_EQ(cut(source, toy_factory(), begin, 6000, sink).status, Status::not_found) << begin;
  }
}

TEST(Cut, RefusesDamageBetweenItsTicks) {
  Bytes log = record({.ticks = 100});
  const auto chunks = chunks_of(log);
  log[chunks[find_chunk(chunks, ChunkType::hash, 17)].end() - 1] ^= std::byte{1};
  MemorySource source(log);
  MemorySink sink;
  EXPECT_EQ(cut(source, toy_factory(), 20, 90, sink).status, Status::checksum_mismatch);
  EXPECT_EQ(cut(source, toy_factory(), 20, 50, sink).status, Status::ok);
}

TEST(Compare, FindsNothingBetweenEqualMatches) {
  const Bytes log = record({.ticks = 60});
  EXPECT_TRUE(compare(log, record({.ticks = 60, .keyframe_interval = 7, .compress = true})).same());
  const LogComparison shorter = compare(log, record({.ticks = 50}));
  EXPECT_FALSE(shorter.same());
  EXPECT_FALSE(shorter.first_difference().has_value());
  EXPECT_EQ(shorter.ticks, 50U);
  EXPECT_EQ(shorter.end_here, 60U);
}

TEST(Compare, NamesTheFirstInputAndHash) {
  const Bytes log = record({.ticks = 60});
  const Bytes other = rewrite(log, [](auto tick, auto slot, auto bytes) {
    if (tick == 21 && slot == 1) bytes[2] ^= std::byte{0x10};
  });
  const LogComparison inputs = compare(log, other);
  ASSERT_TRUE(inputs.input.has_value());
  EXPECT_EQ(inputs.input->tick, 21U);
  EXPECT_EQ(inputs.input->slot, 1U);
  EXPECT_EQ(inputs.input->byte, 2U);
  EXPECT_EQ(inputs.input->here ^ inputs.input->there, 0x10);
  EXPECT_FALSE(inputs.hash.has_value());
  const LogComparison hashes = compare(log, record({.ticks = 60, .flip_at = 33}));
  ASSERT_TRUE(hashes.hash.has_value());
  EXPECT_EQ(hashes.hash->tick, 33U);
  EXPECT_FALSE(hashes.input.has_value());
  EXPECT_EQ(hashes.first_difference(), 33U);
}

}  // namespace
}  // namespace lockstone::test
