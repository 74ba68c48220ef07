#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "net/transport/enet/enet_datagram.h"
#include "tests/support/await.h"
#include "tools/arena/arena_game.h"
#include "tools/relay/attacks.h"
#include "tools/relay/datagram_rate.h"

namespace lockstone::relay {
namespace {

SiegeOptions short_siege() {
  static const GameDef k_arena = arena::arena_game();
  SiegeOptions options;
  options.game = &k_arena;
  options.honest = 2;
  options.duration_us = 2'000'000;
  options.least_sent = 40;
  options.limits.packets_per_second = 100;  // so that the flood is one at once
  options.flood_per_second = 3000;
  options.walkers = 4;
  options.visitors = 4;  // each takes a whole world to make
  // An input is late when everything stands still for a second, which no busy machine does.
  options.input_delay = 60;
  return options;
}

TEST(Siege, IsWithstood) {
  const auto report = run_siege(short_siege());
  if (!report) GTEST_SKIP() << "no libsodium";
  EXPECT_TRUE(report->withstood());
  ASSERT_EQ(report->attacks.size(), 10U);
  for (const AttackReport& attack : report->attacks) {
    EXPECT_GE(attack.sent, 40U) << attack.name;
    EXPECT_LE(attack.admitted, attack.entitled) << attack.name;
  }
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(report->attacks[i].answered, 0U) << report->attacks[i].name;
  EXPECT_TRUE(report->traitor_dropped);
  EXPECT_TRUE(report->liar_expelled);
  EXPECT_EQ(report->visitors_seated, 4U);
  EXPECT_EQ(report->server_stalls, 0U);
  EXPECT_EQ(report->traitor.leave_reason, net::LeaveReason::left);
  for (const PlayerOutcome& player : report->honest) {
    EXPECT_EQ(player.substituted, 0U);
    EXPECT_TRUE(player.equal);
    EXPECT_EQ(player.ticks, report->ticks);
  }
  // All of the attacks reach their targets.
  EXPECT_GT(report->socket.forged, 15U);
  EXPECT_GT(report->socket.oversized, 15U);
  EXPECT_GT(report->socket.repeated_connects, 15U);
  EXPECT_GT(report->socket.crowded, 15U);
  EXPECT_GT(report->socket.limited, 15U);
  EXPECT_GT(report->security.handshakes_refused, 15U);
  EXPECT_GT(report->security.handshakes_replaced, 5U);
  EXPECT_GT(report->attacks[9].admitted, 0U);
}

// The siege can be lost: one address takes places that players or visitors want, where it may.
TEST(Siege, IsLostWhereOneAddressMayShutTheDoor) {
  SiegeOptions options = short_siege();
  options.max_connections = 8;
  options.patience_us = 5'500'000;
  options.strangers_per_address = 64;
  const auto report = run_siege(options);
  if (!report) GTEST_SKIP() << "no libsodium";
  EXPECT_FALSE(report->withstood());
}

SiegeReport of_one_honest_player() {
  SiegeReport report;
  report.attacks.resize(4);
  report.traitor_dropped = report.liar_expelled = true;
  report.visitors = report.visitors_seated = 25;
  report.ticks = 60;
  report.honest.resize(1);
  report.honest[0].ticks = 60;
  report.honest[0].equal = true;
  report.honest[0].state = net::ClientState::finished;
  return report;
}

TEST(Siege, IsLostWhenAnHonestInputWasReplaced) {
  SiegeReport report = of_one_honest_player();
  EXPECT_TRUE(report.withstood());
  report.honest[0].substituted = 1;
  EXPECT_FALSE(report.withstood());
}

TEST(Siege, IsLostWhenAnHonestPlayerWasRefused) {
  SiegeReport report = of_one_honest_player();
  report.honest[0].state = net::ClientState::refused;
  EXPECT_FALSE(report.withstood());
}

TEST(Siege, IsLostWhenAVisitorWasNotLetIn) {
  SiegeReport report = of_one_honest_player();
  report.visitors_seated = 24;
  EXPECT_FALSE(report.withstood());
}

TEST(Siege, IsLostWhenTheServerStalled) {
  SiegeReport report = of_one_honest_player();
  report.server_stalls = 1;
  EXPECT_FALSE(report.withstood());
}

TEST(Siege, IsLostWhenALiarOrAFloodWentOn) {
  SiegeReport report = of_one_honest_player();
  report.liar_expelled = false;
  EXPECT_FALSE(report.withstood());
  report = of_one_honest_player();
  report.traitor_dropped = false;
  EXPECT_FALSE(report.withstood());
}

TEST(Siege, IsLostWhenATokenOpensMoreThanTheRulesSay) {
  SiegeReport report = of_one_honest_player();
  report.attacks[3].entitled = report.attacks[3].admitted = 11;
  EXPECT_TRUE(report.withstood());
  report.attacks[3].admitted = 12;
  EXPECT_FALSE(report.withstood());
}

TEST(Siege, IsLostWhenAStrangerWasAnswered) {
  for (std::size_t i = 0; i < 3; ++i) {
    SiegeReport report = of_one_honest_player();
    report.attacks[i].answered = 1;
    EXPECT_FALSE(report.withstood()) << i;
  }
}

TEST(DatagramRate, EveryKindReachesTheServer) {
  const auto rates = measure_rates(64);
  if (!rates) GTEST_SKIP() << "no libsodium";
  ASSERT_EQ(rates->size(), 6U);
  for (const DatagramRate& rate : *rates)
    EXPECT_EQ(rate.datagrams, 64U) << rate.name;
  // The last two reach ENet.
  EXPECT_EQ((*rates)[4].name, "lowest again");
  EXPECT_EQ((*rates)[5].name, "lowest fragment again");
  for (std::size_t i = 0; i < rates->size(); ++i)
    EXPECT_EQ((*rates)[i].kept_out, i < 4 ? 64U : 0U) << (*rates)[i].name;
}

// The same requests take places where the door is open: the check above can fail.
TEST(Siege, ForgedConnectsAreAnsweredWhereThereIsNoKey) {
  const auto server = std::move(net::EnetTransport::listen({})).value();
  net::Random random(1);
  unsigned answered = 0;
  for (int i = 0; i < 8; ++i) {
    // Each from an address of its own.
    const auto number = static_cast<std::uint32_t>(i);
    const auto socket = UdpSocket::open({0x7f000001 + number, 0}).value();
    std::vector<std::byte> bytes = connect_datagram(random, true);
    const net::Word sum = net::LinkChecksum(std::nullopt).of(bytes);
    std::copy(sum.begin(), sum.end(), bytes.begin() + 4);
    EXPECT_TRUE(socket->send(Endpoint::loopback(server->port()), bytes));
    net::TransportEvent event;
    std::array<std::byte, 2048> buffer{};
    Endpoint from;
    test::await([&] {
      EXPECT_FALSE(server->poll(i, event));
      return socket->receive(from, buffer).has_value();
    });
    ++answered;
  }
  EXPECT_EQ(answered, 8U);
  EXPECT_EQ(server->counters().forged, 0U);
}

}  // namespace
}  // namespace lockstone::relay
