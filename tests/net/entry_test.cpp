#include <algorithm>

#include <gtest/gtest.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

MatchOptions rejoinable_match(std::uint8_t players, std::uint64_t ticks, std::uint64_t seed) {
  MatchOptions options = match_of(players, ticks, seed);
  options.server.rejoin_seed = 99;
  return options;
}

void expect_active_from(const Match& match, std::size_t slot, std::uint64_t tick) {
  const std::vector<SeenTick>& ticks = match.server_log.seen.ticks;
  ASSERT_LT(tick, ticks.size());
  EXPECT_EQ(ticks[tick - 1].origins[slot], InputOrigin::absent);
  EXPECT_NE(ticks[tick].origins[slot], InputOrigin::absent);
  EXPECT_EQ(ticks[tick + 60].origins[slot], InputOrigin::received);
}

TEST(Entry, LateJoinerPlaysFromTheAnnouncedTickAndNobodyWaits) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    MatchOptions options = rejoinable_match(3, 700, seed);
    options.authoritative = seed % 2 == 0;
    if (seed > 4) options.faults = rough(100'000);
    options.server.start_players = 2;
    Match match(options);
    match.players[2].paused = true;
    match.run_for(4 * k_second_us);
    EXPECT_GT(match.server->ticks_confirmed(), 200U);
    match.players[2].paused = false;
    ASSERT_TRUE(match.run(30 * k_second_us)) << "seed " << seed;
    EXPECT_LT(match.now_us, 13 * k_second_us);
    EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
    EXPECT_EQ(match.players[2].client->ticks_stepped(), 700U);
    ASSERT_EQ(match.server_log.active.size(), 1U);
    EXPECT_EQ(match.server_log.active[0].first, 2);
    EXPECT_EQ(match.players[2].client->active_tick(), match.server_log.active[0].second);
    expect_active_from(match, 2, match.server_log.active[0].second);
    match.expect_all_equal();
  }
}

TEST(Entry, TakesTheStateOfAnotherDonorWhenOneIsGone) {
  MatchOptions options = rejoinable_match(4, 900, 5);
  options.authoritative = false;
  options.server.start_players = 3;
  options.server.history_ticks = 256;
  Match match(options);
  match.players[3].paused = true;
  match.run_for(4 * k_second_us);
  match.players[3].paused = false;
  for (int i = 0; i < 1000 && match.players[3].client->state() != ClientState::joining; ++i)
    match.step();
  match.network.kill(*match.players[0].transport);  // slot 0 is asked first
  match.players[0].paused = true;
  ASSERT_TRUE(match.run(40 * k_second_us));
  EXPECT_EQ(match.players[3].client->ticks_stepped(), 900U);
  EXPECT_EQ(match.players[3].client->stats().states_loaded, 1U);
  match.expect_all_equal();
}

TEST(Entry, LostPlayerGoesOnWithTicksAlone) {
  MatchOptions options = rejoinable_match(2, 900, 7);
  Match match(options);
  match.network.partition(*match.players[1].transport, 2 * k_second_us, 9 * k_second_us);
  match.run_for(9 * k_second_us);
  ASSERT_EQ(match.players[1].client->failure(), ClientFailure::server_silent);
  EXPECT_EQ(match.server->present_mask(), 0b01);
  EXPECT_TRUE(match.reconnect(match.players[1]));
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.players[1].client->ticks_stepped(), 900U);
  EXPECT_EQ(match.players[1].client->stats().states_loaded, 0U);
  EXPECT_EQ(match.server->stats(1).entries, 1U);
  EXPECT_EQ(match.players[1].log->first_tick, 0U);
  match.expect_all_equal();
}

// The connection is still dead when it calls for the first time.
TEST(Entry, LostPlayerMayCallAgainAndAgain) {
  Match match(rejoinable_match(2, 1200, 7));
  match.network.partition(*match.players[1].transport, 2 * k_second_us, 15 * k_second_us);
  match.run_for(9 * k_second_us);
  ASSERT_EQ(match.players[1].client->failure(), ClientFailure::server_silent);
  EXPECT_TRUE(match.reconnect(match.players[1]));
  match.network.partition(*match.players[1].transport, 9 * k_second_us, 15 * k_second_us);
  match.run_for(7 * k_second_us);
  ASSERT_EQ(match.players[1].client->failure(), ClientFailure::handshake_timed_out);
  EXPECT_TRUE(match.reconnect(match.players[1]));
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.players[1].client->ticks_stepped(), 1200U);
  EXPECT_EQ(match.server->stats(1).entries, 1U);
  match.expect_all_equal();
}

