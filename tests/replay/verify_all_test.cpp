// Verifying in segments on several threads gives the same report as verifying in one piece.
#include <gtest/gtest.h>

#include <lockstone/replay/verifier.h>

#include "tests/replay/log_tools.h"
#include "tests/support/random.h"

namespace lockstone::test {
namespace {

using namespace replay;

std::vector<VerifyReport> verify_parts(const std::vector<Bytes>& logs, unsigned threads,
                                       const VerifyOptions& options = {}) {
  std::vector<SourceOpener> openers;
  for (const Bytes& log : logs) {
    openers.push_back([&log]() -> Result<std::unique_ptr<Source>> {
      return std::unique_ptr<Source>(std::make_unique<MemorySource>(log));
    });
  }
  return verify_all(openers, toy_factory(), options, threads);
}

void expect_same_verdict(const Bytes& log) {
  const VerifyReport whole = verify_toy(log);
  for (const unsigned threads : {1U, 3U}) {
    const VerifyReport parts = verify_parts({log}, threads).front();
    EXPECT_EQ(parts.to_line(), whole.to_line());
    EXPECT_EQ(parts.complete, whole.complete);
    EXPECT_EQ(parts.final_hash, whole.final_hash);
    EXPECT_EQ(parts.end_reason, whole.end_reason);
  }
}

TEST(VerifyAll, SaysTheSameOfGoodLogs) {
  expect_same_verdict(record({.ticks = 100}));
  expect_same_verdict(record({.ticks = 100, .keyframe_interval = 0}));
  expect_same_verdict(record({.ticks = 100, .start_tick = 30, .compress = true, .index = true}));
  expect_same_verdict(record({.ticks = 100, .finishes = false}));
}

TEST(VerifyAll, SaysTheSameOfADivergence) {
  const Bytes log = rewrite(record({.ticks = 100}), [](auto tick, auto slot, auto bytes) {
    if (tick == 37 && slot == 1) bytes[0] ^= std::byte{4};
  });
  expect_same_verdict(log);
  EXPECT_EQ(verify_parts({log}, 4).front().outcome, VerifyOutcome::diverged);
}

TEST(VerifyAll, SaysTheSameOfDamageAnywhere) {
  const Bytes good = record({.ticks = 100});
  Random random;
  for (int i = 0; i < 60; ++i) {
    Bytes log = good;
    log[random.below(log.size())] ^= static_cast<std::byte>(1U << random.below(8));
    expect_same_verdict(log);
    log.resize(random.below(log.size()));
    expect_same_verdict(log);
  }
}

// Its totals and its transcript concern the whole log, of which no part sees all.
TEST(VerifyAll, SaysTheSameOfAnEndThatIsNotTheLogs) {
  const Bytes good = record({.ticks = 100});
  const auto chunks = chunks_of(good);
  const std::size_t end = chunks[find_chunk(chunks, ChunkType::end)].offset + k_chunk_header_bytes;
  for (const std::size_t byte : {0U, 8U, 16U, 24U, 32U, 37U, 68U}) {
    Bytes log = good;
    log[end + byte] ^= std::byte{1};
    relink(log);
    expect_same_verdict(log);
    EXPECT_EQ(verify_parts({log}, 3).front().outcome, VerifyOutcome::corrupt) << byte;
  }
}

TEST(VerifyAll, ReportsEachLog) {
  const Bytes good = record({.ticks = 60});
  Bytes damaged = good;
  damaged[damaged.size() / 2] ^= std::byte{1};
  const auto reports = verify_parts({good, damaged, good}, 4);
  ASSERT_EQ(reports.size(), 3U);
  EXPECT_EQ(reports[0].outcome, VerifyOutcome::same);
  EXPECT_EQ(reports[1].outcome, VerifyOutcome::corrupt);
  EXPECT_EQ(reports[2].outcome, VerifyOutcome::same);
  EXPECT_EQ(reports[2].ticks_verified, 60U);
}

TEST(VerifyAll, CountsEveryTick) {
  const Bytes log = record({.ticks = 100});
  const std::vector<SourceOpener> openers(2, [&log]() -> Result<std::unique_ptr<Source>> {
    return std::unique_ptr<Source>(std::make_unique<MemorySource>(log));
  });
  std::uint64_t last = 0, all = 0;
  const auto progress = [&](std::uint64_t ticks, std::uint64_t total) {
    EXPECT_GT(ticks, last);
    last = ticks;
    all = total;
  };
  static_cast<void>(verify_all(openers, toy_factory(), {}, 4, progress));
  EXPECT_EQ(last, 200U);
  EXPECT_EQ(all, 200U);
}

TEST(VerifyAll, ALogThatCannotBeOpenedIsCorrupt) {
  const SourceOpener opener = []() -> Result<std::unique_ptr<Source>> { return Status::not_found; };
  const auto reports = verify_all({&opener, 1}, toy_factory(), {}, 2);
  EXPECT_EQ(reports.front().outcome, VerifyOutcome::corrupt);
}

}  // namespace
}  // namespace lockstone::test
