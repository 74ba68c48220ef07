// One player tries everything to stop the match of the others.
#include <gtest/gtest.h>

#include "net/session/offender_list.h"
#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

using simnet::Lie;

constexpr std::uint64_t k_ticks = 600;
constexpr std::uint64_t k_lies_from = 150;
constexpr std::uint8_t k_liar = 1;

MatchOptions match_with(Lie lie, DesyncPolicy policy, std::uint64_t seed) {
  MatchOptions options = match_of(4, k_ticks, seed);
  options.secure = true;
  options.server.desync_policy = policy;
  options.liars.resize(4);
  options.liars[k_liar] = {lie, k_lies_from};
  return options;
}

// In virtual time: ten seconds of ticks, and a second at the beginning and at the end of it.
constexpr std::int64_t k_unhindered_us = 12 * k_second_us;

void expect_honest_played_on(const Match& match) {
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_EQ(match.server->ticks_confirmed(), k_ticks);
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == k_liar) continue;
    EXPECT_EQ(match.players[i].client->ticks_stepped(), k_ticks) << i;
    EXPECT_EQ(match.server->stats(static_cast<std::uint8_t>(i)).hashes_equal, k_ticks) << i;
    EXPECT_TRUE(match.players[i].log->replaced.empty()) << i;
  }
}

// How long it took until the server closed the last tick.
std::int64_t run_until_closed(Match& match) {
  while (match.server->ticks_confirmed() < k_ticks && match.now_us < 60 * k_second_us)
    match.step();
  return match.now_us;
}

TEST(HostilePlayer, WithWrongHashesStopsNobody) {
  std::uint64_t seed = 100;
  for (const bool authoritative : {true, false}) {
    for (const Lie lie : {Lie::once, Lie::always, Lie::alternately, Lie::parts}) {
      for (const DesyncPolicy policy : {DesyncPolicy::kick, DesyncPolicy::resync}) {
        SCOPED_TRACE(std::string(to_string(lie)) + (authoritative ? "" : ", relay") +
                     (policy == DesyncPolicy::kick ? ", kick" : ", resync"));
        MatchOptions options = match_with(lie, policy, ++seed);
        options.authoritative = authoritative;
        Match match(options);
        EXPECT_LT(run_until_closed(match), k_unhindered_us);
        ASSERT_TRUE(match.run(20 * k_second_us));
        expect_honest_played_on(match);
        match.expect_all_equal();
        const bool corrected = policy == DesyncPolicy::resync;
        EXPECT_EQ(match.server->counters().resyncs, corrected ? 1U : 0U);
        const bool kicked = !corrected || lie != Lie::once;
        EXPECT_EQ(match.server->counters().expelled, kicked ? 1U : 0U);
        if (kicked) {
          EXPECT_EQ(match.players[k_liar].client->leave_reason(), LeaveReason::desync);
        }
      }
    }
  }
}

TEST(HostilePlayer, IsToldOfWithoutADumpOfItsState) {
  Match match(match_with(Lie::always, DesyncPolicy::kick, 120));
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  const DesyncReport& report = match.server_log.reports[0];
  EXPECT_EQ(report.tick, k_lies_from);
  EXPECT_EQ(report.slot, k_liar);
  EXPECT_EQ(report.verdict, Verdict::client_diverged);
  EXPECT_EQ(report.hash_here, report.hash_there ^ 1);
  EXPECT_FALSE(report.difference.differs);
}

TEST(HostilePlayer, ThatWasKickedIsRefusedForTheRestOfTheMatch) {
  Match match(match_with(Lie::always, DesyncPolicy::kick, 121));
  match.run_for(7 * k_second_us);
  ASSERT_EQ(match.players[k_liar].client->state(), ClientState::failed);
  match.add_player(k_liar);  // the same token from a new process
  match.run_for(k_second_us);
  EXPECT_EQ(match.players[4].client->state(), ClientState::refused);
  EXPECT_EQ(match.players[4].client->refusal().reason, RefuseReason::expelled);
  ASSERT_TRUE(match.run(20 * k_second_us));
  expect_honest_played_on(match);
  EXPECT_EQ(match.server->counters().refused[static_cast<std::size_t>(RefuseReason::expelled)], 1U);
}

TEST(HostilePlayer, WithoutATokenLosesItsSeatForGood) {
  MatchOptions options = match_with(Lie::always, DesyncPolicy::kick, 122);
  options.secure = false;
  Match match(options);
  match.run_for(7 * k_second_us);
  match.add_player(k_liar);
  match.add_player(k_any_slot);
  match.run_for(k_second_us);
  EXPECT_EQ(match.players[4].client->refusal().reason, RefuseReason::expelled);
  EXPECT_EQ(match.players[5].client->refusal().reason, RefuseReason::match_full);
  ASSERT_TRUE(match.run(20 * k_second_us));
  expect_honest_played_on(match);
}

TEST(HostilePlayer, LeavesAndComesBackButIsCorrectedOnlyOnce) {
  MatchOptions options = match_with(Lie::alternately, DesyncPolicy::resync, 123);
  Match match(options);
  const auto corrected = [&] { return match.server->counters().resyncs == 1; };
  while (!corrected() && match.now_us < 20 * k_second_us)
    match.step();
  match.run_for(k_second_us / 100);
  match.players[k_liar].client->leave();
  match.options.liars.resize(5);
  match.options.liars[4] = {Lie::always, 0};
  match.run_for(k_second_us / 10);
  match.add_player(k_liar);
  ASSERT_TRUE(match.run(20 * k_second_us));
  expect_honest_played_on(match);
  EXPECT_EQ(match.server->counters().resyncs, 1U);
  EXPECT_EQ(match.server->counters().expelled, 1U);
  EXPECT_EQ(match.players[4].client->leave_reason(), LeaveReason::desync);
}