TEST(Entry, LostPlayerGetsAStateWhenTheGapIsTooLong) {
  MatchOptions options = rejoinable_match(2, 900, 8);
  options.server.history_ticks = 256;
  Match match(options);
  match.network.partition(*match.players[1].transport, 2 * k_second_us, 9 * k_second_us);
  match.run_for(9 * k_second_us);
  EXPECT_TRUE(match.reconnect(match.players[1]));
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.players[1].client->ticks_stepped(), 900U);
  EXPECT_EQ(match.players[1].client->stats().states_loaded, 1U);
  match.expect_all_equal();
}

TEST(Entry, SeatIsKeptForWhoHasItsKey) {
  Match match(rejoinable_match(2, 1200, 9));
  match.run_for(3 * k_second_us);
  const std::uint64_t key = match.players[1].client->rejoin_key();
  EXPECT_NE(key, 0U);
  EXPECT_NE(key, match.players[0].client->rejoin_key());
  match.network.kill(*match.players[1].transport);
  match.players[1].paused = true;
  match.run_for(6 * k_second_us);
  const std::size_t stranger = match.players.size();
  match.add_player(k_no_slot);
  match.run_for(k_second_us);
  EXPECT_EQ(match.players[stranger].client->refusal().reason, RefuseReason::match_full);
  match.add_player(k_no_slot, key);
  match.run_for(2 * k_second_us);
  EXPECT_EQ(match.players.back().client->state(), ClientState::running);
  EXPECT_EQ(match.players.back().client->slot(), 1);
  match.expect_all_equal();
}

// It was cut off for four seconds before, and has ticks whose hashes it still owes.
TEST(Entry, SeatIsKeptForWhoIsLostWhileItCatchesUp) {
  for (const std::int64_t killed_ms : {6'200, 6'600, 7'000, 8'000, 9'000, 10'000}) {
    MatchOptions options = rejoinable_match(2, 1800, 20);
    options.faults.delay_us = 330'000;
    Match match(options);
    match.network.partition(*match.players[1].transport, 2 * k_second_us, 6 * k_second_us);
    match.run_for(killed_ms * 1000);
    const std::uint64_t key = match.players[1].client->rejoin_key();
    match.network.kill(*match.players[1].transport);
    match.players[1].paused = true;
    match.run_for(7 * k_second_us);
    EXPECT_EQ(match.server->counters().expelled, 0U) << killed_ms;
    match.add_player(k_no_slot, key);
    match.run_for(5 * k_second_us);
    EXPECT_EQ(match.players.back().client->state(), ClientState::running) << killed_ms;
    EXPECT_EQ(match.players.back().client->slot(), 1);
  }
}

// The one that is gone had sent inputs far ahead, for ticks that its next life plays.
TEST(Entry, InputsOfAFormerLifeAreForgotten) {
  MatchOptions options = rejoinable_match(2, 600, 14);
  options.server.late_policy = LatePolicy::strict;
  Match match(options);
  match.run_for(2 * k_second_us);
  match.players[0].paused = true;  // the match waits, and player 1 samples ahead
  match.run_for(k_second_us);
  const std::uint64_t key = match.players[1].client->rejoin_key();
  match.network.kill(*match.players[1].transport);
  match.players[1].paused = true;
  match.add_player(k_no_slot, key);  // whose inputs are others
  match.run_for(k_second_us);
  match.players[0].paused = false;
  ASSERT_TRUE(match.run(30 * k_second_us));
  const Match::Player& back = match.players.back();
  EXPECT_EQ(back.client->ticks_stepped(), 600U);
  const std::vector<SeenTick>& ticks = match.server_log.seen.ticks;
  ASSERT_FALSE(match.server_log.active.empty());
  const std::size_t size = options.toy.input_bytes;
  std::vector<std::byte> own(size);
  for (std::uint64_t tick = match.server_log.active.back().second; tick < ticks.size(); ++tick) {
    back.inputs->sample(tick, own);
    ASSERT_EQ(ticks[tick].origins[1], InputOrigin::received);
    ASSERT_TRUE(std::equal(own.begin(), own.end(),
                           ticks[tick].bytes.begin() + static_cast<std::ptrdiff_t>(size)))
        << tick;
  }
  match.expect_all_equal();
}

// It died before it had heard of its key.
TEST(Entry, SeatOfWhoNeverSpokeIsFreeWhenItIsLost) {
  MatchOptions options = rejoinable_match(2, 900, 15);
  options.faults.delay_us = 20'000;
  Match match(options);
  while (match.server->state() == ServerState::lobby)
    match.step();
  match.network.kill(*match.players[1].transport);
  match.players[1].paused = true;
  ASSERT_EQ(match.players[1].client->rejoin_key(), 0U);
  match.run_for(7 * k_second_us);
  match.add_player(1);
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.players.back().client->ticks_stepped(), 900U);
  EXPECT_EQ(match.players.back().client->slot(), 1);
  match.expect_all_equal();
}

