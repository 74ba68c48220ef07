#include <gtest/gtest.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

MatchOptions watched_match(std::uint64_t ticks, std::uint32_t delay_ticks) {
  MatchOptions options;
  options.toy.player_count = 2;
  options.server.tick_count = ticks;
  options.server.max_spectators = 4;
  options.server.spectator_delay_ticks = delay_ticks;
  options.server.history_ticks = 2048;
  options.client.history_ticks = 2048;
  return options;
}

TEST(Spectator, SeesAllOfAMatchLaterThanThePlayers) {
  for (std::uint32_t delay_ticks : {0U, 120U}) {
    MatchOptions options = watched_match(600, delay_ticks);
    options.faults = rough(100'000);
    Match match(options);
    match.add_player(k_spectator_slot);
    std::uint64_t least = ~std::uint64_t{0};
    for (int i = 0; i < 2000; ++i) {
      match.step();
      const std::uint64_t closed = match.server->ticks_confirmed();
      if (closed > 200 && closed < 590) {
        least = std::min(least, closed - match.players[2].client->ticks_stepped());
      }
    }
    EXPECT_GE(least, delay_ticks);
    EXPECT_LT(least, delay_ticks + 30);
    ASSERT_TRUE(match.run(30 * k_second_us));
    EXPECT_EQ(match.players[2].client->state(), ClientState::finished);
    EXPECT_EQ(match.players[2].client->ticks_stepped(), 600U);
    match.expect_all_equal();
  }
}

TEST(Spectator, ComesLateIntoAMatch) {
  for (bool authoritative : {true, false}) {
    for (std::uint32_t delay_ticks : {0U, 300U}) {
      if (!authoritative && delay_ticks > 0) continue;  // a relay keeps no states
      MatchOptions options = watched_match(1800, delay_ticks);
      options.authoritative = authoritative;
      Match match(options);
      match.run_for(22 * k_second_us);
      match.add_player(k_spectator_slot);
      match.run_for(2 * k_second_us);
      const Client& spectator = *match.players[2].client;
      EXPECT_EQ(spectator.state(), ClientState::running);
      EXPECT_EQ(spectator.stats().states_loaded, 1U);
      EXPECT_GT(spectator.ticks_stepped() + delay_ticks + 30, match.server->ticks_confirmed());
      EXPECT_LE(spectator.ticks_stepped() + delay_ticks, match.server->ticks_confirmed());
      ASSERT_TRUE(match.run(30 * k_second_us));
      EXPECT_EQ(spectator.ticks_stepped(), 1800U);
      match.expect_all_equal();
    }
  }
}

TEST(Spectator, IsDroppedWhenItIsTooSlowAndNobodyWaitsForIt) {
  MatchOptions options = watched_match(1200, 0);
  options.server.late_policy = LatePolicy::strict;
  options.server.spectator_queue_ticks = 120;
  Match match(options);
  match.add_player(k_spectator_slot);
  match.network.partition(*match.players[2].transport, 2 * k_second_us, 30 * k_second_us,
                          Cut::receiving);
  match.run_for(8 * k_second_us);
  EXPECT_EQ(match.server->spectators(), 0U);
  EXPECT_GT(match.server->ticks_confirmed(), 450U);
  EXPECT_EQ(match.server->present_mask(), 0b11);
}

TEST(Spectator, IsRefusedWithoutASeat) {
  MatchOptions options = watched_match(600, 0);
  options.server.max_spectators = 1;
  Match match(options);
  match.add_player(k_spectator_slot);
  match.run_for(k_second_us);
  match.add_player(k_spectator_slot);
  match.run_for(k_second_us);
  EXPECT_EQ(match.players[2].client->state(), ClientState::running);
  EXPECT_EQ(match.players[3].client->refusal().reason, RefuseReason::match_full);
}

TEST(Spectator, NeedsAHistoryAsLongAsItsDelay) {
  Match match(watched_match(600, 0));
  ServerParts parts;
  parts.transport = &match.server_transport;
  ServerConfig config = match.options.server;
  config.spectator_delay_ticks = 180 * 60;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::spectators_out_of_range);
  config.history_ticks = 16'384;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::none);
  config.spectator_delay_ticks = 181 * 60;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::spectators_out_of_range);
}

}  // namespace
}  // namespace lockstone::net::test
