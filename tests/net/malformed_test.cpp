#include <gtest/gtest.h>

#include <lockstone/net/wire.h>

#include "net/transport/random.h"
#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

MatchOptions endless_match() {
  MatchOptions options;
  options.toy.player_count = 2;
  return options;
}

// The clients of the fixture are the only connections of their transports, so theirs is number 1.
constexpr ConnectionId k_to_server = 1;

void send_bytes(Match& match, std::size_t slot, ByteView bytes) {
  EXPECT_EQ(match.players[slot].transport->send(k_to_server, Channel::reliable, bytes), Status::ok);
}

TEST(Malformed, ThreePacketsEndTheConnectionWithAReason) {
  Match match(endless_match());
  match.run_for(k_second_us);
  const std::array<std::byte, 2> junk{std::byte{200}, std::byte{1}};
  for (int i = 0; i < 2; ++i)
    send_bytes(match, 1, junk);
  match.run_for(k_second_us);
  EXPECT_EQ(match.server->present_mask(), 0b11);
  send_bytes(match, 1, junk);
  match.run_for(k_second_us);
  EXPECT_EQ(match.server->present_mask(), 0b01);
  EXPECT_EQ(match.players[1].client->failure(), ClientFailure::dropped);
  EXPECT_EQ(match.players[1].client->leave_reason(), LeaveReason::malformed);
  EXPECT_EQ(match.server->stats(1).malformed_packets, 3U);
}

TEST(Malformed, ClaimsBeyondTheMatchAreNotBelieved) {
  Match match(endless_match());
  match.run_for(k_second_us);
  std::array<std::byte, 400> bytes{};
  Inputs ahead;
  ahead.ticks_received = 1'000'000;
  send_bytes(match, 0, ByteView(bytes).first(encode(ahead, bytes)));
  Inputs hashes;
  hashes.first_hash_tick = 1'000'000;
  hashes.hash_count = 32;
  send_bytes(match, 0, ByteView(bytes).first(encode(hashes, bytes)));
  match.run_for(100'000);
  EXPECT_EQ(match.server->stats(0).malformed_packets, 2U);
  send_bytes(match, 0, ByteView(bytes).first(encode(Resend{1'000'000, 5}, bytes)));
  match.run_for(k_second_us);
  EXPECT_EQ(match.server->present_mask(), 0b10);
  match.expect_all_equal();
}

TEST(Malformed, DumpThatNobodyAskedForChangesNothing) {
  Match match(endless_match());
  match.run_for(k_second_us);
  std::array<std::byte, 400> bytes{};
  const std::array<std::byte, 10> chunk{};
  send_bytes(match, 0, ByteView(bytes).first(encode(Dump{3, 4'000'000'000U, 0, chunk}, bytes)));
  match.run_for(k_second_us);
  EXPECT_EQ(match.server->present_mask(), 0b11);
  EXPECT_TRUE(match.server_log.reports.empty());
}

TEST(Malformed, RandomPacketsNeverCrashTheServer) {
  constexpr std::uint64_t k_seed = 31;
  Random random(k_seed);
  for (int round = 0; round < 60; ++round) {
    Match match(endless_match());
    match.run_for(300'000);
    for (int i = 0; i < 40; ++i) {
      std::vector<std::byte> bytes(1 + random.below(60));
      for (std::byte& byte : bytes)
        byte = static_cast<std::byte>(random.below(256));
      bytes[0] = static_cast<std::byte>(random.below(24));
      static_cast<void>(match.players[0].transport->send(k_to_server, Channel::reliable, bytes));
      match.step();
    }
    match.run_for(200'000);
    EXPECT_NE(match.server->present_mask() & 0b10, 0) << "seed " << k_seed;
    EXPECT_EQ(match.players[1].client->state(), ClientState::running);
  }
}

TEST(Malformed, CorruptedDatagramsNeverCrashEitherSide) {
  std::uint64_t refused = 0;
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    MatchOptions options = endless_match();
    options.seed = seed;
    options.faults = rough(50'000);
    options.faults.corrupt_ppm = 20'000;
    options.faults.truncate_ppm = 20'000;
    Match match(options);
    match.run_for(5 * k_second_us);
    for (std::uint8_t slot = 0; slot < 2; ++slot) {
      refused += match.server->stats(slot).malformed_packets;
      refused += match.players[slot].client->stats().malformed_packets;
    }
  }
  EXPECT_GT(refused, 0U);
}

}  // namespace
}  // namespace lockstone::net::test
