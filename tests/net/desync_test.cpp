#include <gtest/gtest.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

MatchOptions match_with_flip(std::uint8_t players, std::uint64_t seed, std::size_t slot,
                             const Flip& flip) {
  MatchOptions options;
  options.toy.player_count = players;
  options.toy.seed = seed;
  options.server.tick_count = 400;
  options.server.desync_policy = DesyncPolicy::end_match;
  options.seed = seed;
  options.flips.resize(players);
  options.flips[slot] = {flip};
  return options;
}

const std::vector<Flip>& flips() {
  static const std::vector<Flip> all{
      {0, "body", "position.x", 17, 0},   {1, "body", "velocity.y", 3, 62},
      {57, "world", "random", 0, 63},     {101, "player", "score", 1, 5},
      {128, "body", "heat", 23, 1},       {222, "body", "spin", 9, 33},
      {399, "body", "position.y", 0, 20},
  };
  return all;
}

void expect_report(const DesyncReport& report, const Flip& flip, std::size_t slot) {
  EXPECT_EQ(report.tick, flip.tick);
  EXPECT_EQ(report.slot, slot);
  EXPECT_TRUE(report.difference.differs);
  EXPECT_EQ(report.difference.store, flip.store);
  EXPECT_EQ(report.difference.object, flip.object);
  EXPECT_EQ(report.difference.field, flip.field);
  EXPECT_NE(report.difference.here, report.difference.there);
  EXPECT_NE(report.hash_here, report.hash_there);
}

TEST(Desync, NamesTickObjectAndFieldOfOneFlippedBit) {
  std::uint64_t seed = 1;
  for (const Flip& flip : flips()) {
    for (bool lossy : {false, true}) {
      const std::size_t slot = seed % 2;
      MatchOptions options = match_with_flip(2, seed, slot, flip);
      if (lossy) options.faults = rough(200'000);
      Match match(options);
      SCOPED_TRACE("seed " + std::to_string(seed) + ", tick " + std::to_string(flip.tick));
      ASSERT_TRUE(match.run(60 * k_second_us));
      EXPECT_EQ(match.server->finish_reason(), FinishReason::desync);
      ASSERT_EQ(match.server_log.reports.size(), 1U);
      expect_report(match.server_log.reports[0], flip, slot);
      EXPECT_EQ(match.server_log.reports[0].verdict, Verdict::client_diverged);
      for (const Match::Player& player : match.players) {
        ASSERT_EQ(player.log->reports.size(), 1U);
        EXPECT_EQ(player.log->reports[0].to_line(), match.server_log.reports[0].to_line());
      }
      ++seed;
    }
  }
}

TEST(Desync, IsFoundInFastMatchesToo) {
  std::uint64_t seed = 50;
  for (const Flip& flip : flips()) {
    MatchOptions options = match_with_flip(2, seed++, 1, flip);
    options.server.pacing = Pacing::fast;
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us));
    ASSERT_EQ(match.server_log.reports.size(), 1U);
    expect_report(match.server_log.reports[0], flip, 1);
  }
}

// Where 64 bits meet by chance, 128 a part do not: the next check finds it, and names the part.
TEST(Desync, PartsShowDifferencesThatTheHashMisses) {
  for (const std::uint8_t prediction : {std::uint8_t{0}, std::uint8_t{4}}) {
    MatchOptions options = match_with_flip(3, 60, 1, {100, "body", "spin", 5, 9});
    options.authoritative = false;
    options.blind = true;
    options.client.prediction_ticks = prediction;
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us));
    ASSERT_EQ(match.server_log.reports.size(), 1U);
    const DesyncReport& report = match.server_log.reports[0];
    EXPECT_EQ(report.tick, 127U);
    EXPECT_EQ(report.part, "bodies");
    EXPECT_EQ(report.verdict, Verdict::minority);
    EXPECT_EQ(report.difference.store, "body");
    EXPECT_EQ(match.server->stats(0).parts_equal, 2U);  // after 64 and 128 ticks
    EXPECT_EQ(match.server->stats(1).parts_equal + match.server->stats(2).parts_equal, 3U);
  }
}

