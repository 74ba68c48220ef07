#include "net/session/hash_judge.h"

#include <gtest/gtest.h>

#include "net/security/entry_limits.h"
#include "net/session/peer_watch.h"

namespace lockstone::net {
namespace {

HashJudge judge_of(std::size_t players, bool has_own) {
  HashJudge judge(players, 16, has_own);
  for (std::size_t slot = 0; slot < players; ++slot)
    judge.set_present(slot, true);
  return judge;
}

TEST(HashJudge, FindsTheFirstTickThoughReportsComeLate) {
  HashJudge judge = judge_of(1, true);
  for (std::uint64_t tick = 0; tick < 8; ++tick)
    judge.push_own(tick);
  EXPECT_FALSE(judge.advance().has_value());
  for (std::uint64_t tick = 0; tick < 8; ++tick)
    judge.push(0, tick >= 5 ? 100 : tick);
  const std::optional<Mismatch> found = judge.advance();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->tick, 5U);
  EXPECT_EQ(found->hash_here, 5U);
  EXPECT_EQ(found->hash_there, 100U);
  EXPECT_EQ(judge.player(0).equal, 5U);
  EXPECT_EQ(judge.player(0).compared, 6U);
  EXPECT_FALSE(judge.advance().has_value());
}

TEST(HashJudge, WaitsForEveryPlayerInARelay) {
  HashJudge judge = judge_of(2, false);
  judge.push(0, 7);
  EXPECT_FALSE(judge.advance().has_value());
  EXPECT_EQ(judge.judged_ticks(), 0U);
  judge.push(1, 7);
  EXPECT_FALSE(judge.advance().has_value());
  EXPECT_EQ(judge.judged_ticks(), 1U);
}

TEST(HashJudge, DoesNotWaitForWhoLeft) {
  HashJudge judge = judge_of(2, false);
  judge.push(0, 7);
  judge.set_present(1, false);
  EXPECT_FALSE(judge.advance().has_value());
  EXPECT_EQ(judge.judged_ticks(), 1U);
}

TEST(HashJudge, ReportsEveryMinorityOfOneTickInSlotOrder) {
  HashJudge judge = judge_of(5, false);
  const std::array<std::uint64_t, 5> hashes{1, 9, 1, 1, 8};
  for (std::size_t slot = 0; slot < 5; ++slot)
    judge.push(slot, hashes[slot]);
  const std::optional<Mismatch> first = judge.advance();
  const std::optional<Mismatch> second = judge.advance();
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->slot, 1);
  EXPECT_EQ(second->slot, 4);
  EXPECT_EQ(first->verdict, Verdict::minority);
  EXPECT_EQ(second->tick, 0U);
}

TEST(HashJudge, HalfIsNoMajority) {
  HashJudge judge = judge_of(4, false);
  const std::array<std::uint64_t, 4> hashes{1, 1, 2, 2};
  for (std::size_t slot = 0; slot < 4; ++slot)
    judge.push(slot, hashes[slot]);
  const std::optional<Mismatch> found = judge.advance();
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->verdict, Verdict::undecided);
}

TEST(HashJudge, TakesNoReportThatWouldOverwriteAnUncomparedOne) {
  HashJudge judge = judge_of(2, false);
  for (int tick = 0; tick < 16; ++tick) {
    ASSERT_TRUE(judge.can_push(0));
    judge.push(0, 1);
  }
  EXPECT_FALSE(judge.can_push(0));
}

TEST(RightHashes, KnowTheLastTicksOnly) {
  RightHashes right(4);
  EXPECT_FALSE(right.knows(0));
  for (std::uint64_t tick = 0; tick < 6; ++tick)
    right.push(100 + tick);
  EXPECT_EQ(right.end(), 6U);
  EXPECT_FALSE(right.knows(1));
  EXPECT_TRUE(right.knows(2));
  EXPECT_EQ(right.at(2), 102U);
  EXPECT_FALSE(right.knows(6));
}

TEST(RightHashes, KnowTheLastHashOfAMatchThatGoesOn) {
  RightHashes right(4);
  right.begin_after(50, 7);
  EXPECT_FALSE(right.knows(48));
  EXPECT_TRUE(right.knows(49));
  EXPECT_EQ(right.at(49), 7U);
  EXPECT_EQ(right.end(), 50U);
}

TEST(PlayerHashes, CountFromTheirFirstReportUntilAMismatch) {
  PlayerHashes player;
  player.reported = HashRing(8);
  player.first = 2;
  player.reported.restart(2);
  player.reported.push(5);
  EXPECT_FALSE(player.counts_at(1));
  EXPECT_TRUE(player.counts_at(2));
  EXPECT_FALSE(player.counts_at(3));
  player.ignored = true;
  EXPECT_FALSE(player.counts_at(2));
}

TEST(EntryLimits, LimitEachPlayerAlone) {
  EntryLimits limits(4);
  const PeerIdentity one{true, 1, 10, 0};
  const PeerIdentity other{true, 1, 11, 1};
  for (std::uint32_t i = 0; i < EntryLimits::k_burst; ++i)
    EXPECT_TRUE(limits.take(one, 0));
  EXPECT_FALSE(limits.take(one, 0));
  EXPECT_TRUE(limits.take(other, 0));
  EXPECT_TRUE(limits.take(one, 1'000'000)) << "one a second comes back";
}

TEST(EntryLimits, ForgetTheLeastRecentSeatWhenAllPlacesAreUsed) {
  EntryLimits limits(2);
  const auto player = [](std::uint64_t number) { return PeerIdentity{true, 1, number, 0}; };
  for (std::uint32_t i = 0; i < EntryLimits::k_burst; ++i)
    EXPECT_TRUE(limits.take(player(1), 0));
  EXPECT_TRUE(limits.take(player(2), 1));
  EXPECT_TRUE(limits.take(player(3), 2));
  EXPECT_TRUE(limits.take(player(1), 3)) << "it is taken for a new one";
}

TEST(PeerWatch, CountsThreeBadPacketsInTenSeconds) {
  PeerWatch watch;
  EXPECT_FALSE(watch.malformed(0));
  EXPECT_FALSE(watch.malformed(5'000'000));
  EXPECT_FALSE(watch.malformed(11'000'000));
  EXPECT_TRUE(watch.malformed(14'000'000));
}

TEST(PeerWatch, WarnsOncePerSilence) {
  PeerWatch watch;
  watch.heard(1000);
  EXPECT_FALSE(watch.warn(1500, 750));
  EXPECT_TRUE(watch.warn(2000, 750));
  EXPECT_FALSE(watch.warn(3000, 750));
  watch.heard(3000);
  EXPECT_TRUE(watch.warn(4000, 750));
}

}  // namespace
}  // namespace lockstone::net
