#include <gtest/gtest.h>

#include <lockstone/net/wire.h>

#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

constexpr ConnectionId k_first = 1;  // of an endpoint that has one connection

MatchOptions secure_match() {
  MatchOptions options;
  options.secure = true;
  options.server.tick_count = 300;
  return options;
}

TEST(SecureTransport, PlaysAWholeMatch) {
  Match match(secure_match());
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_EQ(match.server_secure->counters().handshakes_completed, match.players.size());
  EXPECT_EQ(match.server_secure->counters().packets_forged, 0U);
  match.expect_all_equal();
}

TEST(SecureTransport, DamagedAndDoubledPacketsChangeNothing) {
  MatchOptions options = secure_match();
  options.faults = rough(30'000);
  options.faults.corrupt_ppm = 50'000;
  options.faults.truncate_ppm = 50'000;
  Match match(options);
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_EQ(match.server->finish_reason(), FinishReason::completed);
  EXPECT_GT(match.server_secure->counters().packets_forged, 50U);
  EXPECT_GT(match.server_secure->counters().packets_replayed, 10U);
  for (std::uint8_t slot = 0; slot < match.players.size(); ++slot)
    EXPECT_EQ(match.server->stats(slot).malformed_packets, 0U);
  match.expect_all_equal();
}

// One server and one client over a network without faults.
struct Pair {
  Pair() : server_end(network.add_endpoint()), client_end(network.add_endpoint()) {
    network.connect(client_end, server_end, {});
  }

  // The first event of the client's connection, over `client`.
  TransportEvent first_event(Transport& client, SecureTransport& server) {
    TransportEvent event;
    for (int i = 0; i < 20; ++i) {
      now_us += 1000;
      for (TransportEvent ignored; server.poll(now_us, ignored);)
        server_events.push_back(ignored);
      if (client.poll(now_us, event)) return event;
    }
    ADD_FAILURE() << "nothing happened";
    return event;
  }

  // The answer of a server with these options to this token.
  RefuseReason answer_to(const ConnectToken& token, const SecureServerOptions& options) {
    const auto server = SecureTransport::serve(server_end, options, random);
    const auto client = SecureTransport::join(client_end, token, random);
    const TransportEvent event = first_event(*client.value(), *server.value());
    if (event.kind == TransportEventKind::connected) return RefuseReason::none;
    EXPECT_EQ(event.kind, TransportEventKind::disconnected);
    EXPECT_TRUE(server_events.empty());
    EXPECT_EQ(server.value()->counters().handshakes_refused, 1U);
    return event.reason;
  }

  SimNetwork network{1};
  SimTransport& server_end;
  SimTransport& client_end;
  TestRandom random{4};
  std::int64_t now_us = 0;
  std::vector<TransportEvent> server_events;
};

// A server and a token of its backend, which each test spoils in one way.
class TokenAnswer : public testing::Test {
 protected:
  [[nodiscard]] RefuseReason answer() { return Pair().answer_to(token, server); }

  TestRandom random{8};
  ConnectToken token = token_for(0, random);
  SecureServerOptions server = server_options();
};

TEST_F(TokenAnswer, ToAGoodTokenIsNone) {
  EXPECT_EQ(answer(), RefuseReason::none);
}

TEST_F(TokenAnswer, ToAnAlteredTokenIsRefusal) {
  token.sealed[40] ^= std::byte{1};
  EXPECT_EQ(answer(), RefuseReason::token_refused);
}

TEST_F(TokenAnswer, OfAServerWithAnotherBackendKeyIsRefusal) {
  server.backend_key.bytes[0] ^= std::byte{1};
  EXPECT_EQ(answer(), RefuseReason::token_refused);
}

TEST_F(TokenAnswer, OfAnotherMatchNamesTheMatch) {
  ++server.match;
  EXPECT_EQ(answer(), RefuseReason::wrong_match);
}

TEST_F(TokenAnswer, AnHourLaterIsExpiry) {
  server.unix_us_at_zero += 3600 * k_second_us;
  EXPECT_EQ(answer(), RefuseReason::token_expired);
}

TEST_F(TokenAnswer, ToAClientThatWritesItselfMoreTimeIsRefusal) {
  token.grant.expires_unix_s += 3600;
  EXPECT_EQ(answer(), RefuseReason::token_refused);
}

TEST_F(TokenAnswer, DependsOnTheServersThatTheTokenNames) {
  TokenGrant grant = grant_for(0);
  ASSERT_TRUE(grant.servers.add(ServerAddress::from_text("10.0.0.1:7").value()));
  token = issue_token(backend_key(), grant, random).value();
  ASSERT_TRUE(server.own_addresses.add(ServerAddress::from_text("10.0.0.1:8").value()));
  EXPECT_EQ(answer(), RefuseReason::wrong_server);
  ASSERT_TRUE(server.own_addresses.add(grant.servers.entries[0]));
  EXPECT_EQ(answer(), RefuseReason::none);
}

TEST(SecureTransport, AStolenSealWithoutItsKeysDoesNotConnect) {
  Pair pair;
  const auto server = serve_securely(pair.server_end, pair.random);
  ConnectToken stolen = token_for(0, pair.random);
  stolen.client_key = make_key(pair.random);
  stolen.server_key = make_key(pair.random);
  const auto thief = SecureTransport::join(pair.client_end, stolen, pair.random);
  const TransportEvent event = pair.first_event(*thief.value(), *server);
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  EXPECT_TRUE(pair.server_events.empty());
}

TEST(SecureTransport, ARepeatedHandshakeDoesNotConnect) {
  Pair pair;
  const auto server = serve_securely(pair.server_end, pair.random);
  TapTransport tap(pair.client_end);
  const auto client = join_securely(tap, 0, pair.random);
  ASSERT_EQ(pair.first_event(*client, *server).kind, TransportEventKind::connected);
  ASSERT_EQ(tap.sent.size(), 2U);

  SimTransport& listener = pair.network.add_endpoint();
  pair.network.connect(listener, pair.server_end, {});
  TransportEvent event;
  ASSERT_TRUE(listener.poll(++pair.now_us, event));
  for (const TapTransport::Sent& packet : tap.sent)
    ASSERT_EQ(listener.send(k_first, Channel::reliable, packet.bytes), Status::ok);
  pair.server_events.clear();
  for (; server->poll(++pair.now_us, event);)
    pair.server_events.push_back(event);
  ASSERT_EQ(pair.server_events.size(), 1U);  // of the honest client
  EXPECT_EQ(pair.server_events[0].connection, k_first);
  EXPECT_EQ(server->counters().handshakes_refused, 1U);
}

TEST(SecureTransport, ANewerConnectionOfTheSamePlayerHasOtherKeysAndTakesOver) {
  Pair pair;
  SimTransport& second_end = pair.network.add_endpoint();
  pair.network.connect(second_end, pair.server_end, {});
  const auto server = serve_securely(pair.server_end, pair.random);
  const ConnectToken token = token_for(3, pair.random);
  TapTransport first_tap(pair.client_end), second_tap(second_end);
  const auto first = SecureTransport::join(first_tap, token, pair.random);
  const auto second = SecureTransport::join(second_tap, token, pair.random);
  const std::array<std::byte, 9> word{};

  ASSERT_EQ(pair.first_event(*first.value(), *server).kind, TransportEventKind::connected);
  ASSERT_EQ(first.value()->send(k_first, Channel::unreliable, word), Status::ok);
  ASSERT_EQ(pair.first_event(*second.value(), *server).kind, TransportEventKind::connected);
  ASSERT_EQ(second.value()->send(k_first, Channel::unreliable, word), Status::ok);
  EXPECT_NE(first_tap.sent.back().bytes, second_tap.sent.back().bytes);

  pair.server_events.clear();
  EXPECT_EQ(pair.first_event(*first.value(), *server).kind, TransportEventKind::disconnected);
  ASSERT_EQ(pair.server_events.size(), 3U);
  EXPECT_EQ(pair.server_events[0].reason, RefuseReason::replaced);
  EXPECT_EQ(pair.server_events[0].connection, 1U);
  EXPECT_EQ(pair.server_events[1].kind, TransportEventKind::connected);
  EXPECT_EQ(pair.server_events[2].connection, 2U);
  EXPECT_EQ(server->identity(2).player, 103U);
  EXPECT_EQ(server->identity(2).slot, 3U);
  EXPECT_FALSE(server->identity(1).authenticated);
  EXPECT_EQ(server->send(1, Channel::reliable, word), Status::stale_handle);
}

// Shows its token and never proves that it has the keys.
class HalfWay final : public Transport {
 public:
  explicit HalfWay(Transport& carrier) : carrier_(carrier) {}
  bool poll(std::int64_t now_us, TransportEvent& event) override {
    return carrier_.poll(now_us, event);
  }
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override {
    return sent_++ > 0 ? Status::ok : carrier_.send(connection, channel, bytes);
  }
  void flush() override { carrier_.flush(); }
  void disconnect(ConnectionId connection) override { carrier_.disconnect(connection); }
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override {
    return carrier_.stats(connection);
  }

 private:
  Transport& carrier_;
  unsigned sent_ = 0;
};

TEST(SecureTransport, HandshakesWithOneTokenHoldOnePlace) {
  SimNetwork network(1);
  TestRandom random(4);
  SimTransport& server_end = network.add_endpoint();
  SecureServerOptions options = server_options();
  options.max_connections = 4;
  const auto server = SecureTransport::serve(server_end, options, random);
  const ConnectToken token = token_for(3, random);
  std::int64_t now_us = 0;
  TransportEvent event;
  for (int i = 0; i < 12; ++i) {
    SimTransport& end = network.add_endpoint();
    network.connect(end, server_end, {});
    HalfWay carrier(end);
    const auto client = SecureTransport::join(carrier, token, random);
    for (int round = 0; round < 5; ++round) {
      static_cast<void>(client.value()->poll(++now_us, event));
      EXPECT_FALSE(server.value()->poll(++now_us, event));
    }
  }
  EXPECT_EQ(server.value()->counters().handshakes_replaced, 11U);
  // Everybody else comes in beside it.
  for (std::size_t slot = 0; slot < 3; ++slot) {
    SimTransport& end = network.add_endpoint();
    network.connect(end, server_end, {});
    const auto client = join_securely(end, slot, random);
    unsigned connected = 0;
    for (int round = 0; round < 5; ++round) {
      static_cast<void>(client->poll(++now_us, event));
      while (server.value()->poll(++now_us, event))
        connected += event.kind == TransportEventKind::connected ? 1U : 0U;
    }
    EXPECT_EQ(connected, 1U) << slot;
  }
}

TEST(SecureTransport, APlayerWhoConnectsAgainAndAgainComesInOnceASecond) {
  SimNetwork network(1);
  TestRandom random(4);
  SimTransport& server_end = network.add_endpoint();
  const auto server = serve_securely(server_end, random);
  const ConnectToken token = token_for(3, random);
  std::int64_t now_us = 0;
  const auto entries_of = [&](const ConnectToken& shown, int calls) {
    unsigned entries = 0;
    for (int i = 0; i < calls; ++i) {
      SimTransport& end = network.add_endpoint();
      network.connect(end, server_end, {});
      const auto client = SecureTransport::join(end, shown, random);
      TransportEvent event;
      for (int round = 0; round < 5; ++round) {
        static_cast<void>(client.value()->poll(++now_us, event));
        while (server->poll(++now_us, event))
          entries += event.kind == TransportEventKind::connected ? 1U : 0U;
      }
    }
    return entries;
  };
  EXPECT_EQ(entries_of(token, 50), 10U);
  EXPECT_EQ(server->counters().handshakes_limited, 40U);
  EXPECT_EQ(entries_of(token_for(2, random), 5), 5U);  // another player's
  now_us += 3 * k_second_us;
  EXPECT_EQ(entries_of(token, 50), 3U);
}

TEST(SecureTransport, CarriesTheLongestPacketsOfASessionAndNoLonger) {
  Pair pair;
  const auto server = serve_securely(pair.server_end, pair.random);
  const auto client = join_securely(pair.client_end, 0, pair.random);
  ASSERT_EQ(pair.first_event(*client, *server).kind, TransportEventKind::connected);
  const std::vector<std::byte> bytes(k_max_reliable_bytes + 1, std::byte{5});
  for (const Channel channel : {Channel::reliable, Channel::unreliable}) {
    const std::size_t limit =
        channel == Channel::reliable ? k_max_reliable_bytes : k_max_datagram_bytes;
    EXPECT_EQ(client->send(k_first, channel, ByteView(bytes).first(limit)), Status::ok);
    EXPECT_EQ(client->send(k_first, channel, ByteView(bytes).first(limit + 1)),
              Status::invalid_argument);
  }
  TransportEvent event;
  ASSERT_TRUE(server->poll(++pair.now_us, event));
  EXPECT_EQ(event.kind, TransportEventKind::connected);
  for (const std::size_t size : {k_max_reliable_bytes, k_max_datagram_bytes}) {
    ASSERT_TRUE(server->poll(++pair.now_us, event));
    EXPECT_EQ(event.bytes.size(), size);
    EXPECT_EQ(event.bytes.back(), std::byte{5});
  }
}

TEST(SecureTransport, SilentStrangersAreDisconnected) {
  Pair pair;
  const auto server = serve_securely(pair.server_end, pair.random);
  TransportEvent event;
  EXPECT_FALSE(server->poll(0, event));
  EXPECT_FALSE(server->poll(4 * k_second_us, event));
  EXPECT_EQ(server->counters().handshakes_timed_out, 0U);
  EXPECT_FALSE(server->poll(6 * k_second_us, event));
  EXPECT_EQ(server->counters().handshakes_timed_out, 1U);
  ASSERT_TRUE(pair.client_end.poll(6 * k_second_us, event));  // connected
  ASSERT_TRUE(pair.client_end.poll(6 * k_second_us, event));
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
}

TEST(SecureTransport, RandomPacketsNeverCrashEitherSide) {
  Random random(17);
  for (int round = 0; round < 300; ++round) {
    Pair pair;
    const auto server = serve_securely(pair.server_end, pair.random);
    TransportEvent event;
    ASSERT_TRUE(pair.client_end.poll(0, event));
    for (int i = 0; i < 4; ++i) {
      std::vector<std::byte> bytes(1 + random.below(400));
      for (std::byte& byte : bytes)
        byte = static_cast<std::byte>(random.below(256));
      bytes[0] = static_cast<std::byte>(0xc0 + random.below(8));
      const Channel channel = random.below(2) == 0 ? Channel::reliable : Channel::unreliable;
      static_cast<void>(pair.client_end.send(k_first, channel, bytes));
      ASSERT_FALSE(server->poll(++pair.now_us, event));
    }
    EXPECT_EQ(server->counters().handshakes_completed, 0U);
  }
}

// A session of one kind meets one of the other.
struct Mixed {
  Mixed(bool server_secure, bool client_secure) {
    Pair pair;
    std::unique_ptr<SecureTransport> secure_server, secure_client;
    ServerConfig server_config;
    server_config.insecure = !server_secure;
    server_config.match_config = toy.encode();
    ServerParts parts;
    parts.transport = &pair.server_end;
    parts.simulation = &simulation;
    parts.observer = &log;
    if (server_secure) {
      secure_server = serve_securely(pair.server_end, pair.random);
      parts.transport = secure_server.get();
    }
    const auto server = Server::create(server_config, parts).server;
    ScriptedInputs inputs(1, 0);
    ClientConfig client_config;
    client_config.insecure = !client_secure;
    ClientParts client_parts;
    client_parts.transport = &pair.client_end;
    if (client_secure) {
      secure_client = join_securely(pair.client_end, 0, pair.random);
      client_parts.transport = secure_client.get();
    }
    client_parts.connection = k_first;
    client_parts.factory = lockstone::toy::toy_factory();
    client_parts.inputs = &inputs;
    const auto client = Client::create(client_config, std::move(client_parts)).client;
    for (std::int64_t now_us = 0; now_us < k_second_us; now_us += 10'000) {
      server->update(now_us);
      client->update(now_us);
    }
    state = client->state();
    refusal = client->refusal();
  }

  lockstone::toy::ToyConfig toy;
  ToySimulation simulation{toy};
  ServerLog log;
  ClientState state = ClientState::connecting;
  Refusal refusal;
};

TEST(SecureTransport, InsecureAndSecureRefuseEachOtherWithTheReason) {
  for (const bool server_secure : {false, true}) {
    const Mixed mixed(server_secure, !server_secure);
    EXPECT_EQ(mixed.state, ClientState::refused);
    EXPECT_EQ(mixed.refusal.reason, RefuseReason::insecure_not_allowed);
  }
  EXPECT_EQ(Mixed(true, true).state, ClientState::lobby);
  EXPECT_EQ(Mixed(false, false).state, ClientState::lobby);
}

TEST(SecureTransport, SessionsMustSayWhetherTheyAreInsecure) {
  Pair pair;
  const auto secure = serve_securely(pair.server_end, pair.random);
  lockstone::toy::ToyConfig toy;
  ServerConfig config;
  config.info = ToySimulation(toy).info();
  config.match_config = toy.encode();
  config.insecure = true;
  EXPECT_EQ(Server::create(config, {.transport = secure.get()}).error,
            SetupError::insecure_on_secure_transport);
  EXPECT_EQ(Server::create(config, {.transport = &pair.server_end}).error, SetupError::none);
  config.insecure = false;
  EXPECT_EQ(Server::create(config, {.transport = secure.get()}).error, SetupError::none);
  EXPECT_EQ(Server::create(config, {.transport = &pair.server_end}).error,
            SetupError::insecure_not_requested);
}

TEST(SecureTransport, ASlotThatTheTokenDoesNotGiveIsRefused) {
  MatchOptions options = secure_match();
  Match match(options);  // its clients ask for the slots of their tokens
  ClientConfig config;
  config.wanted_slot = 1;
  SimTransport& end = match.network.add_endpoint();
  const auto secure = join_securely(end, 0, match.random);
  ClientParts parts;
  parts.transport = secure.get();
  parts.connection = match.network.connect(end, match.server_transport, {});
  parts.factory = lockstone::toy::toy_factory();
  parts.inputs = match.players[0].inputs.get();
  const auto client = Client::create(config, std::move(parts)).client;
  match.players[0].paused = true;
  for (int i = 0; i < 50; ++i) {
    match.step();
    client->update(match.now_us);
  }
  EXPECT_EQ(client->state(), ClientState::refused);
  EXPECT_EQ(client->refusal().reason, RefuseReason::wrong_slot);
}

}  // namespace
}  // namespace lockstone::net::test
