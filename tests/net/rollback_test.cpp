#include <set>

#include <gtest/gtest.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

MatchOptions predicting_match(std::uint64_t seed) {
  MatchOptions options;
  options.toy.player_count = 3;
  options.toy.seed = seed;
  options.server.tick_count = 400;
  options.server.input_delay_ticks = 2;
  options.client.prediction_ticks = 8;
  options.seed = seed;
  return options;
}

TEST(Rollback, GivesTheSameConfirmedTicksAsLockstep) {
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    MatchOptions options = predicting_match(seed);
    options.faults = rough(static_cast<std::uint32_t>(20'000 * seed));
    options.server.late_policy = seed % 3 == 0 ? LatePolicy::strict : LatePolicy::deadline;
    options.authoritative = seed % 4 != 0;
    Match match(options);
    ASSERT_TRUE(match.run(60 * k_second_us)) << "seed " << seed;
    EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
    for (const Match::Player& player : match.players) {
      EXPECT_EQ(player.client->ticks_stepped(), 400U);
      EXPECT_GT(player.client->stats().rollbacks, 10U);
      EXPECT_LE(player.log->longest_rollback, 8U);
    }
    match.expect_all_equal();
  }
}

TEST(Rollback, RunsAheadByNoMoreThanItMay) {
  MatchOptions options = predicting_match(20);
  options.faults.delay_us = 100'000;
  options.client.prediction_ticks = 5;
  Match match(options);
  std::uint64_t most = 0;
  while (!match.done() && match.now_us < 30 * k_second_us) {
    match.step();
    const Client& client = *match.players[0].client;
    most = std::max(most, client.ticks_predicted() - client.ticks_stepped());
  }
  EXPECT_EQ(most, 5U);
  match.expect_all_equal();
}

// A second client in the place of player 1, 50 ms away.
std::unique_ptr<Client> far_client(Match& match, const MatchOptions& options,
                                   SimulationFactory factory, InputPredictor* predictor) {
  SimTransport& transport = match.network.add_endpoint();
  ClientConfig config = options.client;
  config.insecure = true;
  ClientParts parts;
  parts.transport = &transport;
  parts.connection = match.network.connect(transport, match.server_transport, {.delay_us = 50'000});
  parts.factory = std::move(factory);
  parts.inputs = match.players[1].inputs.get();
  parts.predictor = predictor;
  return std::move(Client::create(config, std::move(parts)).client);
}

TEST(Rollback, AsksThePredictorForOthersAlone) {
  class Zeros final : public InputPredictor {
   public:
    void predict(std::uint64_t, std::uint8_t slot, std::span<std::byte> out) override {
      ++asked[slot];
      std::fill(out.begin(), out.end(), std::byte{0});
    }
    std::array<int, 2> asked{};
  };
  Zeros zeros;
  MatchOptions options = predicting_match(21);
  options.toy.player_count = 2;
  options.server.start_players = 1;
  Match match(options);
  match.players[1].paused = true;
  const auto client = far_client(match, options, toy::toy_factory(), &zeros);
  for (int i = 0; i < 500; ++i) {
    client->update(match.now_us);
    match.step();
  }
  EXPECT_GT(zeros.asked[0], 100);
  EXPECT_EQ(zeros.asked[1], 0);
}

// A toy with three islands in each step, of which it remembers two.
class CountingToy final : public toy::ToySimulation {
 public:
  using ToySimulation::ToySimulation;
  [[nodiscard]] IslandWork island_work() const override { return {1, 2}; }
};

TEST(Rollback, CountsTheIslandsOfTicksThatAreSteppedAgain) {
  MatchOptions options = predicting_match(25);
  options.toy.player_count = 2;
  options.server.start_players = 1;
  Match match(options);
  match.players[1].paused = true;
  const auto client = far_client(match, options, toy::toy_factory<CountingToy>(), nullptr);
  for (int i = 0; i < 1000; ++i) {
    client->update(match.now_us);
    match.step();
  }
  const ClientStats stats = client->stats();
  EXPECT_GT(stats.rollbacks, 10U);
  EXPECT_GT(client->ticks_stepped(), stats.islands_computed_again / 8);
  // All but the last rollback's ticks were stepped again, and no tick that was new.
  EXPECT_LE(stats.islands_computed_again, stats.ticks_stepped_again);
  EXPECT_GE(stats.islands_computed_again + options.client.prediction_ticks,
            stats.ticks_stepped_again);
  EXPECT_EQ(stats.islands_recalled, 2 * stats.islands_computed_again);
}

TEST(Rollback, LocatesAFlippedBit) {
  const Flip flip{150, "body", "velocity.x", 12, 7};
  MatchOptions options = predicting_match(22);
  options.faults = rough(100'000);
  options.flips = {{}, {flip}};
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  ASSERT_EQ(match.server_log.reports.size(), 1U);
  const DesyncReport& report = match.server_log.reports[0];
  EXPECT_EQ(report.tick, 150U);
  EXPECT_EQ(report.slot, 1);
  EXPECT_EQ(report.difference.object, 12U);
  EXPECT_EQ(report.difference.field, "velocity.x");
}

ClientFailure failure_of_sync_test(bool forgets) {
  MatchOptions options = predicting_match(23);
  options.server.start_players = 1;
  Match match(options);
  for (Match::Player& player : match.players)
    player.paused = true;
  SimTransport& transport = match.network.add_endpoint();
  ClientConfig config = options.client;
  config.insecure = true;
  config.sync_test = true;
  ClientParts parts;
  parts.transport = &transport;
  parts.connection = match.network.connect(transport, match.server_transport, {});
  parts.factory = forgets ? toy::toy_factory<toy::ForgetfulToy>() : toy::toy_factory();
  parts.inputs = match.players[1].inputs.get();
  const auto client = std::move(Client::create(config, std::move(parts)).client);
  for (int i = 0; i < 1000; ++i) {
    client->update(match.now_us);
    match.step();
  }
  EXPECT_GT(match.server->ticks_confirmed(), 0U);
  return client->failure();
}

TEST(Rollback, SyncTestFindsAFieldThatASnapshotForgets) {
  EXPECT_EQ(failure_of_sync_test(true), ClientFailure::not_deterministic);
  EXPECT_EQ(failure_of_sync_test(false), ClientFailure::none);
}

// A toy that repeats ticks from memory. Where it is `faulty`, a remembered tick is wrong.
class RememberingToy final : public toy::ToySimulation {
 public:
  RememberingToy(const toy::ToyConfig& config, bool faulty)
      : ToySimulation(config), faulty_(faulty) {}

  void keep_history(std::uint32_t ticks) override { kept_ = ticks; }
  void forget_history() override {
    known_.clear();
    ++forgotten;
  }
  void step(std::span<const PlayerInput> inputs) override {
    const bool is_known = kept_ != 0 && !known_.insert(tick()).second;
    ToySimulation::step(inputs);
    if (is_known && faulty_) ToySimulation::step(inputs);
  }
  [[nodiscard]] std::uint32_t kept() const { return kept_; }

  int forgotten = 0;

 private:
  bool faulty_;
  std::uint32_t kept_ = 0;
  std::set<std::uint64_t> known_;
};

// A client beside a match that plays alone, with `keep_history` as given.
ClientFailure failure_of_history(bool keeps, bool faulty) {
  MatchOptions options = predicting_match(24);
  options.server.start_players = 1;
  Match match(options);
  for (Match::Player& player : match.players)
    player.paused = true;
  SimTransport& transport = match.network.add_endpoint();
  ClientConfig config = options.client;
  config.insecure = true;
  config.sync_test = true;
  config.keep_history = keeps;
  const RememberingToy* game = nullptr;
  ClientParts parts;
  parts.transport = &transport;
  parts.connection = match.network.connect(transport, match.server_transport, {});
  parts.factory = [&](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
    const Result<toy::ToyConfig> read = toy::ToyConfig::decode(bytes);
    if (!read.ok()) return read.status();
    auto made = std::make_unique<RememberingToy>(read.value(), faulty);
    game = made.get();
    return std::unique_ptr<Simulation>(std::move(made));
  };
  parts.inputs = match.players[1].inputs.get();
  const auto client = std::move(Client::create(config, std::move(parts)).client);
  for (int i = 0; i < 500; ++i) {
    client->update(match.now_us);
    match.step();
  }
  EXPECT_EQ(game->kept(), keeps ? 10U : 0U);
  EXPECT_GT(game->forgotten, 0);
  return client->failure();
}

TEST(Rollback, SyncTestComparesAHistoryWithAFullSimulation) {
  EXPECT_EQ(failure_of_history(true, false), ClientFailure::none);
  EXPECT_EQ(failure_of_history(true, true), ClientFailure::not_deterministic);
  EXPECT_EQ(failure_of_history(false, true), ClientFailure::none);
}

}  // namespace
}  // namespace lockstone::net::test