TEST(Desync, PartsAreJudgedByTheMajorityWhicheverSlotIsWrong) {
  for (std::uint8_t slot = 0; slot < 3; ++slot) {
    MatchOptions options = match_with_flip(3, 64, slot, {100, "body", "spin", 5, 9});
    options.authoritative = false;
    options.blind = true;
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us));
    ASSERT_EQ(match.server_log.reports.size(), 1U) << int{slot};
    EXPECT_EQ(match.server_log.reports[0].slot, slot);
    EXPECT_EQ(match.server_log.reports[0].verdict, Verdict::minority);
  }
}

TEST(Desync, PartsAreComparedEvery64Ticks) {
  for (const bool authoritative : {true, false}) {
    for (const std::uint8_t prediction : {std::uint8_t{0}, std::uint8_t{6}}) {
      MatchOptions options = match_with_flip(3, 70, 0, {100'000, "world", "random", 0, 0});
      options.authoritative = authoritative;
      options.client.prediction_ticks = prediction;
      options.faults = rough(100'000);
      Match match(options);
      ASSERT_TRUE(match.run(60 * k_second_us));
      EXPECT_TRUE(match.server_log.reports.empty());
      for (std::uint8_t slot = 0; slot < 3; ++slot)
        EXPECT_EQ(match.server->stats(slot).parts_equal, 6U);  // of 400 ticks
    }
  }
}

TEST(Desync, IsNotReportedWithoutAFlip) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    MatchOptions options = match_with_flip(3, seed, 0, {100'000, "world", "random", 0, 0});
    options.faults = rough(200'000);
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us));
    EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
    EXPECT_TRUE(match.server_log.reports.empty());
  }
}

TEST(Desync, MajorityJudgesInARelay) {
  for (std::size_t slot = 0; slot < 3; ++slot) {
    const Flip flip{150, "body", "velocity.x", 12, 7};
    MatchOptions options = match_with_flip(3, 5 + slot, slot, flip);
    options.authoritative = false;
    options.faults = rough(150'000);
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us));
    ASSERT_EQ(match.server_log.reports.size(), 1U);
    expect_report(match.server_log.reports[0], flip, slot);
    EXPECT_EQ(match.server_log.reports[0].verdict, Verdict::minority);
  }
}

TEST(Desync, OfTwoWithoutAJudgeIsUndecidedWithBothDumps) {
  const Flip flip{77, "body", "heat", 4, 0};
  MatchOptions options = match_with_flip(2, 6, 0, flip);
  options.authoritative = false;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  const DesyncReport& report = match.server_log.reports[0];
  expect_report(report, flip, 1);  // slot 0 speaks for itself: it is "here"
  EXPECT_EQ(report.verdict, Verdict::undecided);
  ASSERT_EQ(match.server_log.dump_sizes.size(), 2U);
  EXPECT_GT(match.server_log.dump_sizes[0], 0U);
  EXPECT_GT(match.server_log.dump_sizes[1], 0U);
  EXPECT_EQ(match.server_log.agreed.size(), 77U);
}

TEST(Desync, KicksEveryDivergedPlayerWherePolicySaysSo) {
  MatchOptions options = match_with_flip(4, 8, 1, {90, "body", "spin", 2, 3});
  options.flips[3] = {{90, "player", "score", 0, 1}};
  options.server.desync_policy = DesyncPolicy::kick;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  ASSERT_EQ(match.server_log.reports.size(), 2U);
  expect_report(match.server_log.reports[0], {90, "body", "spin", 2, 3}, 1);
  expect_report(match.server_log.reports[1], {90, "player", "score", 0, 1}, 3);
  EXPECT_EQ(match.players[1].client->state(), ClientState::failed);
  EXPECT_EQ(match.players[1].client->leave_reason(), LeaveReason::desync);
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 400U);
  EXPECT_EQ(match.server->stats(0).hashes_equal, 400U);
}