TEST(Entry, KeyReplacesAConnectionThatTheServerStillBelievesIn) {
  Match match(rejoinable_match(2, 900, 10));
  match.run_for(3 * k_second_us);
  const std::uint64_t key = match.players[1].client->rejoin_key();
  match.network.kill(*match.players[1].transport);
  match.players[1].paused = true;
  match.add_player(k_no_slot, key);
  match.run_for(k_second_us);
  EXPECT_EQ(match.players.back().client->state(), ClientState::running);
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.players.back().client->ticks_stepped(), 900U);
  match.expect_all_equal();
}

TEST(Entry, SeatIsFreeForOthersWhenItsTimeIsOver) {
  MatchOptions options = rejoinable_match(2, 1200, 11);
  options.server.timeouts.rejoin_us = 2 * k_second_us;
  Match match(options);
  match.run_for(2 * k_second_us);
  match.network.kill(*match.players[1].transport);
  match.players[1].paused = true;
  match.run_for(8 * k_second_us);
  match.add_player(k_no_slot);
  match.run_for(2 * k_second_us);
  EXPECT_EQ(match.players.back().client->state(), ClientState::running);
  EXPECT_EQ(match.players.back().client->slot(), 1);
}

TEST(Entry, MatchWaitsWhileAllPlayersAreExpectedBack) {
  Match match(rejoinable_match(2, 600, 12));
  match.run_for(2 * k_second_us);
  match.network.partition(match.server_transport, match.now_us, match.now_us + 8 * k_second_us);
  match.run_for(8 * k_second_us);
  const std::uint64_t closed = match.server->ticks_confirmed();
  EXPECT_EQ(match.server->present_mask(), 0);
  EXPECT_EQ(match.server->state(), ServerState::running);
  EXPECT_LT(closed, 450U);
  for (Match::Player& player : match.players)
    EXPECT_TRUE(match.reconnect(player));
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 600U);
  match.expect_all_equal();
}

TEST(Entry, DivergedPlayerGetsTheRightStateOnce) {
  for (bool authoritative : {true, false}) {
    MatchOptions options = rejoinable_match(3, 600, 13);
    options.authoritative = authoritative;
    options.server.desync_policy = DesyncPolicy::resync;
    options.flips = {{}, {{120, "body", "spin", 3, 4}}};
    Match match(options);
    ASSERT_TRUE(match.run(30 * k_second_us));
    EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
    EXPECT_EQ(match.server_log.reports.size(), 1U);
    EXPECT_EQ(match.players[1].client->ticks_stepped(), 600U);
    EXPECT_EQ(match.players[1].client->stats().states_loaded, 1U);
    match.expect_all_equal();
  }
}

TEST(Entry, PlayerThatDivergesAgainIsKicked) {
  MatchOptions options = rejoinable_match(3, 600, 14);
  options.server.desync_policy = DesyncPolicy::resync;
  options.flips = {{}, {{120, "body", "spin", 3, 4}, {400, "body", "heat", 3, 4}}};
  Match match(options);
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_EQ(match.server_log.reports.size(), 2U);
  EXPECT_EQ(match.players[1].client->leave_reason(), LeaveReason::desync);
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 600U);
}

TEST(Entry, PausesAndGoesOn) {
  Match match(rejoinable_match(2, 400, 15));
  match.run_for(2 * k_second_us);
  match.players[1].client->ask(AskKind::pause);
  match.players[0].client->ask(AskKind::vote, 3, 1);
  match.run_for(k_second_us / 5);
  const std::vector<ServerLog::Asked> asked{{1, AskKind::pause, 0, 0}, {0, AskKind::vote, 3, 1}};
  EXPECT_TRUE(std::is_permutation(match.server_log.asked.begin(), match.server_log.asked.end(),
                                  asked.begin(), asked.end()));
  match.server->pause();
  match.run_for(k_second_us);
  const std::uint64_t closed = match.server->ticks_confirmed();
  EXPECT_TRUE(match.players[0].client->paused());
  match.run_for(10 * k_second_us);
  EXPECT_EQ(match.server->ticks_confirmed(), closed);
  match.server->resume();
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_FALSE(match.players[0].client->paused());
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 400U);
  match.expect_all_equal();
}

}  // namespace
}  // namespace lockstone::net::test
