// One transport for many matches: who gets which event, and that nobody suffers from a slow match.
#include <array>
#include <atomic>
#include <map>
#include <thread>

#include <gtest/gtest.h>

#include <lockstone/net/match_router.h>

#include "tests/net/routing/scripted_carrier.h"
#include "tests/net/security/secure_fixture.h"
#include "tests/support/workload.h"

namespace lockstone::net::test {
namespace {

struct Event {
  TransportEventKind kind = TransportEventKind::received;
  ConnectionId connection = k_no_connection;
  Channel channel = Channel::reliable;
  std::vector<std::byte> bytes;
  friend bool operator==(const Event&, const Event&) = default;
};

std::vector<Event> read(Transport& transport) {
  std::vector<Event> seen;
  TransportEvent event;
  while (transport.poll(0, event))
    seen.push_back(
        {event.kind, event.connection, event.channel, {event.bytes.begin(), event.bytes.end()}});
  return seen;
}

std::vector<std::byte> packet(std::size_t size, std::uint64_t value) {
  return std::vector<std::byte>(size, static_cast<std::byte>(value & 0xff));
}

struct Routed {
  explicit Routed(const MatchRouterOptions& options = {.max_matches = 8, .max_connections = 64})
      : matches(backend_key(), options.max_matches),
        router(std::move(MatchRouter::create(carrier, matches, options)).value()) {}

  Transport& open(std::uint64_t match) { return *router->open(match).value(); }
  void pump() { router->pump(0); }

