// Whole matches that share one transport, and sockets that know several matches.
#include <gtest/gtest.h>

#include <lockstone/net/match_router.h>
#ifdef LOCKSTONE_WITH_ENET
#include <lockstone/net/transport_enet.h>
#endif

#include "tests/net/match_fixture.h"
#include "tests/support/await.h"
#include "tests/support/workload.h"

namespace lockstone::net::test {
namespace {

constexpr std::uint64_t k_ticks = 150;

SecureServerOptions options_with(const OpenMatches& matches) {
  SecureServerOptions options = server_options();
  options.matches = &matches;
  options.max_connections = 64;
  return options;
}

ConnectToken token_of(std::uint64_t match, std::size_t slot, RandomSource& random) {
  TokenGrant grant = grant_for(slot);
  grant.match = match;
  return issue_token(backend_key(), grant, random).value();
}

MatchOptions options_of(std::uint64_t match) {
  MatchOptions options = match_of(3, k_ticks, match);
  options.faults.delay_us = 12'000;
  options.secure = true;
  return options;
}

/// Several matches of the toy on one endpoint of a simulated network.
class SharedNetwork {
 public:
  explicit SharedNetwork(const LinkFaults& faults) : faults_(faults) {}

  void open(std::uint64_t match) {
    auto room = std::make_unique<Room>(options_of(match));
    room->transport = router_->open(match).value();
    ServerConfig config;
    config.tick_count = k_ticks;
    config.match_config = room->toy.encode();
    room->server = std::move(
        Server::create(config, {room->transport, &room->simulation, nullptr, &room->log}).server);
    for (std::size_t slot = 0; slot < 3; ++slot)
      add_client(*room, match, slot);
    rooms.push_back(std::move(room));
  }

  void run(std::int64_t span_us) {
    for (const std::int64_t end = now_us_ + span_us; now_us_ < end; now_us_ += 4'000) {
      router_->pump(now_us_);
      for (auto& room : rooms) {
        if (room->transport != nullptr) update(*room);
      }
      router_->pump(now_us_);
      for (auto& room : rooms) {
        for (auto& player : room->players)
          player->client->update(now_us_);
      }
    }
  }

  struct Player {
    std::unique_ptr<SecureTransport> secure;
    std::unique_ptr<ScriptedInputs> inputs;
    ClientLog log;
    std::unique_ptr<Client> client;
  };
  struct Room {
    explicit Room(const MatchOptions& options) : toy(options.toy), simulation(options.toy) {}
    ToyConfig toy;
    ToySimulation simulation;
    Transport* transport = nullptr;  ///< null once it is over
    ServerLog log;
    std::unique_ptr<Server> server;
    std::vector<std::unique_ptr<Player>> players;
  };
  std::vector<std::unique_ptr<Room>> rooms;

 private:
  void update(Room& room) {
    room.server->update(now_us_);
    if (room.server->state() != ServerState::over) return;
    router_->close(*room.transport);
    room.transport = nullptr;
  }

  void add_client(Room& room, std::uint64_t match, std::size_t slot) {
    auto player = std::make_unique<Player>();
    SimTransport& endpoint = network_.add_endpoint();
    const ConnectToken token = token_of(match, slot, random_);
    player->secure = std::move(SecureTransport::join(endpoint, token, random_)).value();
    player->inputs = std::make_unique<ScriptedInputs>(match, slot);
    ClientConfig config;
    config.wanted_slot = static_cast<std::uint8_t>(slot);
    ClientParts parts;
    parts.transport = player->secure.get();
    parts.connection = network_.connect(endpoint, endpoint_, faults_);
    parts.inputs = player->inputs.get();
    parts.observer = &player->log;
    parts.factory = [](ByteView bytes) -> Result<std::unique_ptr<Simulation>> {
      const Result<ToyConfig> toy = ToyConfig::decode(bytes);
      if (!toy) return toy.status();
      return std::unique_ptr<Simulation>(std::make_unique<ToySimulation>(toy.value()));
    };
    player->client = std::move(Client::create(config, std::move(parts)).client);
    room.players.push_back(std::move(player));
  }

