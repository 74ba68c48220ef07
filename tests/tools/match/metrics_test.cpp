#include "tools/lockstone/match/metrics.h"

#include <array>
#include <string>
#include <string_view>

#include <arpa/inet.h>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "tests/support/await.h"
#include "tools/lockstone/match/journal.h"
#include "tools/lockstone/match/tick_lateness.h"

namespace lockstone::tool {
namespace {

MatchMetrics some_metrics() {
  MatchMetrics metrics;
  metrics.port = 7777;
  metrics.ticks = 60;
  metrics.spectators = 1;
  metrics.present_mask = 0b10;
  metrics.players.resize(2);
  metrics.players[1].late_inputs = 3;
  return metrics;
}

HttpAnswer about_a_match(std::string_view request) {
  return answer_about(request, some_metrics());
}

RoomsMetrics some_rooms() {
  RoomsMetrics rooms;
  rooms.state = "open";
  for (const std::uint64_t number : {7U, 8U}) {
    MatchMetrics match = some_metrics();
    match.room = number;
    add_up_present(rooms.sum, match);
    rooms.matches.push_back(match);
  }
  MatchMetrics gone = some_metrics();
  gone.ticks = 1000;
  add_up(rooms.sum, gone);
  rooms.ended = 1;
  rooms.sum.socket.datagrams = 123;
  rooms.router.lost = 9;
  return rooms;
}

/// Somebody who asks.
class Caller {
 public:
  explicit Caller(const MetricsPort& port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port.port());
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ::fcntl(socket_, F_SETFL, O_NONBLOCK);
  }
  ~Caller() { ::close(socket_); }
  Caller(const Caller&) = delete;
  Caller& operator=(const Caller&) = delete;

