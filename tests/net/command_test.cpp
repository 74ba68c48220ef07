// Commands of players and of the server, over a bad network, to everybody.
#include <gtest/gtest.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

std::vector<std::byte> random_bytes(Random& random, std::size_t size) {
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes)
    byte = static_cast<std::byte>(random.below(256));
  return bytes;
}

MatchOptions talkative_match(std::uint64_t seed) {
  MatchOptions options = match_of(3, 600, seed);
  options.faults = rough(150'000);
  options.server.input_delay_ticks = 6;
  options.server.commands = {.per_second = 0, .bytes_per_second = 0};
  return options;
}

// Everybody talks, now and then at length.
std::size_t talk(Match& match, Random& random, std::int64_t span_us) {
  std::size_t given = 0;
  for (const std::int64_t end_us = match.now_us + span_us; match.now_us < end_us; match.step()) {
    const std::size_t speaker = random.below(200);
    const std::size_t size =
        random.below(20) == 0 ? 1 + random.below(40'000) : 1 + random.below(80);
    const std::vector<std::byte> bytes = random_bytes(random, size);
    if (speaker < match.players.size()) {
      given += match.players[speaker].client->send_command(bytes).ok() ? 1U : 0U;
    } else if (speaker == match.players.size()) {
      given += match.server->send_command(bytes) == Status::ok ? 1U : 0U;
    }
  }
  return given;
}

TEST(Commands, ActAtTheSameTickEverywhereThroughLoss) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    MatchOptions options = talkative_match(seed);
    options.authoritative = seed % 3 != 0;
    options.client.prediction_ticks = seed % 2 == 0 ? 6 : 0;
    options.secure = seed == 5;
    Match match(options);
    Random random(seed);
    match.run_for(k_second_us / 2);
    const std::size_t given = talk(match, random, 6 * k_second_us);
    ASSERT_TRUE(match.run(60 * k_second_us)) << "seed " << seed;
    EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
    EXPECT_TRUE(match.server_log.reports.empty());
    EXPECT_GT(given, 15U);
    EXPECT_EQ(match.server_log.seen.command_count(), given);
    for (const Match::Player& player : match.players) {
      EXPECT_EQ(player.client->ticks_stepped(), 600U);
      EXPECT_EQ(player.client->stats().malformed_packets, 0U);
    }
    match.expect_all_equal();
  }
}

TEST(Commands, OfOnePlayerKeepTheirOrderAndBytes) {
  Match match(talkative_match(9));
  match.run_for(k_second_us);
  Random random(1);
  std::vector<std::vector<std::byte>> given;
  for (std::size_t size : {1U, 8192U, 8193U, 40'000U, 3U}) {
    given.push_back(random_bytes(random, size));
    const Result<std::uint64_t> number = match.players[1].client->send_command(given.back());
    ASSERT_TRUE(number.ok());
    EXPECT_EQ(number.value(), given.size() - 1);
  }
  ASSERT_TRUE(match.run(60 * k_second_us));
  std::vector<std::vector<std::byte>> seen;
  for (const SeenTick& tick : match.players[2].log->seen.ticks) {
    for (const SeenCommand& command : tick.commands)
      seen.push_back(command.bytes);
  }
  EXPECT_EQ(seen, given);
  EXPECT_EQ(match.server->stats(1).commands_taken, 5U);
  match.expect_all_equal();
}

TEST(Commands, OfTheLongestSizeArriveAndLongerOnesDoNot) {
  Match match(talkative_match(10));
  match.run_for(k_second_us);
  Random random(1);
  Client& client = *match.players[0].client;
  const std::vector<std::byte> longest = random_bytes(random, k_max_command_bytes);
  EXPECT_TRUE(client.send_command(longest).ok());
  EXPECT_EQ(client.send_command(random_bytes(random, k_max_command_bytes + 1)).status(),
            Status::invalid_argument);
  EXPECT_EQ(client.send_command({}).status(), Status::invalid_argument);
  EXPECT_TRUE(client.send_command(longest).ok());
  EXPECT_EQ(client.send_command(longest).status(), Status::capacity_exhausted);
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server_log.seen.command_count(), 2U);
  match.expect_all_equal();
}

