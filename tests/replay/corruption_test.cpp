// Every damage that the checksums are there for is found, and found where it is.
#include <random>

#include <gtest/gtest.h>

#include <lockstone/hash.h>

#include "tests/replay/log_tools.h"
#include "tests/support/random.h"

namespace lockstone::test {
namespace {

using namespace replay;

ToyMatch small_match() {
  return {.config = {.body_count = 2}, .ticks = 9, .keyframe_interval = 4, .chunk_ticks = 3};
}

// The chunk that holds a byte; the file header is an empty place at 0.
ChunkPlace place_of(const std::vector<ChunkPlace>& chunks, std::size_t offset) {
  for (const ChunkPlace& place : chunks) {
    if (offset >= place.offset && offset < place.end()) return place;
  }
  return {.offset = 0, .bytes = chunks[0].offset, .frame = {}};
}

TEST(Corruption, EveryFlipOfEveryByteIsCorruptAndFoundInItsChunk) {
  const Bytes good = record(small_match());
  const auto chunks = chunks_of(good);
  ASSERT_EQ(verify_toy(good).outcome, VerifyOutcome::same);
  Bytes log = good;
  for (std::size_t offset = 0; offset < log.size(); ++offset) {
    const ChunkPlace place = place_of(chunks, offset);
    for (const int flip : {1, 2, 4, 8, 16, 32, 64, 128, 0xff, 0x81, 0x5a}) {
      log[offset] ^= static_cast<std::byte>(flip);
      const VerifyReport report = verify_toy(log);
      ASSERT_EQ(report.outcome, VerifyOutcome::corrupt) << offset << ' ' << report.to_line();
      ASSERT_TRUE(report.damage.has_value());
      EXPECT_GE(report.damage->offset, place.offset);
      EXPECT_LE(report.damage->offset, offset >= chunks[0].offset ? place.offset : good.size());
      log[offset] = good[offset];
    }
  }
}

TEST(Corruption, AllWholeTicksBeforeTheDamageAreVerified) {
  const Bytes good = record({.ticks = 60});
  const auto chunks = chunks_of(good);
  std::uint64_t ticks = 0;
  for (const ChunkPlace& place : chunks) {
    Bytes log = good;
    log[place.end() - 1] ^= std::byte{1};
    const VerifyReport report = verify_toy(log);
    EXPECT_EQ(report.ticks_verified, ticks);
    EXPECT_EQ(report.damage->type, place.frame.header.type);
    if (place.frame.header.type == ChunkType::hash) ticks += place.frame.header.count;
  }
}

TEST(Corruption, TwoChunksInEachOthersPlaceAreFound) {
  const Bytes good = record(small_match());
  const auto chunks = chunks_of(good);
  for (std::size_t a = 0; a < chunks.size(); ++a) {
    for (std::size_t b = a + 1; b < chunks.size(); ++b) {
      std::vector<std::size_t> order(chunks.size());
      for (std::size_t i = 0; i < order.size(); ++i)
        order[i] = i;
      std::swap(order[a], order[b]);
      Bytes log(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(chunks[0].offset));
      for (const std::size_t i : order) {
        const auto chunk = std::span(good).subspan(chunks[i].offset, chunks[i].bytes);
        log.insert(log.end(), chunk.begin(), chunk.end());
      }
      const VerifyReport report = verify_toy(log);
      EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
      EXPECT_EQ(report.damage->offset, chunks[a].offset);
    }
  }
}

TEST(Corruption, AMissingChunkIsFoundUnlessItIsTheLast) {
  const Bytes good = record(small_match());
  const auto chunks = chunks_of(good);
  for (const ChunkPlace& place : chunks) {
    Bytes log = good;
    const auto begin = log.begin() + static_cast<std::ptrdiff_t>(place.offset);
    log.erase(begin, begin + static_cast<std::ptrdiff_t>(place.bytes));
    const VerifyReport report = verify_toy(log);
    if (place.end() == good.size()) {
      EXPECT_EQ(report.outcome, VerifyOutcome::same);
      EXPECT_FALSE(report.complete);
      EXPECT_EQ(verify_toy(log, {.strict = true}).outcome, VerifyOutcome::corrupt);
      continue;
    }
    EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
    EXPECT_EQ(report.damage->offset, place.offset);
  }
}

TEST(Corruption, ARepeatedChunkIsFound) {
  const Bytes good = record(small_match());
  for (const ChunkPlace& place : chunks_of(good)) {
    Bytes log = good;
    const auto chunk = std::span(good).subspan(place.offset, place.bytes);
    log.insert(log.begin() + static_cast<std::ptrdiff_t>(place.end()), chunk.begin(), chunk.end());
    const VerifyReport report = verify_toy(log);
    EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
    EXPECT_EQ(report.damage->offset, place.end());
  }
}

TEST(Corruption, AChunkOfAnotherLogIsFound) {
  const Bytes good = record(small_match());
  ToyMatch match = small_match();
  match.config.seed = 2;
  const Bytes other = record(match);
  const auto chunks = chunks_of(good);
  const auto others = chunks_of(other);
  const std::size_t index = find_chunk(chunks, ChunkType::hash);
  ASSERT_EQ(chunks[index].bytes, others[index].bytes);
  Bytes log = good;
  std::copy_n(other.begin() + static_cast<std::ptrdiff_t>(others[index].offset),
              others[index].bytes, log.begin() + static_cast<std::ptrdiff_t>(chunks[index].offset));
  const VerifyReport report = verify_toy(log);
  EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
  EXPECT_EQ(report.damage->offset, chunks[index].offset);
}

TEST(Corruption, RandomBytesAreNotALog) {
  std::mt19937_64 random(run_seed());
  for (int round = 0; round < 2000; ++round) {
    Bytes bytes(random() % 300);
    for (std::byte& byte : bytes)
      byte = static_cast<std::byte>(random() & 0xff);
    EXPECT_EQ(verify_toy(bytes).outcome, VerifyOutcome::corrupt);
  }
}

// Builds damage with right checksums, so that the decoders behind the checksums are reached.
TEST(Corruption, RandomContentUnderRightChecksumsNeverCrashesAndIsNeverSameUnnoticed) {
  std::mt19937_64 random(run_seed());
  const Bytes good = record(small_match());
  const auto chunks = chunks_of(good);
  for (int round = 0; round < 3000; ++round) {
    Bytes log = good;
    const ChunkPlace& place = chunks[random() % chunks.size()];
    if (place.bytes == k_chunk_header_bytes) continue;
    const std::size_t byte = random() % (place.bytes - k_chunk_header_bytes);
    log[place.offset + k_chunk_header_bytes + byte] ^= static_cast<std::byte>(1 + random() % 255);
    relink(log);
    const VerifyReport report = verify_toy(log);
    const ChunkType type = place.frame.header.type;
    const bool is_for_people = type == ChunkType::event || type == ChunkType::end;
    // Only the state of a slot's unused input bytes, and text, may change without consequence.
    if (type == ChunkType::hash || type == ChunkType::keyframe) {
      EXPECT_NE(report.outcome, VerifyOutcome::same) << to_string(type) << ' ' << byte;
    }
    if (report.outcome == VerifyOutcome::same) {
      EXPECT_TRUE(is_for_people || type == ChunkType::input) << to_string(type);
    }
  }
}

// A log whose header says that version; its chunks follow from the header that it had.
Bytes log_of_version(std::uint8_t version, const ToyMatch& match) {
  Bytes log = record(match);
  const std::size_t header_bytes = chunks_of(log)[0].offset;
  log[8] = std::byte{version};
  const auto covered = std::span(log).first(header_bytes - k_checksum_bytes);
  ByteWriter(std::span(log).subspan(covered.size())).put(hash64(covered, 1));
  return log;
}

TEST(Corruption, ALogOfTheVersionBeforeIsStillRead) {
  Bytes log = log_of_version(3, small_match());
  relink(log);
  EXPECT_EQ(verify_toy(log).outcome, VerifyOutcome::same);
}

TEST(Corruption, ALogOfTheVersionBeforeHadAtMost16Players) {
  ToyMatch match = small_match();
  match.config.player_count = 17;
  match.config.body_count = 17;
  EXPECT_EQ(verify_toy(log_of_version(4, match)).outcome, VerifyOutcome::same);
  const VerifyReport report = verify_toy(log_of_version(3, match));
  EXPECT_EQ(report.outcome, VerifyOutcome::corrupt);
  EXPECT_EQ(report.damage->what, "player count out of range");
}

TEST(Corruption, AHeaderOfAnotherVersionIsIncompatibleNotCorrupt) {
  const VerifyReport report = verify_toy(log_of_version(1, small_match()));
  EXPECT_EQ(report.outcome, VerifyOutcome::incompatible);
  EXPECT_EQ(report.damage->status, Status::unsupported_version);
}

}  // namespace
}  // namespace lockstone::test
