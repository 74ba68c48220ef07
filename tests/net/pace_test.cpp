#include <gtest/gtest.h>

#include "net/session/lead_control.h"
#include "net/session/playout_clock.h"
#include "net/transport/random.h"
#include "tests/net/match_fixture.h"

namespace lockstone::net::test {
namespace {

TEST(LeadControl, RisesAtOnceWhenLateTwiceWithin60Ticks) {
  LeadControl lead(16);
  lead.note(-3, 100, 104, 0);
  EXPECT_EQ(lead.lead_ticks(), 0U);
  lead.note(8, 101, 105, 0);
  lead.note(-5, 150, 154, 0);
  EXPECT_EQ(lead.lead_ticks(), 2U);
}

TEST(LeadControl, StaysWhenLateOnceIn60Ticks) {
  LeadControl lead(16);
  for (std::uint64_t tick = 100; tick < 1000; tick += 61)
    lead.note(-3, tick, tick + 4, 0);
  EXPECT_EQ(lead.lead_ticks(), 0U);
}

TEST(LeadControl, DoesNotRiseAgainBeforeTheRiseShows) {
  LeadControl lead(16);
  for (std::uint64_t tick = 100; tick < 120; ++tick)
    lead.note(-8, tick, tick + 30, 0);
  EXPECT_EQ(lead.lead_ticks(), 2U);
}

TEST(LeadControl, NeverExceedsItsMost) {
  LeadControl lead(5);
  for (std::uint64_t tick = 0; tick < 1000; ++tick)
    lead.note(-127, tick, tick, 0);
  EXPECT_EQ(lead.lead_ticks(), 5U);
}

TEST(LeadControl, FallsByOnePer3SecondsWithTimeToSpare) {
  LeadControl lead(16);
  lead.note(-20, 1, 1, 0);
  lead.note(-20, 2, 2, 0);
  EXPECT_EQ(lead.lead_ticks(), 5U);
  for (std::int64_t second = 1; second <= 10; ++second)
    lead.note(12, 100 + static_cast<std::uint64_t>(second), 200, second * k_second_us);
  EXPECT_EQ(lead.lead_ticks(), 2U);
  for (std::int64_t second = 11; second <= 20; ++second)
    lead.note(7, 100 + static_cast<std::uint64_t>(second), 200, second * k_second_us);
  EXPECT_EQ(lead.lead_ticks(), 2U);
}

TEST(LeadControl, TrimsTheClockByNoMoreThan5Percent) {
  LeadControl lead(0);
  lead.note(-127, 1, 1, 0);
  EXPECT_EQ(lead.trim_ppm(), 50'000);
  lead.note(127, 2, 2, 0);
  EXPECT_EQ(lead.trim_ppm(), -50'000);
  lead.note(6, 3, 3, 0);
  EXPECT_EQ(lead.trim_ppm(), 0);
}

TEST(PlayoutClock, HasNoDepthWithoutJitter) {
  PlayoutClock clock(60);
  for (std::uint64_t tick = 0; tick < 200; ++tick)
    clock.arrived(tick, 5000 + static_cast<std::int64_t>(tick * 1'000'000 / 60));
  EXPECT_EQ(clock.depth_us(), 0);
  EXPECT_TRUE(clock.due(199, 5000 + 199 * 1'000'000 / 60));
  EXPECT_FALSE(clock.due(200, 5000 + 199 * 1'000'000 / 60));
}

TEST(PlayoutClock, FollowsThe99thPercentileOfJitter) {
  Random random(3);
  PlayoutClock clock(60);
  for (std::uint64_t tick = 0; tick < 128; ++tick) {
    const bool outlier = tick == 50;
    const auto late_us = outlier ? 200'000 : static_cast<std::int64_t>(random.below(20'001));
    clock.arrived(tick, static_cast<std::int64_t>(tick * 1'000'000 / 60) + late_us);
  }
  EXPECT_GT(clock.depth_us(), 18'000);
  EXPECT_LE(clock.depth_us(), 20'000);
}

TEST(PlayoutClock, DepthIsBounded) {
  PlayoutClock clock(60);
  for (std::uint64_t tick = 0; tick < 128; ++tick)
    clock.arrived(tick, tick % 2 == 0 ? 0 : 10 * k_second_us);
  EXPECT_EQ(clock.depth_us(), PlayoutClock::k_max_depth_us);
}

TEST(Pace, LeadGrowsUntilInputsComeInTime) {
  MatchOptions options;
  options.toy.player_count = 2;
  options.server.tick_count = 900;
  options.server.input_delay_ticks = 1;
  options.faults.delay_us = 60'000;
  Match match(options);
  ASSERT_TRUE(match.run(30 * k_second_us));
  EXPECT_LT(match.server->stats(0).substituted_inputs, 40U);
  EXPECT_EQ(match.players[0].log->replaced.size(), match.server->stats(0).substituted_inputs);
  const std::vector<SeenTick>& ticks = match.server_log.seen.ticks;
  for (std::size_t tick = 300; tick < 900; ++tick)
    EXPECT_EQ(ticks[tick].origins[0], InputOrigin::received) << "tick " << tick;
  match.expect_all_equal();
}

TEST(Pace, OneSlowPlayerCostsTheOthersNothing) {
  MatchOptions options;
  options.toy.player_count = 3;
  options.server.tick_count = 600;
  Match match(options);
  match.network.set_faults(*match.players[2].transport,
                           {.loss_ppm = 300'000, .delay_us = 250'000, .jitter_us = 100'000});
  ASSERT_TRUE(match.run(60 * k_second_us));
  EXPECT_LT(match.now_us, 14 * k_second_us);
  EXPECT_EQ(match.server->stats(0).substituted_inputs, 0U);
  EXPECT_EQ(match.server->stats(1).substituted_inputs, 0U);
  EXPECT_GT(match.server->stats(2).substituted_inputs, 0U);
  match.expect_all_equal();
}

}  // namespace
}  // namespace lockstone::net::test
