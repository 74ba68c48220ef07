#include "core/dynamics/step/islands/effort_policy.h"

#include <gtest/gtest.h>

#include "core/dynamics/step/input/contact_params.h"

namespace lockstone {
namespace {

EffortPolicy policy(std::size_t contacts) {
  return {TimeStep::of(60, 4), contacts};
}

TEST(EffortPolicy, ConvergesIslandsUpToItsSize) {
  const EffortPolicy effort = policy(100);
  IslandTally island;
  island.bodies = 10;
  EXPECT_FALSE(effort.may_converge(island));  // no contacts: joints alone do it
  island.contacts = 60;
  island.joints = 40;
  EXPECT_TRUE(effort.may_converge(island));
  ++island.joints;
  EXPECT_FALSE(effort.may_converge(island));
}

TEST(EffortPolicy, ConvergesNeitherPinchedIslandsNorThoseLeftToIterations) {
  const EffortPolicy effort = policy(100);
  IslandTally island;
  island.bodies = island.contacts = 1;
  EXPECT_TRUE(effort.may_converge(island));
  island.is_pinched = true;
  EXPECT_FALSE(effort.may_converge(island));
  island.is_pinched = false;
  island.iterates_only = true;
  EXPECT_FALSE(effort.may_converge(island));
}

TEST(EffortPolicy, CallsAPileLooseFromWhenAQuarterIsStirredUntilHalfIsNot) {
  IslandTally island;
  island.bodies = 100;
  island.stirred = 25;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
  island.stirred = 26;
  EXPECT_TRUE(EffortPolicy::is_loose_pile(island));
  island.stirred = 0;
  island.loose = 51;
  EXPECT_TRUE(EffortPolicy::is_loose_pile(island));
  island.loose = 50;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
}

TEST(EffortPolicy, KeepsAPileLooseForFourSecondsAfterItWasStirred) {
  IslandTally stirred, calm, tight;
  stirred.bodies = calm.bodies = 100;
  stirred.stirred = 50;
  stirred.is_loose = calm.is_loose = true;
  for (const int rate : {10, 60, 120, 480}) {
    const TimeStep step = TimeStep::of(rate, 4);
    BodyRecord body;
    body.loose_time = EffortPolicy::loose_time(stirred, body, step, 7);
    std::uint64_t ticks = 0;
    for (; body.loose_time > 0; ++ticks)
      body.loose_time = EffortPolicy::loose_time(calm, body, step, ticks);
    EXPECT_NEAR(static_cast<double>(ticks), 4.0 * rate, rate / 60.0) << rate;
    body.loose_time = 100;
    EXPECT_EQ(EffortPolicy::loose_time(tight, body, step, 0), 0);
    IslandTally jointed = calm;
    jointed.joints = 1;
    EXPECT_EQ(EffortPolicy::loose_time(jointed, body, step, 0),
              EffortPolicy::loose_time(stirred, body, step, 0));
  }
}

TEST(EffortPolicy, CallsNoIslandWithoutJointsLooseThatIsSmallOrUneven) {
  IslandTally island;
  island.bodies = island.stirred = 24;
  EXPECT_TRUE(EffortPolicy::is_loose_pile(island));
  --island.bodies;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
  island.bodies = 100;
  island.least_share = (1 << 30) / 16 - 1;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
}

TEST(EffortPolicy, CallsNoIslandWithJointsLooseThatIsSmallUnevenOrCarried) {
  IslandTally island;
  island.joints = 1;
  island.bodies = island.stirred = 8;
  island.least_share = (1 << 30) / 32;
  EXPECT_TRUE(EffortPolicy::is_loose_pile(island));
  --island.least_share;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
  ++island.least_share;
  island.is_carried = true;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
  island.is_carried = false;
  --island.bodies;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
}

TEST(EffortPolicy, ConvergesNoLoosePile) {
  IslandTally island;
  island.bodies = island.contacts = 30;
  EXPECT_TRUE(policy(100).may_converge(island));
  island.is_loose = true;
  EXPECT_FALSE(policy(100).may_converge(island));
}

TEST(EffortPolicy, ConvergesNoneWhereTheWorldAllowsNone) {
  EXPECT_EQ(policy(0).most_island_contacts(), 0U);
  EXPECT_EQ(policy(1000000).most_island_contacts(), 1024U);
}

TEST(EffortPolicy, CallsAContactBearingAtTwoAndAHalfWeights) {
  EffortPolicy effort = policy(0);
  effort.begin({{}, Acceleration::from_ratio(-10, 1), {}});
  // Between equal masses a weight is a jump of 2·g·h: 5·g·h is 2½ of them.
  EXPECT_EQ(effort.bearing_impulse(), raw::round_divide(std::int64_t{50} << 20, 240));
  effort.begin({});
  EXPECT_EQ(effort.bearing_impulse(), INT64_MAX);
}

TEST(ContactParams, DitherHasNoMean) {
  const lanes::SolverParams params = solver_params(TimeStep::of(60, 4));
  std::int64_t limits = 0, parts = 0;
  constexpr int k_count = 1 << 12;
  for (std::uint32_t i = 0; i < k_count; ++i) {
    limits += dithered(params, i).limit_dither;
    parts += dithered(params, i).part_dither;
  }
  EXPECT_LT(std::abs(limits / k_count), 1 << 18);  // of a step of 2^30
  EXPECT_LT(std::abs(parts / k_count), 1 << 18);
}

TEST(ContactParams, GiveTheSubstepToThirtyBits) {
  for (const int rate : {30, 60, 64, 128}) {
    const lanes::SolverParams params = solver_params(TimeStep::of(rate, 4));
    const std::int64_t whole = std::int64_t{params.step_mantissa} * params.substep_rate;
    const std::int64_t one = std::int64_t{1} << (7 + params.step_shift);
    EXPECT_LT(std::abs(whole - one), params.substep_rate);
  }
}

}  // namespace
}  // namespace lockstone
