#include "core/dynamics/islands/tick_islands.h"

#include <gtest/gtest.h>

namespace lockstone {
namespace {

TickIslands islands_of(std::uint32_t bodies) {
  TickIslands islands(bodies + 1, bodies);
  islands.clear();
  for (std::uint32_t i = 0; i < bodies; ++i)
    islands.add_body(true);
  return islands;
}

TEST(TickIslands, AreNumberedInTheOrderOfTheirFirstBodies) {
  TickIslands islands = islands_of(6);
  islands.join(6, 2);
  islands.join(5, 3);
  islands.join(3, 6);
  islands.settle();
  EXPECT_EQ(islands.of(1), 1U);
  for (const std::uint32_t body : {2U, 3U, 5U, 6U})
    EXPECT_EQ(islands.of(body), 2U);
  EXPECT_EQ(islands.of(4), 3U);
}

TEST(TickIslands, LeaveOutBodiesThatAreNotDynamic) {
  TickIslands islands(4, 2);
  islands.clear();
  islands.add_body(true);
  islands.add_body(false);
  islands.add_body(true);
  islands.settle();
  EXPECT_EQ(islands.of(1), 1U);
  EXPECT_EQ(islands.of(2), 0U);
  EXPECT_EQ(islands.of(3), 2U);
}

TEST(TickIslands, ForgetTheTickBefore) {
  TickIslands islands = islands_of(2);
  islands.join(1, 2);
  islands.settle();
  islands.tally(islands.of(1)).contacts = 7;
  islands.clear();
  islands.add_body(true);
  islands.add_body(true);
  islands.settle();
  EXPECT_NE(islands.of(1), islands.of(2));
  EXPECT_EQ(islands.tally(islands.of(1)).contacts, 0U);
}

TEST(IslandTally, HasFewLoadsUpToItsBudget) {
  IslandTally tally;
  for (std::uint32_t i = 0; i < IslandTally::k_most_overloaded; ++i)
    tally.overloaded.raise();
  EXPECT_TRUE(tally.few_are_overloaded());
  tally.overloaded.raise();
  EXPECT_FALSE(tally.few_are_overloaded());
}

TEST(IslandTally, IsAStackBeyondItsBudgetOfBearingContacts) {
  IslandTally tally{.bearing = IslandTally::k_most_bearing, .overloaded = 0};
  EXPECT_FALSE(tally.is_stack());
  ++tally.bearing;
  EXPECT_TRUE(tally.is_stack());
  tally.is_converged = true;
  EXPECT_FALSE(tally.is_stack());
}

TEST(IslandTally, NeedsAnInitialWarmStartWhereManyAreOverloadedAndAQuarterIsNew) {
  IslandTally tally{.contacts = 1000, .fresh = 250, .bearing = 0, .overloaded = 200};
  EXPECT_TRUE(tally.needs_initial_warm_start());
  tally.fresh = 249;
  EXPECT_FALSE(tally.needs_initial_warm_start());
  tally = {
      .contacts = 1000, .fresh = 250, .bearing = 0, .overloaded = IslandTally::k_most_overloaded};
  EXPECT_FALSE(tally.needs_initial_warm_start());
}

}  // namespace
}  // namespace lockstone
