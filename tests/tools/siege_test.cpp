#include "tools/relay/siege.h"

#include <gtest/gtest.h>

namespace lockstone::relay {
namespace {

TEST(Siege, IsWithstood) {
  SiegeOptions options;
  options.honest = 2;
  options.duration_us = 900'000;
  options.limits.packets_per_second = 100;  // so that the flood is one at once
  options.flood_per_second = 6000;
  const auto report = run_siege(options);
  if (!report) GTEST_SKIP() << "no libsodium";
  EXPECT_TRUE(report->withstood());
  ASSERT_EQ(report->attacks.size(), 5U);
  for (const AttackReport& attack : report->attacks) {
    EXPECT_GT(attack.sent, 2U) << attack.name;
    EXPECT_EQ(attack.admitted, 0U) << attack.name;
  }
  EXPECT_GT(report->attacks[0].sent, 64U);
  EXPECT_EQ(report->attacks[0].answered, 0U);
  EXPECT_EQ(report->attacks[1].answered, 0U);
  EXPECT_TRUE(report->traitor_dropped);
  EXPECT_EQ(report->traitor.leave_reason, net::LeaveReason::left);
  EXPECT_GT(report->socket.forged, 32U);
  EXPECT_GT(report->socket.repeated_connects, 32U);
  EXPECT_GT(report->security.handshakes_refused, 2U);
  for (const PlayerOutcome& player : report->honest) {
    EXPECT_TRUE(player.equal);
    EXPECT_EQ(player.ticks, report->ticks);
  }
}

}  // namespace
}  // namespace lockstone::relay
