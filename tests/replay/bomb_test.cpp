// Small files that ask for much memory or time: a reader's cost grows with the file, whatever the
// file says.
#include <atomic>

#include <gtest/gtest.h>

#include <lockstone/hash.h>
#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/log_info.h>
#include <lockstone/replay/log_map.h>
#include <lockstone/replay/seek.h>
#include <lockstone/replay/signature.h>
#include <lockstone/replay/snapshot_file.h>

#include "tests/replay/allocation_count.h"
#include "tests/replay/log_tools.h"
#include "tests/support/random.h"

namespace lockstone::test {
namespace {

using namespace replay;

// Bytes held for each byte of the file: a payload, its unpacked bytes, and copies of these.
constexpr std::size_t k_held_per_byte = 4 * k_max_compression_ratio;

// Buffers of constant size, and the memory for the toy's configuration.
constexpr std::size_t k_held_always = std::size_t{3} << 20;

// A Zstandard frame (RFC 8878) of zeros, 128 KiB for each four bytes.
Bytes zeros_packed(std::uint32_t raw_bytes) {
  constexpr std::uint32_t k_block_bytes = 128U << 10;
  constexpr std::uint32_t k_run = 1 << 1, k_last = 1;
  const std::uint32_t blocks = (raw_bytes + k_block_bytes - 1) / k_block_bytes;
  Bytes frame(9 + 4 * std::size_t{blocks});
  ByteWriter writer(frame);
  writer.put(std::uint32_t{0xfd2fb528});
  writer.put(std::uint8_t{0xa0});  // one segment, four bytes of content size
  writer.put(raw_bytes);
  for (std::uint32_t i = 0; i < blocks; ++i, raw_bytes -= k_block_bytes) {
    const bool last = i + 1 == blocks;
    const std::uint32_t block =
        (last ? raw_bytes : k_block_bytes) << 3 | k_run | (last ? k_last : 0);
    writer.put(static_cast<std::uint16_t>(block & 0xffff));
    writer.put(std::uint16_t{static_cast<std::uint16_t>(block >> 16)});  // and the byte 0
  }
  LKS_CHECK(writer.ok() && writer.size() == frame.size());
  return frame;
}

// Puts another payload into a chunk and makes the checksums right.
void replace_payload(Bytes& log, const ChunkPlace& place, ByteView payload, Codec codec,
                     std::uint32_t raw_bytes) {
  ChunkFrame frame = place.frame;
  frame.header.codec = codec;
  frame.header.raw_bytes = raw_bytes;
  frame.header.stored_bytes = static_cast<std::uint32_t>(payload.size());
  set_frame(log, place, frame);
  const auto begin = log.begin() + static_cast<std::ptrdiff_t>(place.offset + k_chunk_header_bytes);
  log.erase(begin, log.begin() + static_cast<std::ptrdiff_t>(place.end()));
  log.insert(log.begin() + static_cast<std::ptrdiff_t>(place.offset + k_chunk_header_bytes),
             payload.begin(), payload.end());
  relink(log);
}

Bytes bomb(ChunkType type, std::uint32_t raw_bytes) {
  Bytes log = record({.ticks = 30});
  const auto chunks = chunks_of(log);
  replace_payload(log, chunks[find_chunk(chunks, type)], zeros_packed(raw_bytes), Codec::zstd,
                  raw_bytes);
  return log;
}

SourceOpener opener_of(const Bytes& log) {
  return [&log]() -> Result<std::unique_ptr<Source>> {
    return std::unique_ptr<Source>(std::make_unique<MemorySource>(log));
  };
}

// Everything that reads a log; each must stay below the bound.
void expect_bounded(const Bytes& log) {
  static const Bytes good = record({.ticks = 30});
  const auto check = [&](const char* what, auto use) {
    MemorySource source(log);
    take_heap_use();
    use(source);
    const std::size_t limit = k_held_always + k_held_per_byte * log.size();
    ASSERT_LE(take_heap_use().peak_bytes, limit) << what << ", " << log.size() << " bytes";
  };
  check("info", [](Source& source) { (void)read_log_info(source); });
  check("map", [](Source& source) { (void)map_log(source); });
  check("index", [](Source& source) { (void)read_index(source); });
  check("signatures", [](Source& source) { (void)check_signatures(source); });
  check("seek", [](Source& source) { (void)seek(source, toy_factory(), 9); });
  check("verify", [](Source& source) { (void)verify(source, toy_factory()); });
  check("compare", [](Source& source) {
    MemorySource other(good);
    (void)compare_logs(source, other);
  });
  // The output is as long as the log.
  check("repair", [](Source& source) {
    MemorySink sink;
    (void)repair(source, sink);
  });
  check("cut", [](Source& source) {
    MemorySink sink;
    (void)cut(source, toy_factory(), 3, 9, sink);
  });
}

VerifyOutcome outcome_of(const Bytes& log) {
  return verify_toy(log).outcome;
}

TEST(Bomb, ACompressedPayloadStandsForAtMostSoManyTimesItsBytes) {
  if (!compression_available()) GTEST_SKIP();
  for (const ChunkType type : {ChunkType::scene, ChunkType::keyframe}) {
    const std::uint32_t most = type == ChunkType::scene ? k_max_scene_bytes : k_max_keyframe_bytes;
    for (const std::uint32_t raw_bytes : {most, most / 7, std::uint32_t{200'000}}) {
      const Bytes log = bomb(type, raw_bytes);
      ASSERT_LT(log.size(), 8000U);
      expect_bounded(log);
      EXPECT_EQ(outcome_of(log), VerifyOutcome::corrupt) << to_string(type) << ' ' << raw_bytes;
    }
  }
}

TEST(Bomb, OnlyScenesAndKeyframesMayBeCompressed) {
  for (const ChunkType type :
       {ChunkType::input, ChunkType::hash, ChunkType::event, ChunkType::end}) {
    const Bytes log = bomb(type, 40);
    EXPECT_EQ(outcome_of(log), VerifyOutcome::corrupt) << to_string(type);
    expect_bounded(log);
  }
}

TEST(Bomb, LengthsAreBoundByTheConfigurationInTheHeader) {
  const Bytes good = record({.ticks = 30});
  const auto chunks = chunks_of(good);
  // Of 60 ticks of two players with four bytes, and of their hashes.
  const std::pair<ChunkType, std::uint32_t> cases[] = {{ChunkType::input, 60 * (2 + 2 * 6) + 1},
                                                       {ChunkType::hash, 60 * 8 + 1},
                                                       {ChunkType::end, 71 + 256 + 1},
                                                       {ChunkType::index, 4096 * 16 + 9},
                                                       {ChunkType::signature, 105}};
  for (const auto& [type, bytes] : cases) {
    Bytes log = good;
    const bool is_known = type <= ChunkType::hash || type == ChunkType::end;
    ChunkPlace place = chunks[is_known ? find_chunk(chunks, type) : 1];
    place.frame.header.type = type;
    place.frame.header.flags = is_known ? 0 : k_flag_may_skip;
    replace_payload(log, place, Bytes(bytes), Codec::raw, bytes);
    MemorySource source(log);
    const LogInfo info = read_log_info(source).value();
    ASSERT_TRUE(info.damage.has_value()) << to_string(type);
    EXPECT_NE(info.damage->what.find("limit"), std::string::npos) << info.damage->what;
  }
}

TEST(Bomb, ASnapshotLongerThanTheSimulationsIsRefusedBeforeItIsRead) {
  Bytes log = record({.ticks = 30});
  const auto chunks = chunks_of(log);
  constexpr std::uint32_t k_bytes = 1U << 20;
  replace_payload(log, chunks[find_chunk(chunks, ChunkType::keyframe)], Bytes(k_bytes), Codec::raw,
                  k_bytes);
  take_heap_use();
  const VerifyReport report = verify_toy(log);
  EXPECT_LT(take_heap_use().largest_bytes, k_bytes / 4);
  EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
  EXPECT_NE(report.damage->what.find("snapshot longer"), std::string::npos) << report.to_line();
}

TEST(Bomb, ATickHasOneKeyframe) {
  Bytes log = record({.ticks = 30});
  const auto chunks = chunks_of(log);
  const ChunkPlace& place = chunks[find_chunk(chunks, ChunkType::keyframe)];
  const Bytes chunk(log.begin() + static_cast<std::ptrdiff_t>(place.offset),
                    log.begin() + static_cast<std::ptrdiff_t>(place.end()));
  log.insert(log.begin() + static_cast<std::ptrdiff_t>(place.end()), chunk.begin(), chunk.end());
  relink(log);
  const VerifyReport report = verify_toy(log);
  EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
  EXPECT_NE(report.damage->what.find("second keyframe"), std::string::npos) << report.to_line();
}

TEST(Bomb, ARecorderWritesOneKeyframeForATick) {
  MemorySink sink;
  ToySimulation game(ToyConfig{});
  Recorder recorder(sink, {.keyframe_bytes_max = game.snapshot_bytes_max(SnapshotKind::canonical)});
  ASSERT_EQ(recorder.begin(game.info(), ToyConfig{}.encode(), {}), Status::ok);
  EXPECT_EQ(recorder.keyframe(game), Status::ok);
  EXPECT_EQ(recorder.keyframe(game), Status::invalid_argument);
}

TEST(Bomb, ManyKeyframesDoNotMakeManySimulations) {
  const Bytes log = record({.ticks = 600, .keyframe_interval = 1, .chunk_ticks = 1});
  std::atomic<int> made = 0;
  const SimulationFactory factory = [&](ByteView config) {
    ++made;
    return toy_factory()(config);
  };
  const SourceOpener opener = opener_of(log);
  const auto reports = verify_all({&opener, 1}, factory, {}, 2);
  EXPECT_EQ(reports.front().to_line(), "same; 600 ticks verified");
  EXPECT_LE(made, 40);  // for each of sixteen parts one that steps and one to load keyframes into
}

TEST(Bomb, APackedStateStaysWithinTheRatio) {
  if (!compression_available()) GTEST_SKIP();
  for (const std::uint32_t raw_bytes : {1000U, 1U << 20, 1U << 26}) {
    const Bytes file = pack_snapshot(Bytes(raw_bytes));
    EXPECT_GE(file.size() * k_max_compression_ratio, raw_bytes);
    EXPECT_EQ(unpack_snapshot(file).value().size(), raw_bytes);
  }
}

TEST(Bomb, ASnapshotFileAsksForNoMoreThanItsBytesMayStandFor) {
  const Bytes packed = zeros_packed(k_max_keyframe_bytes);
  Bytes file(16 + packed.size() + 8);
  ByteWriter writer(file);
  writer.put(std::uint32_t{0x53534b4c});
  writer.put(std::uint16_t{2});
  writer.put(Codec::zstd);
  writer.put(std::uint8_t{0});
  writer.put(static_cast<std::uint32_t>(k_max_keyframe_bytes));
  writer.put(static_cast<std::uint32_t>(packed.size()));
  writer.put_bytes(packed);
  writer.put(hash64(writer.written()));
  take_heap_use();
  EXPECT_EQ(unpack_snapshot(file).status(),
            compression_available() ? Status::malformed : Status::unsupported_version);
  EXPECT_LT(take_heap_use().peak_bytes, k_held_per_byte * file.size());
}

// Lengths, counts, codecs, types and payloads as anybody may write them, under right checksums.
void damage_frame(Bytes& log, const ChunkPlace& place, Random& random) {
  ChunkFrame frame = place.frame;
  const auto extreme = [&] {
    return static_cast<std::uint32_t>(random.next() >> random.below(64));
  };
  switch (random.below(4)) {
    case 0:
      frame.header.raw_bytes = extreme();
      frame.header.codec = Codec::zstd;
      break;
    case 1:
      frame.header.count = extreme();
      break;
    case 2:
      frame.header.type = static_cast<ChunkType>(random.below(12));
      break;
    default:
      break;
  }
  set_frame(log, place, frame);
}

TEST(Bomb, NoMutatedLogAsksForMoreThanItsLengthAndItsConfigurationNeed) {
  const std::vector<Bytes> seeds{
      record({.ticks = 30}),
      record({.ticks = 30, .start_tick = 4, .compress = compression_available(), .index = true})};
  for (std::uint64_t seed = 1; seed <= 400; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    Bytes log = seeds[random.below(seeds.size())];
    const auto chunks = chunks_of(log);
    const ChunkPlace& place = chunks[random.below(chunks.size())];
    if (random.below(3) == 0) {
      const auto raw_bytes = static_cast<std::uint32_t>(1 + random.below(std::size_t{64} << 20));
      replace_payload(log, place, zeros_packed(raw_bytes), Codec::zstd, raw_bytes);
    } else {
      damage_frame(log, place, random);
      relink(log);
    }
    if (random.below(4) == 0) log.resize(random.below(log.size()));
    expect_bounded(log);
    if (HasFatalFailure()) return;
  }
}

}  // namespace
}  // namespace lockstone::test
