#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include "net/transport/enet_datagram.h"
#include "tests/support/await.h"
#include "tools/relay/attacks.h"

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
  EXPECT_TRUE(report->withstood());
  ASSERT_EQ(report->attacks.size(), 5U);
  for (const AttackReport& attack : report->attacks) {
    EXPECT_GE(attack.sent, 66U) << attack.name;
    EXPECT_EQ(attack.admitted, 0U) << attack.name;
  }
  EXPECT_EQ(report->attacks[0].answered, 0U);
  EXPECT_EQ(report->attacks[1].answered, 0U);
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