TEST(Commands, BeyondTheLimitsAreRefusedAndCounted) {
  MatchOptions options = talkative_match(11);
  options.server.commands = {.max_bytes = 1000, .per_second = 5, .bytes_per_second = 0};
  Match match(options);
  match.run_for(k_second_us);
  Random random(1);
  Client& client = *match.players[0].client;
  ASSERT_TRUE(client.send_command(random_bytes(random, 20'000)).ok());  // too long, in pieces
  for (int i = 0; i < 40; ++i)
    ASSERT_TRUE(client.send_command(random_bytes(random, 10)).ok());
  match.run_for(2 * k_second_us);
  const PlayerStats stats = match.server->stats(0);
  EXPECT_EQ(stats.commands_taken + stats.commands_refused, 41U);
  EXPECT_GE(stats.commands_taken, 10U);
  EXPECT_LE(stats.commands_taken, 15U);
  ASSERT_EQ(match.players[0].log->refused.size(), stats.commands_refused);
  EXPECT_EQ(match.players[0].log->refused[0], 0U);
  EXPECT_TRUE(client.send_command(random_bytes(random, 10)).ok());
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->stats(0).malformed_packets, 0U);
  EXPECT_EQ(match.server->stats(0).commands_taken, stats.commands_taken + 1);
  EXPECT_EQ(match.server_log.seen.command_count(), match.server->stats(0).commands_taken);
  match.expect_all_equal();
}

TEST(Commands, AreNotTakenWhereTheMatchHasNone) {
  MatchOptions options = talkative_match(12);
  options.server.commands.max_bytes = 0;
  Match match(options);
  match.run_for(k_second_us);
  Random random(1);
  ASSERT_TRUE(match.players[0].client->send_command(random_bytes(random, 10)).ok());
  EXPECT_EQ(match.server->send_command(random_bytes(random, 10)), Status::ok);
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->stats(0).commands_refused, 1U);
  EXPECT_EQ(match.server_log.seen.command_count(), 1U);  // the server's own
  match.expect_all_equal();
}

TEST(Commands, FloodOfLongOnesWaitsForRoomAndHarmsNobody) {
  MatchOptions options = talkative_match(13);
  options.server.tick_count = 900;
  options.faults = {};
  Match match(options);
  Random random(1);
  const std::vector<std::byte> longest = random_bytes(random, k_max_command_bytes);
  for (; match.now_us < 10 * k_second_us; match.step())
    static_cast<void>(match.players[0].client->send_command(longest));
  ASSERT_TRUE(match.run(60 * k_second_us));
  const PlayerStats stats = match.server->stats(0);
  EXPECT_GT(stats.commands_taken, 60U);  // more than the ring holds would be 64
  EXPECT_GT(stats.commands_refused, 0U);
  EXPECT_EQ(match.server->ticks_confirmed(), 900U);
  EXPECT_EQ(match.server->stats(1).late_inputs, 0U);
  match.expect_all_equal();
}

TEST(Commands, ReachSpectatorsLatecomersAndThoseWhoComeBack) {
  for (const bool authoritative : {true, false}) {
    MatchOptions options = talkative_match(14);
    options.authoritative = authoritative;
    options.server.tick_count = 1500;
    options.server.max_spectators = 2;
    options.server.spectator_delay_ticks = authoritative ? 60 : 0;
    options.server.spectator_queue_ticks = 300;
    options.server.start_players = 2;
    Match match(options);
    Random random(7);
    match.players[2].paused = true;
    match.run_for(k_second_us);
    match.add_player(k_spectator_slot);
    talk(match, random, 2 * k_second_us);
    match.players[2].paused = false;
    match.add_player(k_spectator_slot);
    talk(match, random, 4 * k_second_us);
    match.network.partition(*match.players[1].transport, match.now_us,
                            match.now_us + 8 * k_second_us);
    talk(match, random, 8 * k_second_us);
    ASSERT_EQ(match.players[1].client->failure(), ClientFailure::server_silent);
    ASSERT_TRUE(match.reconnect(match.players[1]));
    talk(match, random, 4 * k_second_us);
    ASSERT_TRUE(match.run(60 * k_second_us));
    for (const Match::Player& player : match.players) {
      EXPECT_EQ(player.client->ticks_stepped(), 1500U);
      EXPECT_EQ(player.client->stats().malformed_packets, 0U);
      EXPECT_GT(player.log->seen.command_count(), 10U);
    }
    match.expect_all_equal();
  }
}

TEST(Commands, GivenWhileTheConnectionIsDownAreSentAgain) {
  MatchOptions options = talkative_match(15);
  options.faults = {};
  options.server.tick_count = 1200;
  Match match(options);
  match.run_for(k_second_us);
  Random random(1);
  Client& client = *match.players[1].client;
  match.network.partition(*match.players[1].transport, match.now_us,
                          match.now_us + 7 * k_second_us);
  ASSERT_TRUE(client.send_command(random_bytes(random, 20'000)).ok());
  ASSERT_TRUE(client.send_command(random_bytes(random, 5)).ok());
  match.run_for(7 * k_second_us);
  ASSERT_EQ(client.failure(), ClientFailure::server_silent);
  EXPECT_EQ(client.send_command(random_bytes(random, 5)).status(), Status::not_found);
  ASSERT_TRUE(match.reconnect(match.players[1]));
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->stats(1).commands_taken, 2U);
  EXPECT_EQ(match.server_log.seen.command_count(), 2U);
  match.expect_all_equal();
}

TEST(Commands, PassTheTestOfPrediction) {
  MatchOptions options = talkative_match(16);
  options.client.prediction_ticks = 5;
  options.client.sync_test = true;
  Match match(options);
  Random random(5);
  match.run_for(k_second_us);
  talk(match, random, 6 * k_second_us);
  ASSERT_TRUE(match.run(60 * k_second_us));
  for (const Match::Player& player : match.players) {
    EXPECT_EQ(player.client->state(), ClientState::finished);
    EXPECT_GT(player.log->seen.command_count(), 10U);
  }
  match.expect_all_equal();
}

TEST(Commands, ThatBreakTheFormatHaveNoEffect) {
  Match match(talkative_match(17));
  match.run_for(k_second_us);
  std::array<std::byte, 64> room{};
  const std::array<std::byte, 4> chunk{};
  const auto send = [&](const CommandPiece& piece) {
    const ByteView bytes = ByteView(room).first(encode(piece, room));
    // The only connection of the client's end is its first.
    EXPECT_EQ(match.players[0].transport->send(1, Channel::reliable, bytes), Status::ok);
  };
  send({100, 8, chunk});  // does not begin at the beginning
  match.run_for(k_second_us);
  EXPECT_EQ(match.server->stats(0).malformed_packets, 1U);
  send({8, 0, chunk});
  send({9, 4, chunk});  // another length
  match.run_for(k_second_us);
  EXPECT_EQ(match.server->stats(0).malformed_packets, 2U);
  EXPECT_EQ(match.server->stats(0).commands_taken, 0U);
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server_log.seen.command_count(), 0U);
  match.expect_all_equal();
}

}  // namespace
}  // namespace lockstone::net::test
