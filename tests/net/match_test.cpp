#include <gtest/gtest.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

std::size_t count_origin(const Seen& seen, std::size_t slot, InputOrigin origin) {
  std::size_t count = 0;
  for (const SeenTick& tick : seen.ticks)
    count += tick.origins[slot] == origin ? 1U : 0U;
  return count;
}

void expect_played_through(const Match& match, std::uint64_t ticks) {
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_EQ(match.server->ticks_confirmed(), ticks);
  EXPECT_TRUE(match.server_log.reports.empty());
  for (std::uint8_t slot = 0; slot < match.players.size(); ++slot) {
    const Client& client = *match.players[slot].client;
    EXPECT_EQ(client.state(), ClientState::finished);
    EXPECT_EQ(client.ticks_stepped(), ticks) << "slot " << int{slot};
    const PlayerStats stats = match.server->stats(slot);
    EXPECT_EQ(stats.hashes_compared, ticks);
    EXPECT_EQ(stats.hashes_equal, ticks);
    EXPECT_EQ(stats.malformed_packets, 0U);
    EXPECT_EQ(client.stats().malformed_packets, 0U);
  }
  match.expect_all_equal();
}

TEST(Match, OfTwoPlaysThroughOnAPerfectNetwork) {
  MatchOptions options = match_of(2, 300, 7);
  Match match(options);
  ASSERT_TRUE(match.run(30 * k_second_us));
  expect_played_through(match, 300);
  for (std::size_t slot = 0; slot < 2; ++slot) {
    EXPECT_EQ(count_origin(match.server_log.seen, slot, InputOrigin::received), 296U);
    EXPECT_EQ(count_origin(match.server_log.seen, slot, InputOrigin::neutral), 4U);
    EXPECT_EQ(match.server->stats(static_cast<std::uint8_t>(slot)).substituted_inputs, 0U);
  }
  EXPECT_TRUE(match.server_log.final_hash.has_value());
}

TEST(Match, CarriesTheInputsOfPlayersUnchanged) {
  Match match(match_of(2, 120, 11));
  ASSERT_TRUE(match.run(30 * k_second_us));
  for (std::uint64_t tick = 4; tick < 120; ++tick) {
    for (std::size_t slot = 0; slot < 2; ++slot) {
      std::array<std::byte, 4> expected{};
      lockstone::toy::toy_input(11, slot, tick, expected);
      const SeenTick& seen = match.server_log.seen.ticks[tick];
      for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(seen.bytes[slot * 4 + i], expected[i]);
    }
  }
}

TEST(Match, TakesAboutItsTicksInRealTime) {
  Match match(match_of(2, 300, 3));
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_GE(match.now_us, 5 * k_second_us);
  EXPECT_LE(match.now_us, 6 * k_second_us);
}

TEST(Match, OfTwoStaysEqualOverManyRoughNetworks) {
  for (std::uint64_t seed = 1; seed <= 24; ++seed) {
    MatchOptions options = match_of(2, 400, seed);
    options.faults = rough(static_cast<std::uint32_t>(100'000 + 8'000 * seed));
    options.server.input_delay_ticks = 6;
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us)) << "seed " << seed;
    expect_played_through(match, 400);
  }
}

TEST(Match, OfFourStaysEqualOverManyRoughNetworks) {
  for (std::uint64_t seed = 100; seed < 124; ++seed) {
    MatchOptions options = match_of(4, 400, seed);
    options.faults = rough(static_cast<std::uint32_t>(100'000 + 8'000 * (seed - 100)));
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us)) << "seed " << seed;
    expect_played_through(match, 400);
  }
}

TEST(Match, OfSixteenWithTheLongestInputsFitsItsDatagrams) {
  MatchOptions options = match_of(16, 150, 5);
  options.toy.input_bytes = 64;
  options.faults = rough(100'000);
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  expect_played_through(match, 150);
}

MatchOptions crowded_match(std::uint64_t ticks, std::uint64_t seed) {
  MatchOptions options = match_of(k_max_players, ticks, seed);
  options.toy.body_count = k_max_players;
  options.toy.input_bytes = 16;
  return options;
}

TEST(Match, Of64WithTheLongestInputsStaysEqualThroughLoss) {
  for (const bool authoritative : {true, false}) {
    MatchOptions options = crowded_match(100, 17);
    options.authoritative = authoritative;
    options.faults = rough(100'000);
    options.server.input_delay_ticks = 8;
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us));
    expect_played_through(match, 100);
    EXPECT_EQ(match.server_log.agreed.size(), authoritative ? 0U : 100U);
  }
}

