#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/replay/log_info.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

class LogInfoOfAWholeLog : public testing::Test {
 protected:
  void SetUp() override {
    MemorySource source(log_);
    Result<LogInfo> result = read_log_info(source);
    ASSERT_TRUE(result.ok());
    info_ = std::move(result).value();
  }

  const Bytes log_ = record({.ticks = 90, .keyframe_interval = 30, .chunk_ticks = 10});
  LogInfo info_;
};

TEST_F(LogInfoOfAWholeLog, HasItsLength) {
  EXPECT_EQ(info_.ticks, 90U);
  EXPECT_EQ(info_.duration_milliseconds, 1500U);
}

TEST_F(LogInfoOfAWholeLog, SaysThatItIsComplete) {
  EXPECT_TRUE(info_.complete);
  EXPECT_FALSE(info_.torn_tail);
  EXPECT_FALSE(info_.damage.has_value());
  EXPECT_EQ(info_.end_reason, "match over");
}

TEST_F(LogInfoOfAWholeLog, NamesGameVersionAndBuild) {
  EXPECT_EQ(info_.header.match.build, "toy 1");
  EXPECT_EQ(info_.header.match.game, "toy");
  EXPECT_EQ(info_.header.match.game_version, "1.0");
}

TEST_F(LogInfoOfAWholeLog, ListsKeyframes) {
  EXPECT_EQ(info_.keyframe_ticks, (std::vector<std::uint64_t>{30, 60, 90}));
}

TEST_F(LogInfoOfAWholeLog, ListsEvents) {
  EXPECT_EQ(info_.event_count, 10U);
  ASSERT_EQ(info_.events.size(), 10U);
  EXPECT_EQ(info_.events[1].tick, 9U);
  EXPECT_EQ(info_.events[1].text, "player one");
}

TEST_F(LogInfoOfAWholeLog, CountsChunksOfEachType) {
  ASSERT_EQ(info_.chunk_types.size(), 6U);
  EXPECT_EQ(info_.chunk_types[1].type, ChunkType::input);
  EXPECT_EQ(info_.chunk_types[1].chunks, 9U);
}

TEST_F(LogInfoOfAWholeLog, CountsEachByteOnce) {
  std::uint64_t bytes = chunks_of(log_)[0].offset;
  for (const ChunkTypeTotals& totals : info_.chunk_types)
    bytes += totals.stored_bytes;
  EXPECT_EQ(bytes, log_.size());
  EXPECT_EQ(info_.file_bytes, log_.size());
}

TEST_F(LogInfoOfAWholeLog, CountsEachInputOnce) {
  std::uint64_t inputs = 0;
  for (const std::uint64_t count : info_.inputs_by_origin) {
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

TEST(LogInfo, HasTheLastNameOfEachPlayer) {
  MemorySink sink;
  ToySimulation game({});
  Recorder recorder(sink);
  ASSERT_EQ(recorder.begin(game.info(), {}, {}), Status::ok);
  for (const std::string_view name : {"Ann", "Zo\u00eb"})
    ASSERT_EQ(recorder.event(0, EventKind::name, 1, name), Status::ok);
  ASSERT_EQ(recorder.event(0, EventKind::join, 0, "no name"), Status::ok);
  ASSERT_EQ(recorder.event(0, EventKind::name, k_no_slot, "nobody"), Status::ok);
  ASSERT_EQ(recorder.finish(""), Status::ok);
  MemorySource source(sink.bytes());
  const Result<LogInfo> info = read_log_info(source);
  ASSERT_TRUE(info.ok());
  ASSERT_EQ(info.value().player_names.size(), game.info().player_count);
  EXPECT_EQ(info.value().player_names[0], "");
  EXPECT_EQ(info.value().player_names[1], "Zo\u00eb");
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