TEST(Desync, FreezesTheMatchWhileItIsExplained) {
  // Closing tick 100, reporting its hash and fetching the dump take 24 ticks of 1/60 s each way
  // and back; only the first of the two may go on.
  MatchOptions options = match_with_flip(2, 10, 1, {100, "body", "spin", 2, 3});
  options.faults.delay_us = 200'000;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  EXPECT_EQ(match.server_log.reports[0].tick, 100U);
  EXPECT_GT(match.server->ticks_confirmed(), 120U);
  EXPECT_LT(match.server->ticks_confirmed(), 136U);
}

TEST(Desync, IsExplainedThoughItsReportsWereCutOff) {
  const Flip flip{100, "body", "spin", 2, 3};
  MatchOptions options = match_with_flip(2, 11, 1, flip);
  options.server.snapshot_ticks = 512;
  Match match(options);
  // The client goes on hearing ticks, but must not step past the ticks that its snapshots cover.
  match.network.partition(*match.players[1].transport, k_second_us, 5 * k_second_us, Cut::sending);
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  expect_report(match.server_log.reports[0], flip, 1);
}

TEST(Desync, JudgeThatWasHitItselfSaysSo) {
  MatchOptions options = match_with_flip(2, 12, 0, {100'000, "world", "random", 0, 0});
  options.client.build = "toy 1.0";
  options.server.desync_policy = DesyncPolicy::kick;
  Match match(options);
  match.run_for(2 * k_second_us);
  const std::uint64_t tick = match.server->ticks_confirmed();
  ASSERT_TRUE(match.server_simulation.flip_bit("body", 5, "spin", 17));
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_GE(match.server_log.reports.size(), 1U);
  EXPECT_EQ(match.server_log.reports[0].tick, tick);
  EXPECT_EQ(match.server_log.reports[0].verdict, Verdict::server_diverged);
  EXPECT_EQ(match.server_log.reports[0].difference.field, "spin");
  EXPECT_EQ(match.server_log.reports[0].build_there, "toy 1.0");
  EXPECT_EQ(match.server->finish_reason(), FinishReason::desync);
}

TEST(Desync, LineReadsLikeASentence) {
  DesyncReport report;
  report.tick = 1842;
  report.slot = 2;
  report.difference = {true, "body", 17, "crate", "velocity.y", "0x0003a2f1", "0x0003a2f0"};
  EXPECT_EQ(
      report.to_line(),
      "tick 1842, player 2, body 17 \"crate\", velocity.y: 0x0003a2f1 here, 0x0003a2f0 there");
}

TEST(Desync, LineDoesNotNameTwoPlayersAlike) {
  DesyncReport report;
  report.tick = 90;
  report.slot = 3;
  report.difference = {true, "player", 0, "", "score", "0x01", "0x02"};
  EXPECT_EQ(report.to_line(), "tick 90, state of player 3, player 0, score: 0x01 here, 0x02 there");
}

TEST(Desync, LineNamesAPlayerOnceWhoseOwnFieldsDiffer) {
  DesyncReport report;
  report.tick = 90;
  report.slot = 3;
  report.difference = {true, "player", 3, "", "score", "0x01", "0x02"};
  EXPECT_EQ(report.to_line(), "tick 90, player 3, score: 0x01 here, 0x02 there");
}

TEST(Desync, WithoutSnapshotsStillNamesTickAndPlayer) {
  MatchOptions options = match_with_flip(2, 9, 1, {33, "body", "spin", 2, 3});
  options.client.snapshot_ticks = 0;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  EXPECT_EQ(match.server_log.reports[0].tick, 33U);
  EXPECT_EQ(match.server_log.reports[0].slot, 1U);
  EXPECT_FALSE(match.server_log.reports[0].difference.differs);
  EXPECT_EQ(match.server_log.reports[0].to_line().find("tick 33, player 1, hash: 0x"), 0U);
}

}  // namespace
}  // namespace lockstone::net::test
