#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include <lockstone/net/transport_enet.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

std::int64_t clock_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

// A server and two clients over UDP on the loopback, polled in turn.
struct LoopbackMatch {
  struct Player {
    std::unique_ptr<EnetTransport> transport;
    std::unique_ptr<ScriptedInputs> inputs;
    std::unique_ptr<ClientLog> log = std::make_unique<ClientLog>();
    std::unique_ptr<Client> client;
  };

  LoopbackMatch(ServerConfig config, const std::vector<Flip>& flips) {
    server_transport = std::move(EnetTransport::listen({}).value());
    config.insecure = true;
    config.match_config = toy.encode();
    ServerParts parts;
    parts.transport = server_transport.get();
    parts.simulation = &simulation;
    parts.observer = &log;
    server = std::move(Server::create(config, parts).server);
    for (std::uint8_t slot = 0; slot < 2; ++slot)
      add_player(slot, slot == 1 ? flips : noflips);
  }

  void add_player(std::uint8_t slot, const std::vector<Flip>& flips) {
    Player& player = players[slot];
    EnetOptions options;
    options.max_connections = 1;
    player.transport = std::move(EnetTransport::open(options).value());
    player.inputs = std::make_unique<ScriptedInputs>(1, slot);
    ClientConfig config;
    config.insecure = true;
    config.wanted_slot = slot;
    ClientParts parts;
    parts.transport = player.transport.get();
    parts.connection = player.transport->connect("127.0.0.1", server_transport->port()).value();
    parts.factory = [flips](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
      return std::unique_ptr<Simulation>(
          std::make_unique<FaultySimulation>(ToyConfig::decode(bytes).value(), flips));
    };
    parts.inputs = player.inputs.get();
    parts.observer = player.log.get();
    player.client = std::move(Client::create(config, std::move(parts)).client);
  }

  bool run(std::int64_t limit_us) {
    for (const std::int64_t end_us = clock_us() + limit_us; clock_us() < end_us;) {
      server->update(clock_us());
      for (Player& player : players)
        player.client->update(clock_us());
      if (server->state() == ServerState::over) return true;
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    return false;
  }

  ToyConfig toy;
  std::vector<Flip> noflips;
  ToySimulation simulation{toy};
  ServerLog log;
  std::unique_ptr<EnetTransport> server_transport;
  std::unique_ptr<Server> server;
  std::array<Player, 2> players;
};

TEST(EnetTransport, PlaysAWholeMatchOverTheLoopback) {
  ServerConfig config;
  config.tick_count = 300;
  config.pacing = Pacing::fast;
  LoopbackMatch match(config, {});
  ASSERT_NE(match.server_transport->port(), 0);
  ASSERT_TRUE(match.run(15'000'000));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  for (std::uint8_t slot = 0; slot < 2; ++slot) {
    EXPECT_EQ(match.players[slot].client->state(), ClientState::finished);
    EXPECT_EQ(match.players[slot].log->seen.hashes, match.log.seen.hashes);
    const PlayerStats stats = match.server->stats(slot);
    EXPECT_EQ(stats.hashes_equal, 300U);
    EXPECT_GT(stats.bytes_sent, 0U);
    EXPECT_GE(stats.round_trip_us, 0);
  }
}

TEST(EnetTransport, PlaysInRealTime) {
  ServerConfig config;
  config.tick_count = 60;
  LoopbackMatch match(config, {});
  ASSERT_TRUE(match.run(15'000'000));
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 60U);
  EXPECT_EQ(match.players[0].log->seen.hashes, match.log.seen.hashes);
}

TEST(EnetTransport, CarriesTheDumpOfADesync) {
  const Flip flip{40, "body", "spin", 5, 9};
  ServerConfig config;
  config.tick_count = 300;
  config.pacing = Pacing::fast;
  LoopbackMatch match(config, {flip});
  ASSERT_TRUE(match.run(15'000'000));
  ASSERT_EQ(match.log.reports.size(), 1U);
  EXPECT_EQ(match.log.reports[0].tick, 40U);
  EXPECT_EQ(match.log.reports[0].difference.field, "spin");
  EXPECT_EQ(match.players[1].log->reports.size(), 1U);
}

TEST(EnetTransport, SaysWhyItCannotBind) {
  const auto first = EnetTransport::listen({});
  ASSERT_TRUE(first.ok());
  EnetOptions options;
  options.bind_address = "not an address";
  EXPECT_EQ(EnetTransport::listen(options).status(), Status::invalid_argument);
  options.bind_address = "127.0.0.1";
  options.max_connections = 0;
  EXPECT_EQ(EnetTransport::listen(options).status(), Status::invalid_argument);
}

}  // namespace
}  // namespace lockstone::net::test
