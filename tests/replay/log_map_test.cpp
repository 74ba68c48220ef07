// The index, reading from the middle, compressed chunks.
#include <gtest/gtest.h>

#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/log_map.h>
#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/seek.h>

#include "replay/codec/index_codec.h"
#include "tests/replay/log_tools.h"
#include "tests/support/random.h"

namespace lockstone::test {
namespace {

using namespace replay;

const ToyMatch k_indexed{.ticks = 100, .compress = true, .index = true};

// The state of the toy at a tick, by playing it.
std::uint64_t hash_at(const ToyMatch& match, std::uint64_t tick) {
  ToySimulation game(match.config);
  ToyInputs inputs(match.config);
  while (game.tick() < tick)
    game.step(inputs.at(game.tick()));
  return game.hash();
}

TEST(Index, NamesTheKeyframesThatAWalkFinds) {
  const Bytes log = record(k_indexed);
  MemorySource source(log);
  const auto index = read_index(source);
  ASSERT_TRUE(index.ok());
  const LogMap map = map_log(source);
  EXPECT_EQ(index.value(), map.keyframes);
  EXPECT_EQ(map.keyframes.size(), 100U / 8);
  EXPECT_EQ(map.ticks, 100U);
}

TEST(Index, IsFoundBeforeASignature) {
  if (!signing_available()) GTEST_SKIP();
  ToyMatch match = k_indexed;
  match.signing_key = make_signing_key().value();
  const Bytes log = record(match);
  MemorySource source(log);
  EXPECT_TRUE(read_index(source).ok());
}

TEST(Index, MayBeMissing) {
  const Bytes log = record({.ticks = 100});
  MemorySource source(log);
  EXPECT_EQ(read_index(source).status(), Status::not_found);
  const auto place = find_keyframe(source, 50);
  ASSERT_TRUE(place.ok());
  EXPECT_EQ(place.value().tick, 48U);
  EXPECT_EQ(find_keyframe(source, 7).status(), Status::not_found);
}

TEST(Index, ThinsOutInALongMatch) {
  IndexBuilder index;
  for (std::uint64_t i = 0; i < 10 * k_max_index_entries; ++i)
    index.add({i, 100 * i});
  EXPECT_LE(index.places().size(), k_max_index_entries);
  EXPECT_GE(index.places().size(), k_max_index_entries / 2);
  const std::uint64_t step = index.places()[1].tick;
  for (std::size_t i = 0; i < index.places().size(); ++i)
    EXPECT_EQ(index.places()[i].tick, i * step);
}

TEST(Index, RefusesBytesThatAreNoIndex) {
  const std::vector<KeyframePlace> places{{8, 500}, {16, 900}};
  Bytes payload(40);
  ByteWriter writer(payload);
  encode_index(writer, places, 2000);
  std::vector<KeyframePlace> decoded;
  ASSERT_TRUE(decode_index(payload, 2000, decoded).ok());
  EXPECT_EQ(decoded, places);
  EXPECT_FALSE(decode_index(payload, 2001, decoded).ok());
  EXPECT_FALSE(decode_index(std::span(payload).first(39), 2000, decoded).ok());
  ByteWriter(std::span(payload).subspan(24)).put(std::uint64_t{400});  // offsets fall
  EXPECT_FALSE(decode_index(payload, 2000, decoded).ok());
}

TEST(Seek, ReachesEveryTick) {
  const Bytes log = record(k_indexed);
  for (std::uint64_t tick = 0; tick <= 100; tick += 3) {
    MemorySource source(log);
    const SeekResult result = seek(source, toy_factory(), tick);
    ASSERT_EQ(result.status, Status::ok) << result.what;
    EXPECT_EQ(result.simulation->tick(), tick);
    EXPECT_EQ(result.simulation->hash(), hash_at(k_indexed, tick));
    EXPECT_EQ(result.loaded_tick, tick / 8 * 8);
    EXPECT_FALSE(result.diverged);
  }
  MemorySource source(log);
  EXPECT_EQ(seek(source, toy_factory(), 101).status, Status::not_found);
}

TEST(Seek, TellsWhereTheLogGoesAnotherWay) {
  const Bytes log = record({.ticks = 30, .keyframe_interval = 0, .flip_at = 11});
  MemorySource source(log);
  const SeekResult result = seek(source, toy_factory(), 20);
  ASSERT_EQ(result.status, Status::ok);
  EXPECT_TRUE(result.diverged);
  EXPECT_EQ(result.diverged_tick, 11U);
}

TEST(Seek, ComparesWithABuildThatFailsTheCanary) {
  const Bytes log = record(k_indexed);
  MemorySource source(log);
  const auto other_build = [](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    auto toy = std::make_unique<ToySimulation>(ToyConfig::decode(bytes).value());
    SimulationInfo info = toy->info();
    ++info.canary;
    toy->override_info(info);
    return std::unique_ptr<Simulation>(std::move(toy));
  };
  const SeekResult result = seek(source, other_build, 20);
  EXPECT_EQ(result.status, Status::ok) << result.what;
  EXPECT_FALSE(result.same_canary);
  EXPECT_TRUE(seek(source, toy_factory(), 20).same_canary);
  MemorySink sink;
  EXPECT_EQ(cut(source, other_build, 20, 40, sink).status, Status::incompatible);
}

TEST(Compression, MakesKeyframesSmallerAndChangesNothingElse) {
  if (!compression_available()) GTEST_SKIP();
  const ToyMatch plain{.config = {.body_count = 100}, .ticks = 100};
  ToyMatch packed = plain;
  packed.compress = true;
  const Bytes log = record(packed);
  EXPECT_LT(log.size(), record(plain).size());
  MemorySource source(log);
  LogReader reader(source);
  ASSERT_EQ(reader.open(), Status::ok);
  std::size_t keyframes = 0;
  ToySimulation game(plain.config);
  for (LogItem item = reader.next(); !is_last(item); item = reader.next()) {
    if (item != LogItem::keyframe) continue;
    ++keyframes;
    EXPECT_EQ(game.load(SnapshotKind::canonical, reader.snapshot()), Status::ok);
    EXPECT_EQ(game.hash(), reader.keyframe_hash());
  }
  EXPECT_TRUE(reader.complete());
  EXPECT_EQ(keyframes, 100U / 8);
}

// A frame that announces more or less than its content, with right checksums.
TEST(Compression, RefusesAnotherLengthThanAnnounced) {
  if (!compression_available()) GTEST_SKIP();
  const Bytes good = record({.config = {.body_count = 100}, .ticks = 20, .compress = true});
  for (const std::int64_t change : {-1, 1, 1 << 20}) {
    Bytes log = good;
    const auto chunks = chunks_of(log);
    const ChunkPlace& place = chunks[find_chunk(chunks, ChunkType::keyframe)];
    ASSERT_EQ(place.frame.header.codec, Codec::zstd);
    ChunkFrame frame = place.frame;
    frame.header.raw_bytes = static_cast<std::uint32_t>(frame.header.raw_bytes + change);
    set_frame(log, place, frame);
    relink(log);
    const VerifyReport report = verify_toy(log);
    EXPECT_EQ(report.outcome, VerifyOutcome::corrupt) << report.to_line();
  }
}

// Random bytes in place of a compressed payload: refused or, at worst, another keyframe; no crash.
TEST(Compression, SurvivesDamagedFramesWithRightChecksums) {
  if (!compression_available()) GTEST_SKIP();
  const Bytes good = record({.config = {.body_count = 100}, .ticks = 20, .compress = true});
  const auto chunks = chunks_of(good);
  const ChunkPlace& place = chunks[find_chunk(chunks, ChunkType::keyframe)];
  Random random;
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    Bytes log = good;
    const std::size_t payload = place.bytes - k_chunk_header_bytes;
    const std::size_t offset = place.offset + k_chunk_header_bytes + random.below(payload);
    log[offset] ^= static_cast<std::byte>(1U << random.below(8));
    relink(log);
    refused += verify_toy(log).outcome == VerifyOutcome::same ? 0 : 1;
  }
  EXPECT_GT(refused, 250);  // a few bits of a frame mean nothing
}

}  // namespace
}  // namespace lockstone::test
