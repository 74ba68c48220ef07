// One value for all that was played.
#include <string_view>

#include <gtest/gtest.h>

#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/transcript.h>

#include "replay/bytes/sha256.h"
#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

std::string sha256(std::string_view text) {
  Sha256 hash;
  hash.update(std::as_bytes(std::span(text)));
  return to_text(hash.value());
}

// FIPS 180-4's own examples, and the length at which the padding takes a block of its own.
TEST(Sha256, GivesTheStandardsValues) {
  EXPECT_EQ(sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TranscriptHash end_of(const Bytes& log) {
  MemorySource source(log);
  LogReader reader(source);
  EXPECT_EQ(reader.open(), Status::ok);
  while (!is_last(reader.next())) {
  }
  EXPECT_TRUE(reader.complete()) << reader.damage().what;
  return reader.end().transcript;
}

TEST(Transcript, OfALogsEndIsThatOfAPlayerWhoSawTheSameTicks) {
  const ToyMatch match{.ticks = 50};
  ToyInputs inputs(match.config);
  Transcript transcript;
  for (std::uint64_t tick = 0; tick < match.ticks; ++tick)
    transcript.add(tick, inputs.at(tick));
  const Bytes log = record(match);
  EXPECT_EQ(end_of(log), transcript.value());
  EXPECT_EQ(verify_toy(log).transcript, transcript.value());
}

TEST(Transcript, IsAnotherForEachOriginByteTickAndPlayer) {
  const Bytes log = record({.ticks = 30});
  const TranscriptHash good = end_of(log);
  const Bytes other = rewrite(log, [](auto tick, auto slot, auto bytes) {
    if (tick == 21 && slot == 1) bytes[3] ^= std::byte{0x10};
  });
  EXPECT_NE(end_of(other), good);
  EXPECT_NE(end_of(record({.ticks = 29})), good);
  EXPECT_NE(end_of(record({.ticks = 30, .start_tick = 1})), good);
}

// A forger that changes an input and corrects every checksum, but forgets the END.
TEST(Transcript, IsCheckedAgainstTheInputs) {
  const Bytes good = record({.ticks = 30});
  const Bytes other = rewrite(good, [](auto tick, auto slot, auto bytes) {
    if (tick == 21 && slot == 1) bytes[3] ^= std::byte{0x10};
  });
  const ChunkPlace from = chunks_of(good).back();
  Bytes log = other;
  std::copy_n(good.begin() + static_cast<std::ptrdiff_t>(from.offset), from.bytes,
              log.begin() + static_cast<std::ptrdiff_t>(chunks_of(other).back().offset));
  relink(log);
  MemorySource source(log);
  LogReader reader(source);
  ASSERT_EQ(reader.open(), Status::ok);
  LogItem last = reader.next();
  while (!is_last(last))
    last = reader.next();
  EXPECT_EQ(last, LogItem::damaged);
  EXPECT_NE(reader.damage().what.find("transcript"), std::string::npos);
}

TEST(Proof, OfAnUnsignedLogSaysThatItsInputsAreNotProved) {
  const VerifyReport report = verify_toy(record({}));
  const auto lines = report.not_proved(SignatureState::none);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_NE(lines[0].find("not signed"), std::string::npos);
  EXPECT_NE(lines[1].find(to_text(report.transcript)), std::string::npos);
  EXPECT_FALSE(report.not_proved(SignatureState::unchecked).empty());
  EXPECT_TRUE(report.not_proved(SignatureState::good).empty());
}

TEST(Proof, OfALogThatWasCutNamesTheTicksInItsLine) {
  const auto line = [](const Bytes& log) { return verify_toy(log).to_line(); };
  const Bytes whole = record({.ticks = 40});
  EXPECT_EQ(line(whole), "same; 40 ticks verified");
  const std::string first = "cut at tick 40: only the first 40 ticks are proved";
  EXPECT_NE(line(record({.ticks = 40, .finishes = false})).find(first), std::string::npos);
  const Bytes torn(whole.begin(), whole.end() - 3);
  EXPECT_NE(line(torn).find(first), std::string::npos);
  const auto parts = [&](std::uint64_t begin) {
    MemorySource source(whole);
    MemorySink sink;
    EXPECT_EQ(cut(source, toy_factory(), begin, 30, sink).status, Status::ok);
    return line(sink.bytes());
  };
  EXPECT_NE(parts(0).find("cut at tick 30: only the first 30 ticks are proved"), std::string::npos);
  EXPECT_NE(parts(10).find("begins at tick 10, cut at tick 30: only these 20 ticks are proved"),
            std::string::npos);
}

}  // namespace
}  // namespace lockstone::test