TEST(Match, Of64WaitsForAnySlotAndFindsItsDesync) {
  MatchOptions options = crowded_match(200, 18);
  options.server.late_policy = LatePolicy::strict;
  options.authoritative = false;
  options.flips.resize(k_max_players);
  options.flips[63] = {{40, "body", "velocity.x", 12, 7}};
  Match match(options);
  match.run_for(k_second_us / 2);
  match.players[47].paused = true;
  match.run_for(k_second_us / 2);
  EXPECT_EQ(match.server->waiting_mask(), slot_bit(47));
  EXPECT_EQ(match.players[0].client->waiting_mask(), slot_bit(47));
  EXPECT_EQ(match.server->present_mask(), ~SlotMask{0});
  match.players[47].paused = false;
  match.run_for(3 * k_second_us);
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  EXPECT_EQ(match.server_log.reports[0].slot, 63);
  EXPECT_EQ(match.server_log.reports[0].verdict, Verdict::minority);
  EXPECT_EQ(match.server_log.reports[0].tick, 40U);
}

TEST(Match, IsRefusedWhoseTickWouldNotFitADatagram) {
  MatchOptions options = crowded_match(10, 1);
  options.toy.input_bytes = 17;
  ToySimulation simulation(options.toy);
  SimNetwork network(1);
  ServerConfig config;
  config.insecure = true;
  ServerParts parts;
  parts.transport = &network.add_endpoint();
  parts.simulation = &simulation;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::input_bytes_out_of_range);
}

TEST(Match, KeepsUpByResendsWhereTicksAreBigAndFarAway) {
  MatchOptions options = match_of(16, 300, 6);
  options.toy.input_bytes = 64;
  options.server.input_delay_ticks = 30;
  options.faults = rough(200'000);
  options.faults.burst_start_ppm = 30'000;
  options.faults.delay_us = 100'000;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  expect_played_through(match, 300);
  EXPECT_GT(match.players[0].client->stats().resends_requested, 0U);
  EXPECT_LT(match.now_us, 9 * k_second_us);
}

TEST(Match, DropsWhoNeedsTicksThatAreNotKeptAnyMore) {
  MatchOptions options = match_of(2, 600, 12);
  options.server.history_ticks = 256;
  Match match(options);
  match.network.partition(*match.players[1].transport, k_second_us, 30 * k_second_us,
                          Cut::receiving);
  match.run_for(7 * k_second_us);
  ASSERT_EQ(match.server_log.left.size(), 1U);
  EXPECT_EQ(match.server_log.left[0], std::pair(std::uint8_t{1}, LeaveReason::too_far_behind));
  EXPECT_GT(match.server->ticks_confirmed(), 400U);
  match.expect_all_equal();
}

TEST(Match, HearsAPlayerThatCannotHear) {
  MatchOptions options = match_of(2, 300, 13);
  Match match(options);
  match.network.partition(*match.players[1].transport, k_second_us, 3 * k_second_us,
                          Cut::receiving);
  ASSERT_TRUE(match.run(30 * k_second_us));
  expect_played_through(match, 300);
  EXPECT_GT(match.server->stats(1).substituted_inputs, 60U);
}

TEST(Match, RunsFastWithoutLateInputs) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    MatchOptions options = match_of(4, 600, seed);
    options.server.pacing = Pacing::fast;
    if (seed % 2 == 0) options.faults = rough(200'000);
    Match match(options);
    ASSERT_TRUE(match.run(120 * k_second_us)) << "seed " << seed;
    expect_played_through(match, 600);
    for (std::uint8_t slot = 0; slot < 4; ++slot) {
      EXPECT_EQ(match.server->stats(slot).substituted_inputs, 0U);
    }
  }
}

TEST(Match, RelayAgreesOnEveryHashWithoutSimulating) {
  MatchOptions options = match_of(3, 300, 9);
  options.authoritative = false;
  options.faults = rough(150'000);
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  expect_played_through(match, 300);
  ASSERT_EQ(match.server_log.agreed.size(), 300U);
  EXPECT_EQ(match.server_log.agreed, match.players[0].log->seen.hashes);
}

TEST(Match, SurvivesAPartitionThatHeals) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    MatchOptions options = match_of(3, 480, seed);
    options.faults = rough(100'000);
    Match match(options);
    match.network.partition(*match.players[1].transport, 2 * k_second_us, 4 * k_second_us);
    ASSERT_TRUE(match.run(60 * k_second_us));
    expect_played_through(match, 480);
    EXPECT_GE(match.server->stats(1).substituted_inputs, 60U);
    EXPECT_EQ(match.server_log.silent, std::vector<std::uint8_t>{1});
    // The others never felt it.
    EXPECT_LE(match.server->stats(0).substituted_inputs, 60U);
  }
}

