#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "net/transport/enet_datagram.h"
#include "tests/support/await.h"
#include "tools/relay/attacks.h"
#include "tools/relay/datagram_rate.h"

namespace lockstone::relay {
namespace {

TEST(Siege, IsWithstood) {
  SiegeOptions options;
  options.honest = 2;
  options.duration_us = 500'000;
  options.least_sent = 66;
  options.limits.packets_per_second = 100;  // so that the flood is one at once
  options.flood_per_second = 6000;
  const auto report = run_siege(options);
  if (!report) GTEST_SKIP() << "no libsodium";
  // A busy machine delays inputs by itself: whether any was replaced is not asked here.
  SiegeReport but_for_delays = *report;
  for (PlayerOutcome& player : but_for_delays.honest)
    player.substituted = 0;
  EXPECT_TRUE(but_for_delays.withstood());
  ASSERT_EQ(report->attacks.size(), 6U);
  for (const AttackReport& attack : report->attacks) {
    EXPECT_GE(attack.sent, 66U) << attack.name;
    EXPECT_EQ(attack.admitted, 0U) << attack.name;
  }
  EXPECT_EQ(report->attacks[0].answered, 0U);
  EXPECT_EQ(report->attacks[1].answered, 0U);
  EXPECT_EQ(report->attacks[2].answered, 0U);
  EXPECT_GT(report->socket.oversized, 32U);
  EXPECT_TRUE(report->traitor_dropped);
  EXPECT_EQ(report->traitor.leave_reason, net::LeaveReason::left);
  EXPECT_GT(report->socket.forged, 31U);
  EXPECT_GT(report->socket.repeated_connects, 32U);
  EXPECT_GT(report->security.handshakes_refused, 32U);
  for (const PlayerOutcome& player : report->honest) {
    EXPECT_TRUE(player.equal);
    EXPECT_EQ(player.ticks, report->ticks);
  }
}

SiegeReport of_one_honest_player() {
  SiegeReport report;
  report.attacks.resize(3);
  report.traitor_dropped = true;
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
  ASSERT_EQ(rates->size(), 5U);
  for (const DatagramRate& rate : *rates)
    EXPECT_EQ(rate.datagrams, 64U) << rate.name;
  EXPECT_EQ(rates->back().name, "lowest again");
  EXPECT_EQ(rates->back().kept_out, 0U) << "this one reaches ENet";
  for (std::size_t i = 0; i + 1 < rates->size(); ++i)
    EXPECT_EQ((*rates)[i].kept_out, 64U) << (*rates)[i].name;
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
