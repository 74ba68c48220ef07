// Matches in rooms with real sockets and threads: they follow each other, and a drain ends them.
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/await.h"
#include "tools/lockstone/bench/hosting/echo_simulation.h"
#include "tools/lockstone/bench/hosting/hosting_bots.h"
#include "tools/lockstone/match/rooms.h"
#include "tools/toy/toy_simulation.h"

namespace lockstone::tool {
namespace {

constexpr std::uint64_t k_ticks = 20;
constexpr unsigned k_bots = 2;

// The toy, whose servers tell their hashes, and whose matches have a seed of their own each.
Games telling_toy(HashBoards& boards) {
  GameDef game;
  game.name = "toy";
  game.scenes = {{.name = "toy"}};
  game.configure = [](const MatchRequest& request) -> Result<std::vector<std::byte>> {
    toy::ToyConfig config;
    config.seed = request.seed;
    config.player_count = request.players;
    return config.encode();
  };
  game.make = [&boards](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    const Result<toy::ToyConfig> config = toy::ToyConfig::decode(bytes);
    if (!config) return config.status();
    auto real = std::make_unique<toy::ToySimulation>(config.value());
    std::shared_ptr<HashBoard> board = boards.make(bytes, real->info());
    return std::unique_ptr<Simulation>(
        std::make_unique<TellingSimulation>(std::move(real), std::move(board)));
  };
  return Games({std::move(game)});
}

struct Hosted {
  explicit Hosted(std::uint64_t ticks, const RoomsOptions& options) {
    net::SystemRandom random;
    key = net::make_key(random);
    MatchOptions match;
    match.start.players = k_bots;
    match.ticks = ticks;
    match.key = key;
    match.match = 1;
    match.silent = true;
    rooms = Rooms::open(games, match, options);
  }
  void call(std::uint64_t match) {
    teams.push_back(BotTeam::call(rooms->port(), key, match, k_bots, boards));
    ASSERT_NE(teams.back(), nullptr);
  }
  void play() {
    for (const auto& team : teams)
      team->update(watch.microseconds());
  }

  HashBoards boards;
  Games games = telling_toy(boards);
  net::Key key;
  Stopwatch watch;
  std::unique_ptr<Rooms> rooms;
  std::vector<std::unique_ptr<BotTeam>> teams;
};

bool is_open(const RoomsMetrics& metrics, std::uint64_t match) {
  return std::any_of(metrics.matches.begin(), metrics.matches.end(),
                     [match](const MatchMetrics& one) { return one.room == match; });
}

TEST(RoomsThreads, MatchesFollowEachOtherOnOnePort) {
  constexpr std::uint64_t k_matches = 9;
  Hosted hosted(k_ticks,
                {.rooms = 3, .workers = 3, .matches = k_matches, .per_address_unlimited = true});
  ASSERT_NE(hosted.rooms, nullptr);
  std::uint64_t called = 0;
  test::await([&] {
    const RoomsMetrics metrics = hosted.rooms->metrics();
    if (called < k_matches && is_open(metrics, called + 1)) hosted.call(++called);
    hosted.play();
    return hosted.rooms->over();
  });
  EXPECT_EQ(hosted.rooms->finish(), 0);
  const RoomsMetrics metrics = hosted.rooms->metrics();
  EXPECT_EQ(metrics.ended, k_matches);
  EXPECT_EQ(metrics.sum.ticks, k_matches * k_ticks);
  EXPECT_EQ(metrics.sum.desyncs, 0U);
  ASSERT_EQ(metrics.sum.players.size(), 1U);
  EXPECT_EQ(metrics.sum.players[0].hashes_equal, metrics.sum.players[0].hashes_compared);
  EXPECT_GT(metrics.sum.players[0].hashes_compared, 0U);
  EXPECT_EQ(metrics.router.broken, 0U);
  EXPECT_EQ(hosted.rooms->lateness().ticks(), k_matches * k_ticks);
}

TEST(RoomsThreads, ADrainEndsThoseThatWaitAndPlaysTheOthersOn) {
  Hosted hosted(3 * k_ticks, {.rooms = 4, .workers = 2, .per_address_unlimited = true});
  ASSERT_NE(hosted.rooms, nullptr);
  test::await([&] { return hosted.rooms->metrics().matches.size() == 4; });
  hosted.call(2);
  test::await([&] {
    hosted.play();
    return hosted.rooms->metrics().running == 1;
  });
  hosted.rooms->drain();
  EXPECT_FALSE(hosted.rooms->metrics().ready);
  test::await([&] {
    hosted.play();
    return hosted.rooms->over();
  });
  EXPECT_EQ(hosted.rooms->finish(), 0);
  const RoomsMetrics metrics = hosted.rooms->metrics();
  EXPECT_EQ(metrics.ended, 4U);
  EXPECT_EQ(metrics.sum.ticks, 3 * k_ticks);
}

TEST(RoomsThreads, EndWithTheirOwner) {
  const Hosted hosted(0, {.rooms = 2, .workers = 2});
  EXPECT_NE(hosted.rooms, nullptr);
}

}  // namespace
}  // namespace lockstone::tool