TEST(HostilePlayer, ThatReportsNothingIsDroppedAndHoldsNobodyUp) {
  for (const bool authoritative : {true, false}) {
    for (const LatePolicy late : {LatePolicy::deadline, LatePolicy::strict}) {
      MatchOptions options = match_with(Lie::silence, DesyncPolicy::kick, 124);
      options.authoritative = authoritative;
      options.server.late_policy = late;
      Match match(options);
      EXPECT_LT(run_until_closed(match), k_unhindered_us);
      ASSERT_TRUE(match.run(20 * k_second_us));
      expect_honest_played_on(match);
      EXPECT_EQ(match.players[k_liar].client->leave_reason(), LeaveReason::no_hashes);
    }
  }
}

// As fast as it goes, 512 ticks are over in a moment: then the others wait, but not for ever.
TEST(HostilePlayer, ThatReportsNothingHoldsUpAFastMatchNoLongerThanOneThatIsSilent) {
  MatchOptions options = match_with(Lie::silence, DesyncPolicy::kick, 125);
  options.server.pacing = Pacing::fast;
  options.server.tick_count = 3'000;
  Match match(options);
  ASSERT_TRUE(match.run(120 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 3'000U);
}

TEST(HostilePlayer, WithHashesOfTheFutureOrDumpsThatNobodyWantsIsSentAway) {
  for (const Lie lie : {Lie::future, Lie::dumps}) {
    SCOPED_TRACE(to_string(lie));
    Match match(match_with(lie, DesyncPolicy::kick, 126));
    EXPECT_LT(run_until_closed(match), k_unhindered_us);
    ASSERT_TRUE(match.run(20 * k_second_us));
    expect_honest_played_on(match);
    EXPECT_EQ(match.players[k_liar].client->leave_reason(), LeaveReason::malformed);
    EXPECT_GE(match.server->counters().malformed_packets, 3U);
    EXPECT_EQ(match.server->counters().expelled, 1U);
  }
}

// Two against three in a relay, each with its own lie; and three against nobody where the server
// judges.
TEST(HostilePlayer, InCompanyIsJudgedLikeOneAlone) {
  for (const bool authoritative : {true, false}) {
    MatchOptions options = match_of(5, k_ticks, 127);
    options.secure = true;
    options.authoritative = authoritative;
    options.liars = {{}, {Lie::always, 100}, {}, {Lie::always, 100}, {}};
    if (authoritative) options.liars[4] = {Lie::once, 100};
    Match match(options);
    EXPECT_LT(run_until_closed(match), k_unhindered_us);
    ASSERT_TRUE(match.run(20 * k_second_us));
    EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
    for (const std::size_t honest : {0U, 2U})
      EXPECT_EQ(match.players[honest].client->ticks_stepped(), k_ticks);
    EXPECT_EQ(match.server->counters().expelled, 2U);
    EXPECT_EQ(match.server->counters().resyncs, authoritative ? 3U : 2U);
  }
}

TEST(HostilePlayer, OfTwoWithoutAJudgeIsUndecidedStill) {
  MatchOptions options = match_of(2, k_ticks, 128);
  options.authoritative = false;
  options.liars = {{}, {Lie::once, 100}};
  Match match(options);
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::desync);
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  EXPECT_EQ(match.server_log.reports[0].verdict, Verdict::undecided);
}

// By default nobody's match ends because one player is wrong.
TEST(HostilePlayer, EndsNobodysMatchByDefault) {
  EXPECT_EQ(ServerConfig{}.desync_policy, DesyncPolicy::resync);
}

TEST(OffenderList, KnowsAnAccountInAnySeatAndAStrangerByItsSeat) {
  OffenderList list;
  const PeerIdentity account{true, 1, 77, 2};
  const PeerIdentity nameless{true, 1, 0, 2};
  const PeerIdentity stranger;
  list.ban(account, 2);
  EXPECT_TRUE(list.is_banned(account, 5));
  EXPECT_FALSE(list.is_banned(nameless, 2));
  list.ban(nameless, 2);
  EXPECT_TRUE(list.is_banned(nameless, 2));
  EXPECT_FALSE(list.is_banned(nameless, 3));
  EXPECT_FALSE(list.is_banned(stranger, 2));
  list.ban(stranger, 2);
  EXPECT_TRUE(list.is_banned(stranger, 2));
  EXPECT_FALSE(list.was_resynced(account, 2));
}

TEST(OffenderList, GrowsNoFurtherThanItsCapacity) {
  OffenderList list;
  for (std::uint64_t player = 1; player <= 3 * OffenderList::k_capacity; ++player)
    list.ban({true, 1, player, 0}, 0);
  EXPECT_FALSE(list.is_banned({true, 1, 1, 0}, 0));
  EXPECT_TRUE(list.is_banned({true, 1, 3 * OffenderList::k_capacity, 0}, 0));
}

}  // namespace
}  // namespace lockstone::net::test
