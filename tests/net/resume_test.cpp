// A server that was killed goes on, and its players find it again.
#include <gtest/gtest.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

constexpr std::uint64_t k_ticks = 900;

/// The toy after this many of a server's confirmed ticks.
void step_to(ToySimulation& toy, const Seen& seen, std::size_t ticks, std::size_t input_bytes) {
  for (std::size_t tick = 0; tick < ticks; ++tick) {
    std::vector<PlayerInput> inputs;
    for (std::size_t slot = 0; slot < seen.ticks[tick].origins.size(); ++slot) {
      const ByteView bytes = seen.ticks[tick].bytes;
      inputs.push_back(
          {bytes.subspan(slot * input_bytes, input_bytes), seen.ticks[tick].origins[slot]});
    }
    toy.step(inputs);
  }
}

/// The server dies without a word; another one, which lacks the last `lost` ticks, takes its place.
void replace_server(Match& match, std::size_t lost) {
  match.server.reset();
  Seen& seen = match.server_log.seen;
  const std::size_t ticks = seen.ticks.size() - lost;
  seen.ticks.resize(ticks);
  seen.hashes.resize(ticks);
  match.server_simulation = ToySimulation(match.options.toy);
  step_to(match.server_simulation, seen, ticks, match.options.toy.input_bytes);
  ServerConfig config = match.options.server;
  config.resume_mask = 0b111;
  ServerParts parts;
  parts.transport = match.options.secure ? static_cast<Transport*>(match.server_secure.get())
                                         : &match.server_transport;
  parts.simulation = &match.server_simulation;
  parts.observer = &match.server_log;
  match.server = std::move(Server::create(config, parts).server);
}

void reconnect_lost(Match& match) {
  for (Match::Player& player : match.players) {
    if (!player.client->may_reconnect()) continue;
    EXPECT_TRUE(match.reconnect(player));
  }
}

class Resume : public testing::TestWithParam<std::size_t> {};

// Clients are ahead of the log by the ticks that it lost: they go back, or go on where they are.
TEST_P(Resume, MatchGoesOnFromItsLogAndStaysEqual) {
  for (const bool secure : {false, true}) {
    for (const std::uint8_t prediction : {std::uint8_t{0}, std::uint8_t{6}}) {
      MatchOptions options = match_of(3, k_ticks, 300 + GetParam());
      options.secure = secure;
      options.client.prediction_ticks = prediction;
      Match match(options);
      match.run_for(5 * k_second_us);
      const std::uint64_t closed = match.server->ticks_confirmed();
      replace_server(match, GetParam());
      EXPECT_EQ(match.server->ticks_confirmed(), 0U);  // before the first update
      while (!match.done() && match.now_us < 60 * k_second_us) {
        match.step();
        reconnect_lost(match);
      }
      EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
      EXPECT_EQ(match.server->ticks_confirmed(), k_ticks);
      EXPECT_GT(k_ticks, closed);
      EXPECT_TRUE(match.server_log.reports.empty());
      for (std::uint8_t slot = 0; slot < 3; ++slot) {
        EXPECT_EQ(match.players[slot].client->slot(), slot);
        EXPECT_EQ(match.players[slot].client->ticks_stepped(), k_ticks);
        EXPECT_EQ(match.players[slot].client->stats().malformed_packets, 0U);
        EXPECT_EQ(match.server->stats(slot).malformed_packets, 0U);
      }
    }
  }
}
INSTANTIATE_TEST_SUITE_P(LostTicks, Resume, testing::Values(0, 1, 30, 59, 150));

// Its ticks of the former life are not those that the new server closed meanwhile.
TEST(Resume, PlayerThatComesMuchLaterDoesNotGoOnFromAStateThatNeverWas) {
  MatchOptions options = match_of(3, k_ticks, 320);
  options.secure = true;
  Match match(options);
  match.run_for(5 * k_second_us);
  replace_server(match, 40);
  match.players[2].paused = true;
  while (match.server->ticks_confirmed() < 400 && match.now_us < 60 * k_second_us) {
    match.step();
    reconnect_lost(match);
  }
  match.players[2].paused = false;
  while (!match.done() && match.now_us < 60 * k_second_us) {
    match.step();
    reconnect_lost(match);
  }
  EXPECT_TRUE(match.server_log.reports.empty());
  EXPECT_GE(match.players[2].client->stats().states_loaded, 1U);
  EXPECT_EQ(match.players[2].client->ticks_stepped(), k_ticks);
}

// A match of which nobody comes back ends.
TEST(Resume, WaitsForNobodyForEver) {
  Match match(match_of(3, k_ticks, 321));
  match.run_for(5 * k_second_us);
  replace_server(match, 10);
  match.players.clear();
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::no_players);
}

TEST(Resume, NeedsASimulationThatWasSteppedAndSaysSo) {
  Match match(match_of(2, 100, 322));
  ServerParts parts;
  parts.transport = &match.server_transport;
  parts.simulation = &match.server_simulation;
  ServerConfig config = match.options.server;
  config.resume_mask = 3;
  EXPECT_EQ(Server::create(config, parts).error, SetupError::simulation_already_stepped);
}

// The server's time for a handshake is over: the client may call again, and comes in.
TEST(Reconnect, HandshakeThatTookTooLongIsTriedAgain) {
  MatchOptions options = match_of(2, 200, 330);
  options.server.timeouts.handshake_us = 200'000;
  options.server.start_players = 1;
  Match match(options);
  match.network.partition(*match.players[1].transport, 0, 600'000, Cut::receiving);
  match.run_for(2 * k_second_us);
  Client& late = *match.players[1].client;
  ASSERT_EQ(late.state(), ClientState::refused);
  EXPECT_EQ(late.refusal().reason, RefuseReason::handshake_timeout);
  EXPECT_TRUE(late.may_reconnect());
  ASSERT_TRUE(match.reconnect(match.players[1]));
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(late.state(), ClientState::finished);
  EXPECT_EQ(late.ticks_stepped(), 200U);
}

TEST(Reconnect, IsOfNoUseForWhoWasSentAway) {
  MatchOptions options = match_of(3, 300, 331);
  options.server.desync_policy = DesyncPolicy::kick;
  options.liars = {{simnet::Lie::always, 50}};
  Match match(options);
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.players[0].client->failure(), ClientFailure::dropped);
  EXPECT_FALSE(match.players[0].client->may_reconnect());
}

// The simulation stands ahead of the last confirmed tick when the connection is lost.
TEST(Reconnect, ClientThatPredictsGoesOnFromClosedTicks) {
  MatchOptions options = match_of(2, k_ticks, 332);
  options.client.prediction_ticks = 8;
  Match match(options);
  match.network.partition(*match.players[1].transport, 4 * k_second_us, 10 * k_second_us);
  while (!match.done() && match.now_us < 60 * k_second_us) {
    match.step();
    if (match.now_us > 10 * k_second_us) reconnect_lost(match);
  }
  EXPECT_TRUE(match.server_log.reports.empty());
  EXPECT_EQ(match.players[1].client->ticks_stepped(), k_ticks);
  match.expect_all_equal();
}

}  // namespace
}  // namespace lockstone::net::test
