// Signed logs: good ones pass, and nothing can be altered, put in or cut off unseen.
#include <gtest/gtest.h>

#include <lockstone/replay/signature.h>

#include "tests/replay/log_tools.h"

namespace lockstone::test {
namespace {

using namespace replay;

class Signature : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!signing_available()) GTEST_SKIP() << "built without libsodium";
    key = make_signing_key().value();
    log = record({.ticks = 40, .index = true, .signing_key = key});
  }

  static SignatureReport check(const Bytes& bytes, const std::optional<PublicKey>& expected = {}) {
    MemorySource source(bytes);
    return check_signatures(source, expected);
  }

  SigningKey key;
  Bytes log;
};

TEST_F(Signature, OfAWholeLogIsGood) {
  const SignatureReport report = check(log, key.public_key());
  EXPECT_EQ(report.state, SignatureState::good);
  EXPECT_EQ(report.signatures, 40U / 8 + 1);
  EXPECT_EQ(report.covered_ticks, 40U);
  EXPECT_TRUE(report.covers_end);
  EXPECT_EQ(report.key, key.public_key());
  EXPECT_EQ(verify_toy(log, {.strict = true}).outcome, VerifyOutcome::same);
}

TEST_F(Signature, CoversEveryByteBeforeIt) {
  const auto chunks = chunks_of(log);
  Bytes altered = log;
  const ChunkPlace& input = chunks[find_chunk(chunks, ChunkType::input)];
  altered[input.offset + k_chunk_header_bytes + 2] ^= std::byte{1};
  relink(altered);  // the checksums are right again: only the signature can tell
  EXPECT_EQ(check(altered).state, SignatureState::bad);
}

TEST_F(Signature, OfAnotherKeyIsForeign) {
  const PublicKey other = make_signing_key().value().public_key();
  EXPECT_EQ(check(log, other).state, SignatureState::foreign);
}

TEST_F(Signature, TellsWhenTheEndWasCutOff) {
  const auto chunks = chunks_of(log);
  const std::size_t last_keyframe = find_chunk(chunks, ChunkType::signature, 4);
  const Bytes cut(log.begin(),
                  log.begin() + static_cast<std::ptrdiff_t>(chunks[last_keyframe].end()));
  const SignatureReport report = check(cut, key.public_key());
  EXPECT_EQ(report.state, SignatureState::good);
  EXPECT_FALSE(report.covers_end);
  EXPECT_EQ(report.covered_ticks, 40U);
}

// A chunk that a reader skips, with a right checksum, sequence number and place in the chain.
Bytes with_chunk_behind(const Bytes& log, const ChunkHeader& header, std::size_t payload_bytes) {
  Bytes longer = log;
  const auto chunks = chunks_of(log);
  ChunkFrame frame{header, chunks.back().frame.checksum, 0, 0};
  frame.header.sequence = static_cast<std::uint32_t>(chunks.size());
  frame.header.raw_bytes = frame.header.stored_bytes = static_cast<std::uint32_t>(payload_bytes);
  const Bytes payload(payload_bytes);
  frame.payload_checksum = payload_checksum(payload);
  longer.resize(log.size() + k_chunk_header_bytes);
  encode_chunk_frame(frame, std::span(longer).last<k_chunk_header_bytes>());
  longer.insert(longer.end(), payload.begin(), payload.end());
  return longer;
}

TEST_F(Signature, CoversTheWholeFileSoThatNothingMayFollowIt) {
  for (const ChunkType type : {ChunkType{200}, ChunkType::diag, ChunkType::index, ChunkType::event,
                               ChunkType::signature, ChunkType::end}) {
    const Bytes longer = with_chunk_behind(log, {.type = type, .flags = k_flag_may_skip}, 40);
    const SignatureReport report = check(longer, key.public_key());
    EXPECT_FALSE(report.state == SignatureState::good && report.covers_end) << to_string(type);
    EXPECT_EQ(verify_toy(longer).outcome, VerifyOutcome::corrupt) << to_string(type);
  }
  for (const std::size_t bytes : {1U, 55U, 56U, 5000U}) {
    Bytes longer = log;
    longer.resize(log.size() + bytes);
    EXPECT_EQ(check(longer, key.public_key()).state, SignatureState::bad) << bytes;
    EXPECT_EQ(verify_toy(longer).outcome, VerifyOutcome::corrupt) << bytes;
  }
}

TEST_F(Signature, OfAnUnsignedLogIsNone) {
  EXPECT_EQ(check(record({})).state, SignatureState::none);
}

TEST_F(Signature, KeysAreText) {
  EXPECT_EQ(SigningKey::from_text(key.to_text()).value().bytes, key.bytes);
  const PublicKey shown = key.public_key();
  EXPECT_EQ(PublicKey::from_text(shown.to_text()).value(), shown);
  EXPECT_FALSE(PublicKey::from_text("12").ok());
  EXPECT_FALSE(PublicKey::from_text(std::string(64, 'g')).ok());
}

}  // namespace
}  // namespace lockstone::test
