#include "core/dynamics/step/islands/effort_policy.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/step/input/contact_params.h"
#include "core/dynamics/step/islands/island_lists.h"
#include "tests/dynamics/tick_scene.h"

namespace lockstone {
namespace {

EffortPolicy policy(std::size_t contacts) {
  return {TimeStep::of(60, 4), contacts};
}

// This many bodies are stirred by more than 1/4 m/s, and none by more than 1/2.
void stir(IslandTally& island, std::uint32_t bodies) {
  island.motion.stirred = {bodies, bodies, bodies};
}

// Bodies on the ground, each against the next, that go to and fro, with velocities in sixteenths of
// a metre a second. One at an end may be 128 times as heavy as the others.
int stir_level_of_row(const std::vector<int>& sixteenths, bool has_heavy_end = false) {
  TickScene scene;
  std::uint32_t last = scene.add_body(k_static);
  for (const int x : sixteenths) {
    const std::uint32_t body = scene.add_body(k_dynamic);
    scene.body(body).inverse_mass = 1 << 30;
    if (has_heavy_end && body == 1) scene.body(body).inverse_mass_exponent = -7;
    scene.body(body).velocity.x = Velocity::from_ratio(x, 16);
    scene.add_contact(last, body);
    last = body;
  }
  scene.gather();
  scene.islands.build(scene.get(), scene.bodies, scene.contacts);
  const TickJoints joints(TimeStep::of(60, 4), TickScene::k_capacity, TickScene::k_capacity,
                          TickScene::k_capacity, true, scene.bodies);
  EffortPolicy::mark_iterated(scene.get(), scene.bodies, scene.contacts, joints, scene.islands);
  IslandLists lists(TickScene::k_capacity, TickScene::k_capacity, TickScene::k_capacity);
  lists.build(scene.get(), scene.bodies, scene.contacts, scene.islands);
  EffortPolicy::mark_stirred(scene.get(), scene.bodies, scene.islands);
  return EffortPolicy::stir_level(scene.islands.tally(scene.contacts[{0}]));
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
  stir(island, 25);
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
  stir(island, 26);
  EXPECT_TRUE(EffortPolicy::is_loose_pile(island));
  stir(island, 0);
  island.loose = 51;
  EXPECT_TRUE(EffortPolicy::is_loose_pile(island));
  island.loose = 50;
  EXPECT_FALSE(EffortPolicy::is_loose_pile(island));
}

TEST(EffortPolicy, CallsAnIslandAsStirredAsMoreThanAQuarterOfItsBodiesAre) {
  EXPECT_EQ(stir_level_of_row({0, 0, 0, 0}), 0);
  EXPECT_EQ(stir_level_of_row({1, -1, 1, -1}), 0);
  EXPECT_EQ(stir_level_of_row({2, -2, 2, -2}), 1);
  EXPECT_EQ(stir_level_of_row({4, -4, 4, -4}), 2);
  EXPECT_EQ(stir_level_of_row({5, -5, 5, -5}), 3);
  EXPECT_EQ(stir_level_of_row({32, -32, 32, -32}), 5);
  EXPECT_EQ(stir_level_of_row({1000, -1000}), 6);
  // All at one speed, or one of four alone.
  EXPECT_EQ(stir_level_of_row({900, 900, 900, 900}), 0);
  EXPECT_EQ(stir_level_of_row({6, -2, -2, -2}), 1);
  EXPECT_EQ(stir_level_of_row({6, 6, -6, -6}), 3);
}

TEST(EffortPolicy, CallsNoIslandOfUnevenMassesStirred) {
  EXPECT_EQ(stir_level_of_row({32, -32, 32, -32}, false), 5);
  EXPECT_EQ(stir_level_of_row({32, -32, 32, -32}, true), 0);
}

TEST(EffortPolicy, KeepsAPileLooseForFourSecondsAfterItWasStirred) {
  IslandTally stirred, calm, tight;
  stirred.bodies = calm.bodies = 100;
  stir(stirred, 50);
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

// A converged island of this many bodies after a tick of eight phases.
bool is_given_up(std::uint32_t bodies, std::uint32_t products, std::uint32_t unsolved) {
  IslandTally island;
  island.bodies = bodies;
  island.is_converged = true;
  IslandState state;
  state.unsolved = unsolved;
  BodyFactor::Plan plan;
  plan.products = products;
  return policy(1024).gives_up(island, {state, plan, {}, {}, {}, {}, {}, {}, {}, {}, {}});
}

TEST(EffortPolicy, GivesUpALargeIslandOfWhichATickLeavesHalfUnsolved) {
  EXPECT_TRUE(is_given_up(100, 4097, 4));
  EXPECT_FALSE(is_given_up(100, 4097, 3));
  EXPECT_FALSE(is_given_up(100, 4096, 8));
  EXPECT_FALSE(is_given_up(23, 40000, 8));
}

TEST(EffortPolicy, IteratesAnIslandThatIsGivenUpAsALoosePile) {
  IslandTally given_up, stirred;
  given_up.bodies = stirred.bodies = 100;
  given_up.is_given_up = stirred.is_loose = true;
  stir(stirred, 50);
  const BodyRecord body;
  const TimeStep step = TimeStep::of(60, 4);
  EXPECT_GT(EffortPolicy::loose_time(given_up, body, step, 0), 0);
  EXPECT_EQ(EffortPolicy::loose_time(given_up, body, step, 0),
            EffortPolicy::loose_time(stirred, body, step, 0));
}

TEST(EffortPolicy, CallsNoIslandWithoutJointsLooseThatIsSmallOrUneven) {
  IslandTally island;
  island.bodies = 24;
  stir(island, 24);
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
  island.bodies = 8;
  stir(island, 8);
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

TEST(EffortPolicy, ConvergesNoIslandThatIterationsHold) {
  IslandTally island;
  island.bodies = island.contacts = island.slow = 10;
  EXPECT_TRUE(policy(100).may_converge(island));
  island.keeps_pose = true;
  EXPECT_FALSE(policy(100).may_converge(island));
  --island.slow;
  EXPECT_TRUE(policy(100).may_converge(island));
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