  ScriptedCarrier carrier;
  OpenMatches matches;
  std::unique_ptr<MatchRouter> router;
};

TEST(MatchRouter, AnEventReachesTheMatchOfItsToken) {
  Routed routed;
  Transport& one = routed.open(1);
  Transport& two = routed.open(2);
  const ConnectionId a = routed.carrier.connect(1), b = routed.carrier.connect(2);
  routed.carrier.receive(b, Channel::unreliable, packet(5, 7));
  routed.pump();
  const std::vector<Event> of_one = read(one), of_two = read(two);
  ASSERT_EQ(of_one.size(), 1U);
  EXPECT_EQ(of_one[0], (Event{TransportEventKind::connected, a, Channel::reliable, {}}));
  ASSERT_EQ(of_two.size(), 2U);
  EXPECT_EQ(of_two[1], (Event{TransportEventKind::received, b, Channel::unreliable, packet(5, 7)}));
  EXPECT_EQ(two.identity(b).match, 2U);
  EXPECT_FALSE(one.identity(b).authenticated);
  EXPECT_EQ(one.send(b, Channel::reliable, packet(1, 1)), Status::stale_handle);
}

TEST(MatchRouter, ConnectionsOfNoOpenMatchEnd) {
  Routed routed;
  Transport& one = routed.open(1);
  const ConnectionId stray = routed.carrier.connect(9);
  routed.pump();
  EXPECT_EQ(routed.carrier.ended, std::vector{stray});
  EXPECT_EQ(routed.router->counters().homeless, 1U);
  EXPECT_TRUE(read(one).empty());
}

TEST(MatchRouter, AFullMatchTakesNoMoreConnections) {
  Routed routed({.max_matches = 2, .max_connections = 8, .max_connections_per_match = 2});
  Transport& one = routed.open(1);
  for (int i = 0; i < 3; ++i)
    routed.carrier.connect(1);
  routed.pump();
  EXPECT_EQ(read(one).size(), 2U);
  EXPECT_EQ(routed.carrier.ended.size(), 1U);
  one.disconnect(1);
  routed.carrier.connect(1);
  routed.pump();  // takes the order after it has refused the connection
  EXPECT_TRUE(read(one).empty());
  routed.carrier.connect(1);
  routed.pump();
  EXPECT_EQ(read(one).size(), 1U);
}

TEST(MatchRouter, PacketsLeaveInTheirOrderAndBeforeTheEnd) {
  Routed routed;
  Transport& one = routed.open(1);
  const ConnectionId a = routed.carrier.connect(1);
  routed.pump();
  read(one);
  one.trust(a);
  one.trust(a);
  EXPECT_EQ(one.send(a, Channel::reliable, packet(3, 1)), Status::ok);
  EXPECT_EQ(one.send(a, Channel::unreliable, packet(3, 2)), Status::ok);
  one.disconnect(a);
  EXPECT_EQ(one.send(a, Channel::reliable, packet(3, 3)), Status::stale_handle);
  EXPECT_TRUE(routed.carrier.sent.empty());
  routed.pump();
  ASSERT_EQ(routed.carrier.sent.size(), 2U);
  EXPECT_EQ(routed.carrier.sent[1].bytes, packet(3, 2));
  EXPECT_EQ(routed.carrier.trusted, std::vector{a});
  EXPECT_EQ(routed.carrier.ended, std::vector{a});
  EXPECT_TRUE(read(one).empty());
}

TEST(MatchRouter, AMatchThatEndsFreesItsPlaceAfterItsLastPackets) {
  Routed routed({.max_matches = 1, .max_connections = 8});
  Transport& one = routed.open(1);
  const ConnectionId a = routed.carrier.connect(1);
  routed.pump();
  read(one);
  EXPECT_EQ(one.send(a, Channel::reliable, packet(4, 9)), Status::ok);
  routed.router->close(one);
  EXPECT_FALSE(routed.matches.contains(1));
  EXPECT_EQ(routed.router->open(2).status(), Status::capacity_exhausted);
  routed.pump();
  EXPECT_EQ(routed.carrier.sent.size(), 1U);
  EXPECT_EQ(routed.carrier.ended, std::vector{a});
  Transport& two = routed.open(2);
  const ConnectionId b = routed.carrier.connect(2);
  routed.pump();
  ASSERT_EQ(read(two).size(), 1U);
  EXPECT_TRUE(two.identity(b).authenticated);
  EXPECT_FALSE(two.identity(a).authenticated);
}

TEST(MatchRouter, AnOpenMatchIsNotOpenedTwice) {
  Routed routed;
  routed.open(1);
  EXPECT_EQ(routed.router->open(1).status(), Status::invalid_argument);
}

TEST(MatchRouter, TokensAloneNameMatches) {
  class Bare final : public Transport {
   public:
    bool poll(std::int64_t, TransportEvent&) override { return false; }
    Status send(ConnectionId, Channel, ByteView) override { return Status::ok; }
    void flush() override {}
    void disconnect(ConnectionId) override {}
    [[nodiscard]] TransportStats stats(ConnectionId) const override { return {}; }
  } bare;
  OpenMatches matches(backend_key(), 1);
  EXPECT_EQ(MatchRouter::create(bare, matches, {}).status(), Status::invalid_argument);
}

TEST(MatchRouter, AStuckMatchLosesItsOwnPacketsOnly) {
  Routed routed({.max_matches = 2, .max_connections = 8, .queue_bytes = 256 * 1024});
  Transport& stuck = routed.open(1);
  Transport& busy = routed.open(2);
  const ConnectionId a = routed.carrier.connect(1), b = routed.carrier.connect(2);
  const ConnectionId c = routed.carrier.connect(1);
  std::size_t heard = 0;
  for (unsigned i = 0; i < 1000; ++i) {
    routed.carrier.receive(a, Channel::unreliable, packet(1000, i));
    routed.carrier.receive(b, Channel::unreliable, packet(1000, i));
    routed.pump();
    heard += read(busy).size();
  }
  EXPECT_EQ(heard, 1001U);
  EXPECT_GT(routed.router->counters().lost, 700U);
  EXPECT_TRUE(routed.carrier.ended.empty());
  routed.carrier.receive(a, Channel::reliable, packet(10'000, 1));
  routed.pump();
  EXPECT_EQ(routed.carrier.ended, std::vector{a});
  EXPECT_EQ(routed.router->counters().broken, 1U);
  const std::vector<Event> late = read(stuck);
  EXPECT_EQ(late.back(), (Event{TransportEventKind::disconnected, a, Channel::reliable, {}}));
  // The other connection of the stuck match goes on.
  routed.carrier.receive(c, Channel::reliable, packet(10'000, 2));
  routed.pump();
  EXPECT_EQ(read(stuck).size(), 1U);
}

// The router does not pump: the match's own sends are refused, its orders still fit.
TEST(MatchRouter, OrdersFitInAFullQueue) {
  Routed routed({.max_matches = 1, .max_connections = 8, .queue_bytes = 256 * 1024});
  Transport& one = routed.open(1);
  const ConnectionId a = routed.carrier.connect(1), b = routed.carrier.connect(1);
  routed.pump();
  read(one);
  while (one.send(a, Channel::unreliable, packet(1000, 1)) == Status::ok) {
  }
  EXPECT_EQ(one.send(b, Channel::reliable, packet(1000, 1)), Status::capacity_exhausted);
  one.trust(a);
  one.trust(b);
  one.disconnect(a);
  one.disconnect(b);
  routed.pump();
  EXPECT_EQ(routed.carrier.trusted.size(), 2U);
  EXPECT_EQ(routed.carrier.ended.size(), 2U);
}

TEST(MatchRouter, AReliablePacketThatTheCarrierRefusesEndsItsConnection) {
  Routed routed;
  Transport& one = routed.open(1);
  const ConnectionId a = routed.carrier.connect(1);
  routed.pump();
  read(one);
  routed.carrier.full = true;
  EXPECT_EQ(one.send(a, Channel::unreliable, packet(10, 1)), Status::ok);
  routed.pump();
  EXPECT_TRUE(routed.carrier.ended.empty());
  EXPECT_EQ(one.send(a, Channel::reliable, packet(10, 1)), Status::ok);
  routed.pump();
  EXPECT_EQ(routed.carrier.ended, std::vector{a});
  const std::vector<Event> seen = read(one);
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].kind, TransportEventKind::disconnected);
}

// Against a model: every open match sees its events, in order, until it ends a connection.
class Churn {
 public:
  explicit Churn(std::uint64_t seed) : random_(seed) {}

  void act() {
    switch (random_.below(8)) {
      case 0:
        return open();
      case 1:
        return close();
      case 2:
        return connect();
      case 3:
        return lose();
      case 4:
        return leave();
      case 5:
        return pump_and_compare();
      default:
        return receive();
    }
  }

  void pump_and_compare() {
    routed_.pump();
    for (auto& [match, room] : rooms_) {
      EXPECT_EQ(read(*room.transport), room.expected);
      room.expected.clear();
      room.known = room.live;
    }
  }

  std::uint64_t opened() const { return last_match_; }

 private:
  struct Room {
    Transport* transport = nullptr;
    std::vector<ConnectionId> live;
    std::vector<ConnectionId> known;  ///< which the match has read of
    std::vector<Event> expected;
  };

  void open() {
    const Result<Transport*> opened = routed_.router->open(last_match_ + 1);
    EXPECT_EQ(opened.ok(), rooms_.size() < 8);
    if (!opened.ok()) return;
    rooms_[++last_match_].transport = opened.value();
  }
  void close() {
    if (rooms_.empty()) return;
    pump_and_compare();
    const auto room = any_room();
    routed_.router->close(*room->second.transport);
    rooms_.erase(room);
    routed_.pump();
  }
  void connect() {
    if (rooms_.empty()) return;
    const auto room = any_room();
    if (room->second.live.size() >= 8) return;
    const ConnectionId connection = routed_.carrier.connect(room->first);
    room->second.live.push_back(connection);
    room->second.expected.push_back({TransportEventKind::connected, connection, {}, {}});
  }
  void lose() {
    if (rooms_.empty()) return;
    Room& room = any_room()->second;
    if (room.live.empty()) return;
    const ConnectionId connection = room.live[random_.below(room.live.size())];
    routed_.carrier.lose(connection);
    std::erase(room.live, connection);
    std::erase(room.known, connection);
    room.expected.push_back({TransportEventKind::disconnected, connection, {}, {}});
  }
  void leave() {
    if (rooms_.empty()) return;
    Room& room = any_room()->second;
    if (room.known.empty()) return;
    const ConnectionId connection = room.known[random_.below(room.known.size())];
    room.transport->disconnect(connection);
    std::erase(room.live, connection);
    std::erase(room.known, connection);
    std::erase_if(room.expected,
                  [connection](const Event& seen) { return seen.connection == connection; });
  }
  void receive() {
    if (rooms_.empty()) return;
    Room& room = any_room()->second;
    if (room.live.empty()) return;
    const ConnectionId connection = room.live[random_.below(room.live.size())];
    const Channel channel = random_.below(2) == 0 ? Channel::reliable : Channel::unreliable;
    const std::vector<std::byte> bytes = packet(1 + random_.below(1200), random_.below(256));
    routed_.carrier.receive(connection, channel, bytes);
    room.expected.push_back({TransportEventKind::received, connection, channel, bytes});
  }
  std::map<std::uint64_t, Room>::iterator any_room() {
    auto room = rooms_.begin();
    std::advance(room, static_cast<std::ptrdiff_t>(random_.below(rooms_.size())));
    return room;
  }

  Random random_;
  Routed routed_;
  std::map<std::uint64_t, Room> rooms_;
  std::uint64_t last_match_ = 0;
};

TEST(MatchRouter, RandomMatchesSeeTheirEvents) {
  for (std::uint64_t seed = 1; seed <= lockstone::test::share_of(40U); ++seed) {
    SCOPED_TRACE(seed);
    Churn churn(seed);
    for (int i = 0; i < 2000; ++i)
      churn.act();
    churn.pump_and_compare();
    EXPECT_GT(churn.opened(), 20U);
  }
}

// Matches on threads of their own echo, end and begin again while the router pumps.
TEST(MatchRouter, MatchesRunOnThreadsOfTheirOwn) {
  constexpr unsigned k_threads = 4;
  constexpr unsigned k_matches_a_thread = 8;
  constexpr unsigned k_packets = 60;
  Routed routed({.max_matches = k_threads, .max_connections = 64});
  std::atomic<std::uint64_t> echoed{0};
  std::atomic<unsigned> ended{0};
  std::array<std::atomic<std::uint64_t>, k_threads> wanted{};  // a match that waits for a player
  const auto host = [&](unsigned thread) {
    for (unsigned round = 0; round < k_matches_a_thread; ++round) {
      const std::uint64_t match = 1 + thread + round * k_threads;
      Result<Transport*> opened = routed.router->open(match);
      for (; !opened.ok(); opened = routed.router->open(match))
        std::this_thread::yield();
      wanted[thread] = match;
      Transport& transport = *opened.value();
      TransportEvent event;
      for (unsigned heard = 0; heard < k_packets; std::this_thread::yield()) {
        while (transport.poll(0, event)) {
          if (event.kind != TransportEventKind::received) continue;
          ++heard;
          if (transport.send(event.connection, Channel::reliable, event.bytes) == Status::ok)
            ++echoed;
        }
      }
      routed.router->close(transport);
    }
    ++ended;
  };
  std::vector<std::thread> threads;
  for (unsigned i = 0; i < k_threads; ++i)
    threads.emplace_back(host, i);
  while (ended < k_threads) {
    for (std::atomic<std::uint64_t>& match : wanted) {
      const std::uint64_t number = match.exchange(0);
      if (number == 0) continue;
      const ConnectionId connection = routed.carrier.connect(number);
      for (unsigned i = 0; i < k_packets; ++i)
        routed.carrier.receive(connection, Channel::reliable, packet(100, i));
    }
    routed.pump();
  }
  for (std::thread& thread : threads)
    thread.join();
  routed.pump();
  EXPECT_EQ(echoed, std::uint64_t{k_threads} * k_matches_a_thread * k_packets);
  EXPECT_EQ(routed.carrier.sent.size(), echoed);
  EXPECT_EQ(routed.router->counters().broken, 0U);
}

}  // namespace
}  // namespace lockstone::net::test