TEST(Match, FlagsLateInputsTheSameEverywhere) {
  MatchOptions options = match_of(2, 240, 21);
  options.server.input_delay_ticks = 1;
  options.faults.delay_us = 60'000;
  options.client.adapt_lead = false;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  expect_played_through(match, 240);
  const std::size_t repeated = count_origin(match.server_log.seen, 0, InputOrigin::repeated);
  EXPECT_GT(repeated, 100U);
  EXPECT_EQ(match.server->stats(0).substituted_inputs, repeated);
  EXPECT_EQ(match.players[0].client->stats().substituted_inputs, repeated);
  EXPECT_GT(match.server->stats(0).late_inputs, 0U);
}

TEST(Match, SubstitutesNeutralInputsWhereAsked) {
  MatchOptions options = match_of(2, 120, 22);
  options.server.input_delay_ticks = 0;
  options.server.substitute = Substitute::neutral;
  options.faults.delay_us = 80'000;
  options.client.adapt_lead = false;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  expect_played_through(match, 120);
  EXPECT_EQ(count_origin(match.server_log.seen, 0, InputOrigin::repeated), 0U);
  EXPECT_GT(count_origin(match.server_log.seen, 0, InputOrigin::neutral), 50U);
}

TEST(Match, StrictWaitsAndSaysForWhom) {
  MatchOptions options = match_of(3, 240, 31);
  options.server.late_policy = LatePolicy::strict;
  options.faults = rough(100'000);
  Match match(options);
  match.run_for(2 * k_second_us);
  match.players[2].paused = true;
  match.run_for(k_second_us);
  const std::uint64_t stuck_at = match.server->ticks_confirmed();
  match.run_for(k_second_us);
  EXPECT_EQ(match.server->ticks_confirmed(), stuck_at);
  EXPECT_EQ(match.server->waiting_mask(), 0b100);
  EXPECT_EQ(match.players[0].client->waiting_mask(), 0b100);
  match.players[2].paused = false;
  ASSERT_TRUE(match.run(60 * k_second_us));
  expect_played_through(match, 240);
  for (std::uint8_t slot = 0; slot < 3; ++slot) {
    EXPECT_EQ(match.server->stats(slot).substituted_inputs, 0U);
  }
}

TEST(Match, StrictDropsWhoIsWaitedForTooLong) {
  MatchOptions options = match_of(3, 240, 32);
  options.server.late_policy = LatePolicy::strict;
  Match match(options);
  match.run_for(2 * k_second_us);
  match.players[2].paused = true;
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->ticks_confirmed(), 240U);
  ASSERT_EQ(match.server_log.left.size(), 1U);
  EXPECT_EQ(match.server_log.left[0], std::pair(std::uint8_t{2}, LeaveReason::timed_out));
  match.expect_all_equal();
}

TEST(Match, GoesOnWithAnAbsentSlotWhenAClientLeaves) {
  Match match(match_of(3, 240, 41));
  match.run_for(2 * k_second_us);
  match.players[1].client->leave();
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_GT(count_origin(match.server_log.seen, 1, InputOrigin::absent), 100U);
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 240U);
  EXPECT_EQ(match.server->present_mask(), 0);
  match.expect_all_equal();
}

TEST(Match, EndsWhenEverybodyLeft) {
  Match match(match_of(2, 0, 42));
  match.run_for(k_second_us);
  for (Match::Player& player : match.players)
    player.client->leave();
  ASSERT_TRUE(match.run(10 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::no_players);
}

TEST(Match, StopsWhenTheOwnerSaysSo) {
  Match match(match_of(2, 0, 43));
  match.run_for(3 * k_second_us);
  match.server->stop();
  ASSERT_TRUE(match.run(10 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::stopped);
  EXPECT_GT(match.server->ticks_confirmed(), 150U);
  EXPECT_EQ(match.players[0].client->ticks_stepped(), match.server->ticks_confirmed());
  EXPECT_EQ(match.players[0].client->finish_reason(), FinishReason::stopped);
  match.expect_all_equal();
}

TEST(Match, ClientFailsWhenTheServerFallsSilent) {
  Match match(match_of(2, 0, 44));
  match.run_for(k_second_us);
  match.network.partition(match.server_transport, match.now_us, match.now_us + 60 * k_second_us);
  match.run_for(6 * k_second_us);
  EXPECT_EQ(match.players[0].client->state(), ClientState::failed);
  EXPECT_EQ(match.players[0].client->failure(), ClientFailure::server_silent);
  EXPECT_EQ(match.server_log.left.size(), 2U);
}

TEST(Match, SameSeedGivesTheSameMatch) {
  std::vector<std::uint64_t> first_hashes;
  for (int round = 0; round < 2; ++round) {
    MatchOptions options = match_of(4, 200, 77);
    options.faults = rough(250'000);
    options.server.input_delay_ticks = 1;
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us));
    if (round == 0) first_hashes = match.server_log.seen.hashes;
    EXPECT_EQ(match.server_log.seen.hashes, first_hashes);
  }
}

}  // namespace
}  // namespace lockstone::net::test
