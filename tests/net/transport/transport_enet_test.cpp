#include <chrono>
#include <thread>

#include <gtest/gtest.h>

#include <lockstone/net/transport_enet.h>

#include "tests/net/match_fixture.h"
#include "tests/net/transport/ipv6_support.h"
#include "tests/support/await.h"

namespace lockstone::net::test {
namespace {

// Since the program's start: the tokens of these tests live for an hour.
std::int64_t clock_us() {
  using Clock = std::chrono::steady_clock;
  static const Clock::time_point start = Clock::now();
  return std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start).count();
}

struct Addresses {
  std::string server = "127.0.0.1";
  std::array<std::string, 2> called = {"127.0.0.1", "127.0.0.1"};  ///< by each player
};

// A server and two clients over UDP on the loopback, polled in turn.
struct LoopbackMatch {
  struct Player {
    std::unique_ptr<EnetTransport> transport;
    std::unique_ptr<SecureTransport> secure;
    std::unique_ptr<ScriptedInputs> inputs;
    std::unique_ptr<ClientLog> log = std::make_unique<ClientLog>();
    std::unique_ptr<Client> client;
  };

  LoopbackMatch(ServerConfig config, const std::vector<Flip>& flips, bool with_tokens = false,
                Addresses where = {})
      : secure(with_tokens), addresses(std::move(where)) {
    EnetOptions options;
    options.bind_address = addresses.server;
    if (secure) options.link_key = make_link_key(backend_key(), k_match);
    if (config.pacing == Pacing::fast) options.limits = DatagramLimits::none();
    server_transport = std::move(EnetTransport::listen(options).value());
    config.insecure = !secure;
    config.match_config = toy.encode();
    ServerParts parts;
    parts.transport = server_transport.get();
    if (secure) {
      server_secure = serve_securely(*server_transport, random);
      parts.transport = server_secure.get();
    }
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
    if (secure) options.link_key = make_link_key(backend_key(), k_match);
    player.transport = std::move(EnetTransport::open(options).value());
    player.inputs = std::make_unique<ScriptedInputs>(1, slot);
    ClientConfig config;
    config.insecure = !secure;
    config.wanted_slot = slot;
    ClientParts parts;
    parts.transport = player.transport.get();
    if (secure) {
      player.secure = join_securely(*player.transport, slot, random);
      parts.transport = player.secure.get();
    }
    parts.connection =
        player.transport->connect(addresses.called[slot], server_transport->port()).value();
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
  bool secure;
  Addresses addresses;
  TestRandom random{3};
  std::unique_ptr<EnetTransport> server_transport;
  std::unique_ptr<SecureTransport> server_secure;
  std::unique_ptr<Server> server;
  std::array<Player, 2> players;
};

TEST(EnetTransport, PlaysAWholeMatchOverTheLoopback) {
  ServerConfig config;
  config.tick_count = 300;
  config.pacing = Pacing::fast;
  LoopbackMatch match(config, {});
  ASSERT_NE(match.server_transport->port(), 0);
  ASSERT_TRUE(match.run(60'000'000));
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

TEST(EnetTransport, PlaysAnEncryptedMatch) {
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  ServerConfig config;
  config.tick_count = 300;
  config.pacing = Pacing::fast;
  LoopbackMatch match(config, {}, true);
  ASSERT_TRUE(match.run(60'000'000));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  for (std::uint8_t slot = 0; slot < 2; ++slot)
    EXPECT_EQ(match.players[slot].log->seen.hashes, match.log.seen.hashes);
  EXPECT_EQ(match.server_secure->counters().packets_forged, 0U);
  EXPECT_EQ(match.server_transport->counters().forged, 0U);
}

// A match of 300 ticks between players who call these addresses.
void expect_equal_match(const Addresses& addresses, bool with_tokens) {
  ServerConfig config;
  config.tick_count = 300;
  config.pacing = Pacing::fast;
  LoopbackMatch match(config, {}, with_tokens, addresses);
  ASSERT_TRUE(match.run(60'000'000));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  for (std::uint8_t slot = 0; slot < 2; ++slot) {
    EXPECT_EQ(match.players[slot].log->seen.hashes, match.log.seen.hashes);
    EXPECT_EQ(match.server->stats(slot).hashes_equal, 300U);
  }
  EXPECT_EQ(match.server_transport->counters().forged, 0U);
  EXPECT_EQ(match.server_transport->counters().strays, 0U);
}

TEST(EnetTransport, PlaysAMatchOverIpv6) {
  LKS_NEEDS_IPV6();
  expect_equal_match({"::1", {"::1", "::1"}}, false);
}

TEST(EnetTransport, PlaysAnEncryptedMatchOverIpv6) {
  LKS_NEEDS_IPV6();
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  expect_equal_match({"::1", {"::1", "::1"}}, true);
}

TEST(EnetTransport, PlayersOverIpv4AndIpv6MeetInOneMatch) {
  LKS_NEEDS_IPV6();
  expect_equal_match({"::", {"127.0.0.1", "::1"}}, security_available());
}

TEST(EnetTransport, CarriesLargePacketsOverIpv6) {
  LKS_NEEDS_IPV6();
  const Flip flip{40, "body", "spin", 5, 9};
  ServerConfig config;
  config.tick_count = 300;
  config.pacing = Pacing::fast;
  LoopbackMatch match(config, {flip}, false, {"::1", {"::1", "::1"}});
  ASSERT_TRUE(match.run(60'000'000));
  ASSERT_EQ(match.log.reports.size(), 1U);
  EXPECT_EQ(match.log.reports[0].difference.field, "spin");
}

// The first event that a client without the right key gets of a server, if any, with 10 ms for each
// round.
TransportEvent first_word(const std::optional<LinkKey>& server_key,
                          const std::optional<LinkKey>& client_key, std::uint32_t server_tag = 0,
                          std::uint32_t client_tag = 0) {
  EnetOptions server_options, client_options;
  server_options.link_key = server_key;
  server_options.match_tag = server_tag;
  client_options.link_key = client_key;
  client_options.match_tag = client_tag;
  const auto server = std::move(EnetTransport::listen(server_options)).value();
  const auto client = std::move(EnetTransport::open(client_options)).value();
  EXPECT_TRUE(client->connect("127.0.0.1", server->port()).ok());
  TransportEvent event;
  // Without an answer, some seconds more after the server has seen the request.
  bool answered = false;
  int rounds = 0;
  std::int64_t now_us = 0;
  lockstone::test::await([&] {
    now_us += 10'000;
    EXPECT_FALSE(server->poll(now_us, event));
    answered = client->poll(now_us, event);
    return answered || (server->counters().forged > 0 && ++rounds > 400);
  });
  if (answered) return event;
  EXPECT_EQ(server->counters().refusals, 0U);
  EXPECT_GT(server->counters().forged, 0U);
  return {};
}

TEST(EnetTransport, TellsAPeerOfTheOtherKind) {
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  const LinkKey key = make_link_key(backend_key(), k_match);
  for (const bool server_open : {false, true}) {
    const auto server_key = server_open ? std::nullopt : std::optional(key);
    const auto client_key = server_open ? std::optional(key) : std::nullopt;
    const TransportEvent event = first_word(server_key, client_key);
    EXPECT_EQ(event.kind, TransportEventKind::disconnected);
    EXPECT_EQ(event.reason, RefuseReason::insecure_not_allowed);
  }
}

TEST(EnetTransport, AnswersNothingToAnotherKey) {
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  const TransportEvent event =
      first_word(make_link_key(backend_key(), k_match), make_link_key(backend_key(), k_match + 1));
  EXPECT_EQ(event.connection, k_no_connection);
}

TEST(EnetTransport, TellsAPeerOfAnotherMatch) {
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  const TransportEvent event =
      first_word(make_link_key(backend_key(), k_match), make_link_key(backend_key(), k_match + 1),
                 make_match_tag(k_match), make_match_tag(k_match + 1));
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  EXPECT_EQ(event.reason, RefuseReason::wrong_match);
}

TEST(EnetTransport, TellsAClientWithATokenWhyThereIsNoConnection) {
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  for (const bool server_open : {false, true}) {
    EnetOptions options;
    if (!server_open) options.link_key = make_link_key(backend_key(), k_match + 1);
    options.match_tag = make_match_tag(k_match + 1);
    const auto server = std::move(EnetTransport::listen(options)).value();
    options.link_key = make_link_key(backend_key(), k_match);
    options.match_tag = make_match_tag(k_match);
    const auto socket = std::move(EnetTransport::open(options)).value();
    TestRandom random(6);
    const auto client = join_securely(*socket, 0, random);
    EXPECT_TRUE(socket->connect("127.0.0.1", server->port()).ok());
    TransportEvent event;
    std::int64_t now_us = 0;
    lockstone::test::await([&] {
      now_us += 10'000;
      static_cast<void>(server->poll(now_us, event));
      return client->poll(now_us, event);
    });
    EXPECT_EQ(event.kind, TransportEventKind::disconnected);
    EXPECT_EQ(event.reason,
              server_open ? RefuseReason::insecure_not_allowed : RefuseReason::wrong_match);
  }
}

TEST(EnetTransport, PlaysInRealTime) {
  ServerConfig config;
  config.tick_count = 60;
  LoopbackMatch match(config, {});
  ASSERT_TRUE(match.run(60'000'000));
  EXPECT_EQ(match.players[0].client->ticks_stepped(), 60U);
  EXPECT_EQ(match.players[0].log->seen.hashes, match.log.seen.hashes);
}

TEST(EnetTransport, CarriesTheDumpOfADesync) {
  const Flip flip{40, "body", "spin", 5, 9};
  ServerConfig config;
  config.tick_count = 300;
  config.pacing = Pacing::fast;
  LoopbackMatch match(config, {flip});
  ASSERT_TRUE(match.run(60'000'000));
  ASSERT_EQ(match.log.reports.size(), 1U);
  EXPECT_EQ(match.log.reports[0].tick, 40U);
  EXPECT_EQ(match.log.reports[0].difference.field, "spin");
  EXPECT_EQ(match.players[1].log->reports.size(), 1U);
}

TEST(EnetTransport, WaitsForADatagram) {
  const auto server = std::move(EnetTransport::listen({})).value();
  EXPECT_FALSE(server->wait(0));
  EXPECT_FALSE(server->wait(1000));
  const auto client = std::move(EnetTransport::open({})).value();
  EXPECT_TRUE(client->connect("127.0.0.1", server->port()).ok());
  TransportEvent event;
  static_cast<void>(client->poll(clock_us(), event));
  EXPECT_TRUE(server->wait(60'000'000));
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
