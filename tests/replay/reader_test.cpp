#include <gtest/gtest.h>

#include <lockstone/replay/log_reader.h>

#include "tests/replay/allocation_count.h"
#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

// Reads to the end and counts the delivered items.
struct Reading {
  explicit Reading(const Bytes& bytes) : source(bytes), reader(source) {
    status = reader.open();
    do {
      last = reader.next();
      ++items;
      if (last == LogItem::hashes) ticks += reader.hashes().size();
      if (last == LogItem::skipped) ++skipped;
    } while (!is_last(last));
  }

  MemorySource source;
  LogReader reader;
  Status status;
  LogItem last = LogItem::skipped;
  std::size_t items = 0;
  std::size_t skipped = 0;
  std::uint64_t ticks = 0;
};

// Puts a chunk between two others and makes the checksums right.
void insert_chunk(Bytes& log, std::size_t offset, ChunkHeader header, std::size_t payload_bytes) {
  header.raw_bytes = header.stored_bytes = static_cast<std::uint32_t>(payload_bytes);
  Bytes chunk(k_chunk_header_bytes + payload_bytes);
  encode_chunk_frame({header, 0, 0, 0}, std::span(chunk).first<k_chunk_header_bytes>());
  log.insert(log.begin() + static_cast<std::ptrdiff_t>(offset), chunk.begin(), chunk.end());
  relink(log);
}

// A log with the frame of one chunk altered under right checksums.
template <class Alter>
Reading read_with_frame(ChunkType type, const Alter& alter) {
  static Bytes log;
  log = record({});
  const auto chunks = chunks_of(log);
  const ChunkPlace& place = chunks[find_chunk(chunks, type)];
  ChunkFrame frame = place.frame;
  alter(frame.header);
  set_frame(log, place, frame);
  return Reading(log);
}

TEST(LogReader, TruncatedAtEveryLengthDeliversAllThatIsWhole) {
  const Bytes log = record({.ticks = 33});
  const auto chunks = chunks_of(log);
  for (std::size_t length = 0; length <= log.size(); ++length) {
    const Bytes cut(log.begin(), log.begin() + static_cast<std::ptrdiff_t>(length));
    const Reading reading(cut);
    if (length < chunks[0].offset) {
      EXPECT_EQ(reading.status, Status::truncated) << length;
      EXPECT_EQ(reading.reader.damage().offset, length);
      continue;
    }
    ASSERT_EQ(reading.status, Status::ok);
    std::uint64_t whole_ticks = 0;
    std::size_t whole_chunks = 0;
    std::size_t last_end = chunks[0].offset;
    for (const ChunkPlace& place : chunks) {
      if (place.end() > length) break;
      ++whole_chunks;
      last_end = place.end();
      if (place.frame.header.type == ChunkType::hash) whole_ticks += place.frame.header.count;
    }
    EXPECT_EQ(reading.ticks, whole_ticks) << length;
    EXPECT_EQ(reading.items, whole_chunks + 1) << length;
    const bool torn = last_end != length;
    EXPECT_EQ(reading.last, torn ? LogItem::torn : LogItem::finished) << length;
    EXPECT_EQ(reading.reader.complete(), length == log.size());
    if (torn) {
      EXPECT_EQ(reading.reader.damage().status, Status::truncated);
      EXPECT_EQ(reading.reader.damage().offset, last_end);
    }
  }
}

TEST(LogReader, SkipsUnknownChunksThatMayBeSkipped) {
  Bytes log = record({});
  const auto chunks = chunks_of(log);
  const ChunkHeader unknown{.type = ChunkType{200}, .version = 9, .flags = k_flag_may_skip};
  insert_chunk(log, chunks[0].offset, unknown, 10);
  insert_chunk(log, chunks_of(log)[find_chunk(chunks_of(log), ChunkType::hash)].offset, unknown, 0);
  insert_chunk(log, chunks_of(log).back().offset,
               {.type = ChunkType::index, .flags = k_flag_may_skip}, 99);
  const Reading reading(log);
  EXPECT_EQ(reading.last, LogItem::finished) << reading.reader.damage().what;
  EXPECT_EQ(reading.skipped, 3U);
  EXPECT_EQ(reading.ticks, 20U);
  EXPECT_EQ(verify_toy(log).outcome, VerifyOutcome::same);
}

