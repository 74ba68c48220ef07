#include <gtest/gtest.h>

#include <lockstone/replay/log_info.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

TEST(LogInfo, SumsUpAWholeLog) {
  const Bytes log = record({.ticks = 90, .keyframe_interval = 30, .chunk_ticks = 10});
  MemorySource source(log);
  const Result<LogInfo> result = read_log_info(source);
  ASSERT_TRUE(result.ok());
  const LogInfo& info = result.value();
  EXPECT_EQ(info.ticks, 90U);
  EXPECT_EQ(info.duration_milliseconds, 1500U);
  EXPECT_EQ(info.keyframe_ticks, (std::vector<std::uint64_t>{30, 60, 90}));
  EXPECT_EQ(info.event_count, 10U);
  ASSERT_EQ(info.events.size(), 10U);
  EXPECT_EQ(info.events[1].tick, 9U);
  EXPECT_EQ(info.events[1].text, "player one");
  EXPECT_TRUE(info.complete);
  EXPECT_FALSE(info.torn_tail);
  EXPECT_FALSE(info.damage.has_value());
  EXPECT_EQ(info.end_reason, "match over");
  EXPECT_EQ(info.header.match.build, "toy 1");
  EXPECT_EQ(info.header.match.game, "toy");
  EXPECT_EQ(info.header.match.game_version, "1.0");
  std::uint64_t bytes = chunks_of(log)[0].offset;
  for (const ChunkTypeTotals& totals : info.chunk_types)
    bytes += totals.stored_bytes;
  EXPECT_EQ(bytes, log.size());
  EXPECT_EQ(info.file_bytes, log.size());
  ASSERT_EQ(info.chunk_types.size(), 6U);
  EXPECT_EQ(info.chunk_types[1].type, ChunkType::input);
  EXPECT_EQ(info.chunk_types[1].chunks, 9U);
  std::uint64_t inputs = 0;
  for (const std::uint64_t count : info.inputs_by_origin) {
    EXPECT_GT(count, 0U);
    inputs += count;
  }
  EXPECT_EQ(inputs, 180U);
}

TEST(LogInfo, SumsUpTheWholePartsOfADamagedLog) {
  Bytes log = record({.ticks = 20});
  log.resize(log.size() - 1);
  MemorySource torn(log);
  const Result<LogInfo> result = read_log_info(torn);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.value().ticks, 20U);
  EXPECT_TRUE(result.value().torn_tail);
  EXPECT_FALSE(result.value().complete);
  EXPECT_EQ(result.value().damage->status, Status::truncated);
}

TEST(LogInfo, ADamagedFileHeaderIsAnError) {
  Bytes log = record({});
  log[20] ^= std::byte{1};
  MemorySource source(log);
  Damage damage;
  const Result<LogInfo> result = read_log_info(source, &damage);
  EXPECT_EQ(result.status(), Status::checksum_mismatch);
  EXPECT_EQ(damage.status, Status::checksum_mismatch);
  EXPECT_FALSE(damage.what.empty());
}

}  // namespace
}  // namespace lockstone::test