  std::string ask(MetricsPort& port, const std::string& path,
                  const MetricsPort::Answerer& answerer = about_a_match) const {
    const std::string request = "GET " + path + " HTTP/1.0\r\n\r\n";
    EXPECT_EQ(::send(socket_, request.data(), request.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(request.size()));
    std::string answer;
    test::await([&] {
      port.serve(answerer);
      std::array<char, 4096> bytes{};
      const ssize_t count = ::recv(socket_, bytes.data(), bytes.size(), 0);
      if (count > 0) answer.append(bytes.data(), static_cast<std::size_t>(count));
      return count == 0;
    });
    return answer;
  }

 private:
  int socket_;
};

bool has(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

// A counter that is kept is also told, each by its own name.
TEST(Metrics, TellEveryCounterOfTheSocketAndOfTheHandshakes) {
  MatchMetrics metrics;
  metrics.port = 1;
  metrics.socket = {1001, 1002, 1003, 1004, 1005, 1006, 1007, 1008, 1009, 1010, 1011, 1012};
  metrics.security = {2001, 2002, 2003, 2004, 2005, 2006, 2007};
  static_assert(sizeof metrics.socket == 12 * sizeof(std::uint64_t));
  static_assert(sizeof metrics.security == 7 * sizeof(std::uint64_t));
  const std::string json = metrics_as_json(metrics);
  const std::string prometheus = metrics_for_prometheus(metrics);
  for (const unsigned first : {1001U, 2001U}) {
    for (unsigned value = first; value < first + (first == 1001 ? 12U : 7U); ++value) {
      EXPECT_TRUE(has(json, ": " + std::to_string(value) + ",")) << value;
      EXPECT_TRUE(has(prometheus, "\"} " + std::to_string(value) + "\n")) << value;
    }
  }
  EXPECT_TRUE(has(prometheus, "lockstone_datagrams_too_far_ahead{match=\"1\"} 1009"));
  EXPECT_TRUE(has(prometheus, "lockstone_connects_crowded{match=\"1\"} 1010"));
  EXPECT_TRUE(has(prometheus, "lockstone_datagrams_replayed{match=\"1\"} 1011"));
  EXPECT_TRUE(has(prometheus, "lockstone_datagrams_oversized{match=\"1\"} 1012"));
}

TEST(Metrics, AreAnsweredInTheFormatOfEachPath) {
  const auto port = MetricsPort::open(0);
  ASSERT_NE(port, nullptr);
  const std::string prometheus = Caller(*port).ask(*port, "/metrics");
  EXPECT_TRUE(has(prometheus, "200 OK")) << prometheus;
  EXPECT_TRUE(has(prometheus, "lockstone_ticks{match=\"7777\"} 60")) << prometheus;
  EXPECT_TRUE(has(prometheus, "lockstone_player_late_inputs{match=\"7777\",player=\"1\"} 3"));
  EXPECT_TRUE(has(Caller(*port).ask(*port, "/stats.json"), "\"late_inputs\": 3"));
  EXPECT_TRUE(has(Caller(*port).ask(*port, "/"), "player 1 (here):"));
}

TEST(Metrics, TellWhetherPlayersMayCome) {
  const auto port = MetricsPort::open(0);
  ASSERT_NE(port, nullptr);
  EXPECT_TRUE(has(Caller(*port).ask(*port, "/readyz"), "HTTP/1.0 200 OK"));
  EXPECT_TRUE(has(Caller(*port).ask(*port, "/livez"), "HTTP/1.0 200 OK"));
}

TEST(Journal, WritesOneObjectALine) {
  const std::string line = journal_line(
      {"player_joined", "player 3 joined: \"A\"\n\xff", std::uint8_t{3}}, 7777, 1'764'072'000'123);
  EXPECT_EQ(line, R"({"time":"2025-11-25T12:00:00.123Z","level":"info","event":"player_joined",)"
                  R"("match":7777,"player":3,"text":"player 3 joined: \"A\"\n)"
                  "\xef\xbf\xbd\"}");
}

TEST(Metrics, TellOfAttacksByReason) {
  MatchMetrics metrics = some_metrics();
  metrics.server.refused[static_cast<std::size_t>(net::RefuseReason::expelled)] = 4;
  metrics.server.left[static_cast<std::size_t>(net::LeaveReason::desync)] = 1;
  metrics.server.verdicts[static_cast<std::size_t>(net::Verdict::client_diverged)] = 2;
  metrics.server.resyncs = 1;
  metrics.connections.condemned = 3;
  metrics.socket.limited = 70;
  metrics.security.packets_forged = 9;
  const std::string text = metrics_for_prometheus(metrics);
  for (const std::string_view line :
       {"lockstone_refused{match=\"7777\",reason=\"sent away from this match\"} 4\n",
        "lockstone_left{match=\"7777\",reason=\"desync\"} 1\n",
        "lockstone_wrong_states{match=\"7777\",verdict=\"client diverged\"} 2\n",
        "lockstone_resyncs{match=\"7777\"} 1\n", "lockstone_datagrams_limited{match=\"7777\"} 70\n",
        "lockstone_connections_condemned{match=\"7777\"} 3\n",
        "lockstone_packets_forged{match=\"7777\"} 9\n"})
    EXPECT_TRUE(has(text, line)) << line << text;
  EXPECT_TRUE(has(metrics_as_json(metrics), "\"sent away from this match\": 4"));
  EXPECT_TRUE(has(metrics_as_text(metrics), "refused (sent away from this match): 4"));
}

TEST(Metrics, AreOnTheAddressThatIsAskedFor) {
  EXPECT_NE(MetricsPort::open(0, "0.0.0.0"), nullptr);
  EXPECT_EQ(MetricsPort::open(0, "no address"), nullptr);
  EXPECT_EQ(MetricsPort::open(0, "192.0.2.1"), nullptr);  // nobody's, by RFC 5737
}

TEST(Metrics, OfRoomsAreSumsAndFiguresOfEachMatch) {
  const RoomsMetrics rooms = some_rooms();
  const std::string text = rooms_for_prometheus(rooms);
  EXPECT_TRUE(has(text, "\nlockstone_host_ticks 1120\n")) << text;
  EXPECT_TRUE(has(text, "\nlockstone_host_spectators 2\n"));  // not of the one that is gone
  EXPECT_TRUE(has(text, "\nlockstone_host_player_late_inputs 9\n"));
  EXPECT_TRUE(has(text, "\nlockstone_host_datagrams 123\n"));
  EXPECT_TRUE(has(text, "\nlockstone_host_packets_lost_in_queues 9\n"));
  EXPECT_TRUE(has(text, "\nlockstone_ticks{match=\"7\"} 60\nlockstone_ticks{match=\"8\"} 60\n"));
  EXPECT_FALSE(has(text, "lockstone_datagrams{"));
  const std::string json = rooms_as_json(rooms);
  EXPECT_TRUE(has(json, "\"matches_ended\": 1"));
  EXPECT_TRUE(has(json, "\"match\": 8"));
  EXPECT_TRUE(has(json, "\"player_late_inputs\": 9"));
}

TEST(Metrics, OfRoomsSayWhetherAThreadHangs) {
  RoomsMetrics rooms = some_rooms();
  EXPECT_STREQ(answer_about("GET /livez HTTP/1.1", rooms).status, "200 OK");
  rooms.alive = false;
  EXPECT_STREQ(answer_about("GET /livez HTTP/1.1", rooms).status, "503 Service Unavailable");
}

TEST(Metrics, ALongAnswerArrivesWhole) {
  const auto port = MetricsPort::open(0);
  ASSERT_NE(port, nullptr);
  const std::string body(20'000'000, 'x');
  const std::string answer =
      Caller(*port).ask(*port, "/", [&body](std::string_view) { return HttpAnswer{.body = body}; });
  EXPECT_TRUE(answer.ends_with("\r\n\r\n" + body));
}

TEST(TickLateness, MeasuresAgainstTheMostPunctualTick) {
  TickLateness late;
  for (std::int64_t tick = 0; tick < 100; ++tick)
    late.note(5000 + tick * 1'000'000 / 60 + (tick == 50 ? 7000 : 250), 60);
  EXPECT_EQ(late.ticks(), 100U);
  EXPECT_EQ(late.percentile_us(50), 100);
  EXPECT_EQ(late.percentile_us(99), 100);
  EXPECT_NEAR(static_cast<double>(late.longest_us()), 6750, 2);
  TickLateness both;
  both.add(late);
  both.add(late);
  EXPECT_EQ(both.ticks(), 200U);
  EXPECT_EQ(both.longest_us(), late.longest_us());
}

TEST(Metrics, DoNotWaitForWhoSaysNothing) {
  const auto port = MetricsPort::open(0);
  ASSERT_NE(port, nullptr);
  const Caller silent(*port);
  port->serve(about_a_match);
  EXPECT_TRUE(has(Caller(*port).ask(*port, "/metrics"), "200 OK"));
}

}  // namespace
}  // namespace lockstone::tool