TEST(LogReader, RefusesUnknownChunksThatMustNotBeSkipped) {
  Bytes log = record({});
  const auto chunks = chunks_of(log);
  const std::size_t offset = chunks[find_chunk(chunks, ChunkType::end)].offset;
  insert_chunk(log, offset, {.type = ChunkType{200}}, 10);
  const Reading reading(log);
  EXPECT_EQ(reading.last, LogItem::damaged);
  EXPECT_EQ(reading.reader.damage().status, Status::unsupported_version);
  EXPECT_EQ(reading.reader.damage().offset, offset);
  EXPECT_EQ(reading.ticks, 20U);
  EXPECT_EQ(verify_toy(log).outcome, VerifyOutcome::incompatible);
}

TEST(LogReader, RefusesHugeLengthsBeforeAllocating) {
  for (const ChunkType type :
       {ChunkType::scene, ChunkType::input, ChunkType::hash, ChunkType::keyframe, ChunkType::event,
        ChunkType::end, ChunkType{77}}) {
    Bytes log = record({});
    const auto chunks = chunks_of(log);
    ChunkFrame frame = chunks[0].frame;
    frame.header.type = type;
    frame.header.flags = k_flag_may_skip;
    frame.header.raw_bytes = frame.header.stored_bytes = 0xffffffff;
    set_frame(log, chunks[0], frame);
    take_heap_use();
    const Reading reading(log);
    EXPECT_LT(take_heap_use().largest_bytes, 100'000U);
    EXPECT_EQ(reading.last, LogItem::damaged);
    EXPECT_EQ(reading.reader.damage().status, Status::malformed);
    EXPECT_EQ(reading.reader.damage().offset, chunks[0].offset);
  }
}

TEST(LogReader, BoundsTheStoredAndTheRawLengthEachByItself) {
  using H = ChunkHeader;
  const auto compressed = [](std::uint32_t raw_bytes, std::uint32_t stored_bytes) {
    const Reading reading = read_with_frame(ChunkType::scene, [&](H& h) {
      h.codec = Codec::zstd;
      h.raw_bytes = raw_bytes;
      h.stored_bytes = stored_bytes;
    });
    return reading.reader.damage().status;
  };
  EXPECT_EQ(compressed(20, k_max_scene_bytes + 1), Status::malformed);
  EXPECT_EQ(compressed(k_max_scene_bytes + 1, 20), Status::malformed);
  // The payload is no Zstandard frame, which is found before room is made for its content.
  take_heap_use();
  EXPECT_EQ(compressed(k_max_scene_bytes, 20),
            compression_available() ? Status::malformed : Status::unsupported_version);
  EXPECT_LT(take_heap_use().largest_bytes, 2 * k_max_command_chunk_bytes);  // of the recorder
}

TEST(LogReader, TakesALengthBeyondTheFileForATornTailWithoutAllocating) {
  Bytes log = record({});
  const auto chunks = chunks_of(log);
  ChunkFrame frame = chunks[0].frame;
  frame.header.raw_bytes = frame.header.stored_bytes = k_max_scene_bytes;
  set_frame(log, chunks[0], frame);
  take_heap_use();
  const Reading reading(log);
  EXPECT_LT(take_heap_use().largest_bytes, 100'000U);
  EXPECT_EQ(reading.last, LogItem::torn);
}

TEST(LogReader, RefusesCountsVersionsAndPlacesOutOfRange) {
  const auto damage = [](const Reading& reading) {
    EXPECT_EQ(reading.last, LogItem::damaged);
    return reading.reader.damage().status;
  };
  using H = ChunkHeader;
  const auto with = [&](ChunkType type, auto alter) {
    return damage(read_with_frame(type, alter));
  };
  EXPECT_EQ(with(ChunkType::input, [](H& h) { h.count = 0xffffffff; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::input, [](H& h) { h.count = 0; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::input, [](H& h) { h.count = 6; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::input, [](H& h) { h.count = 61; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::input, [](H& h) { h.first_tick = 1; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::input, [](H& h) { h.type = ChunkType::hash; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::scene, [](H& h) { h.type = ChunkType::end; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::scene, [](H& h) { h.count = 1; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::scene, [](H& h) { h.raw_bytes += 1; }), Status::malformed);
  EXPECT_EQ(with(ChunkType::scene, [](H& h) { h.version = 2; }), Status::unsupported_version);
  EXPECT_EQ(with(ChunkType::scene, [](H& h) { h.codec = Codec{2}; }), Status::unsupported_version);
  EXPECT_EQ(with(ChunkType::scene, [](H& h) { h.flags = 0x80; }), Status::unsupported_version);
  EXPECT_EQ(with(ChunkType::scene, [](H& h) { h.sequence = 1; }), Status::malformed);
}

TEST(LogReader, RefusesWrongContentUnderRightChecksums) {
  const Bytes good = record({});
  const auto chunks = chunks_of(good);
  const auto rejected = [&](ChunkType type, std::size_t byte, int value) {
    Bytes log = good;
    const ChunkPlace& place = chunks[find_chunk(chunks, type)];
    log[place.offset + k_chunk_header_bytes + byte] = static_cast<std::byte>(value);
    relink(log);
    const Reading reading(log);
    EXPECT_GE(reading.reader.damage().offset, place.offset);
    EXPECT_LT(reading.reader.damage().offset, place.end());
    return reading.last == LogItem::damaged && reading.reader.damage().status == Status::malformed;
  };
  EXPECT_TRUE(rejected(ChunkType::event, 8, 0)) << "kind 0";
  EXPECT_TRUE(rejected(ChunkType::event, 9, 2)) << "slot beyond the players";
  EXPECT_TRUE(rejected(ChunkType::event, 10, 11)) << "text beyond the record";
  EXPECT_TRUE(rejected(ChunkType::event, 11, 2)) << "text beyond its limit";
  EXPECT_TRUE(rejected(ChunkType::event, 12, 27)) << "control byte";
  EXPECT_TRUE(rejected(ChunkType::event, 12, 0xff)) << "no UTF-8";
  EXPECT_TRUE(rejected(ChunkType::keyframe, 0, 1)) << "not the hash of the tick before";
  EXPECT_TRUE(rejected(ChunkType::end, 0, 1)) << "final tick";
  EXPECT_TRUE(rejected(ChunkType::end, 16, 1)) << "ticks";
  EXPECT_TRUE(rejected(ChunkType::end, 24, 1)) << "events";
  EXPECT_TRUE(rejected(ChunkType::end, 32, 1)) << "keyframes";
  EXPECT_TRUE(rejected(ChunkType::end, 36, 9)) << "kind of end";
  EXPECT_TRUE(rejected(ChunkType::end, 40, 9)) << "transcript";
  EXPECT_TRUE(rejected(ChunkType::end, 69, 99)) << "reason beyond the payload";
  EXPECT_TRUE(rejected(ChunkType::input, 0, 99)) << "a run beyond the last tick";
}

TEST(LogReader, RefusesChunksAfterTheEnd) {
  Bytes log = record({});
  insert_chunk(log, log.size(), {.type = ChunkType::event, .count = 1, .first_tick = 20}, 12);
  const Reading reading(log);
  EXPECT_EQ(reading.last, LogItem::damaged);
  EXPECT_TRUE(reading.reader.complete());
}

TEST(LogReader, CountsTicksFromTheFramesAlone) {
  const Bytes log = record({.ticks = 123});
  MemorySource source(log);
  EXPECT_EQ(map_log(source).ticks, 123U);
  const Bytes nonsense(200);
  MemorySource other(nonsense);
  EXPECT_EQ(map_log(other).ticks, 0U);
}

}  // namespace
}  // namespace lockstone::test