  LinkFaults faults_;
  TestRandom random_{5};
  SimNetwork network_{1};
  SimTransport& endpoint_ = network_.add_endpoint();
  OpenMatches matches_{backend_key(), 4};
  std::unique_ptr<SecureTransport> secure_ =
      std::move(SecureTransport::serve(endpoint_, options_with(matches_), random_)).value();
  std::unique_ptr<MatchRouter> router_ =
      std::move(MatchRouter::create(*secure_, matches_, {.max_matches = 4})).value();
  std::int64_t now_us_ = 0;
};

void expect_whole(const SharedNetwork::Room& room) {
  EXPECT_EQ(room.server->state(), ServerState::over);
  EXPECT_EQ(room.log.seen.ticks.size(), k_ticks);
  for (const auto& player : room.players) {
    EXPECT_EQ(player->client->state(), ClientState::finished);
    EXPECT_EQ(player->log.seen.hashes, room.log.seen.hashes);
    EXPECT_EQ(player->log.seen.ticks, room.log.seen.ticks);
  }
}

TEST(RoutedMatch, IsTheSameAsWithATransportOfItsOwn) {
  LinkFaults faults;
  faults.delay_us = 12'000;
  SharedNetwork shared(faults);
  for (std::uint64_t match = 1; match <= 4; ++match)
    shared.open(match);
  shared.run(10 * k_second_us);
  for (std::uint64_t match = 1; match <= 4; ++match) {
    SCOPED_TRACE(match);
    Match alone(options_of(match));
    EXPECT_TRUE(alone.run(10 * k_second_us));
    const SharedNetwork::Room& room = *shared.rooms[match - 1];
    expect_whole(room);
    EXPECT_EQ(room.log.seen.hashes, alone.server_log.seen.hashes);
    EXPECT_EQ(room.log.seen.ticks, alone.server_log.seen.ticks);
  }
}

TEST(RoutedMatch, OneFollowsAnotherOnARoughNetwork) {
  SharedNetwork shared(rough(20'000));
  std::uint64_t match = 0;
  for (unsigned round = 0; round < lockstone::test::share_of(4U); ++round) {
    for (int i = 0; i < 4; ++i)
      shared.open(++match);
    shared.run(12 * k_second_us);
  }
  for (const auto& room : shared.rooms)
    expect_whole(*room);
}

TEST(OpenMatches, KnowsTheKeysOfThoseThatAreOpen) {
  OpenMatches matches(backend_key(), 2);
  EXPECT_EQ(matches.add(7), Status::ok);
  EXPECT_EQ(matches.add(7), Status::invalid_argument);
  EXPECT_EQ(matches.add(8), Status::ok);
  EXPECT_EQ(matches.add(9), Status::capacity_exhausted);
  EXPECT_EQ(matches.link_key_of(make_match_tag(8)), make_link_key(backend_key(), 8));
  matches.remove(8);
  EXPECT_FALSE(matches.contains(8));
  EXPECT_FALSE(matches.link_key_of(make_match_tag(8)).has_value());
  EXPECT_EQ(matches.add(9), Status::ok);
}

#ifdef LOCKSTONE_WITH_ENET
/// A client's socket for one token.
struct Caller {
  Caller(std::uint64_t match, std::uint16_t port, RandomSource& random) {
    const ConnectToken token = token_of(match, 0, random);
    EnetOptions options;
    options.link_key = token.link_key;
    options.match_tag = make_match_tag(match);
    socket = std::move(EnetTransport::open(options)).value();
    secure = std::move(SecureTransport::join(*socket, token, random)).value();
    connection = socket->connect("127.0.0.1", port).value();
  }
  std::unique_ptr<EnetTransport> socket;
  std::unique_ptr<SecureTransport> secure;
  ConnectionId connection = k_no_connection;
};

TEST(SharedSocket, TakesThePlayersOfItsOpenMatchesOnly) {
  SystemRandom random;
  OpenMatches matches(backend_key(), 2);
  const auto socket = std::move(EnetTransport::listen({.matches = &matches})).value();
  const auto secure =
      std::move(SecureTransport::serve(*socket, options_with(matches), random)).value();
  const auto router = std::move(MatchRouter::create(*secure, matches, {.max_matches = 2})).value();
  Transport* rooms[2] = {router->open(11).value(), router->open(12).value()};
  Caller players[2] = {{11, socket->port(), random}, {12, socket->port(), random}};
  Caller stranger(13, socket->port(), random);
  std::array<ConnectionId, 2> heard{};
  TransportEvent event;
  RefuseReason refusal = RefuseReason::none;
  std::int64_t now_us = 0;
  lockstone::test::await([&] {
    router->pump(now_us);
    for (std::size_t i = 0; i < 2; ++i) {
      static_cast<void>(players[i].secure->poll(now_us, event));
      if (rooms[i]->poll(now_us, event) && event.kind == TransportEventKind::connected)
        heard[i] = event.connection;
    }
    if (stranger.secure->poll(now_us, event)) refusal = event.reason;
    now_us += 1000;  // the stranger believes the refusal after two seconds
    return heard[0] != 0 && heard[1] != 0 && refusal != RefuseReason::none;
  });
  EXPECT_EQ(refusal, RefuseReason::wrong_match);
  EXPECT_EQ(rooms[0]->identity(heard[0]).match, 11U);
  EXPECT_EQ(rooms[1]->identity(heard[1]).match, 12U);
  EXPECT_GT(socket->counters().refusals, 0U);

  // A packet each way, under the keys of each match.
  const std::vector<std::byte> hello(5, std::byte{42});
  std::size_t echoes = 0;
  for (Caller& player : players)
    EXPECT_EQ(player.secure->send(player.connection, Channel::reliable, hello), Status::ok);
  lockstone::test::await([&] {
    router->pump(now_us);
    for (std::size_t i = 0; i < 2; ++i) {
      if (rooms[i]->poll(now_us, event) && event.kind == TransportEventKind::received) {
        EXPECT_EQ(rooms[i]->send(event.connection, Channel::reliable, event.bytes), Status::ok);
      }
      if (players[i].secure->poll(now_us, event) && event.kind == TransportEventKind::received)
        ++echoes;
    }
    return echoes == 2;
  });
}
#endif

}  // namespace
}  // namespace lockstone::net::test
