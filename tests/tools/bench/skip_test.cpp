// The claims of `lockstone bench skip`, but for times.

#include "tools/bench/skip/skip.h"

#include <algorithm>

#include <gtest/gtest.h>

namespace lockstone::bench {
namespace {

// One test, because every test is a process of its own and the figures take long to measure.
TEST(Skips, HaveALineForEachClaimAndMeetTheirGoalsInCountersAndSizes) {
  const std::vector<SkipFigure> counters = measure_skips({.times = false});
  EXPECT_GE(counters.size(), 12U);
  for (const SkipFigure& figure : counters) {
    EXPECT_FALSE(figure.is_time) << figure.figure;
    EXPECT_TRUE(figure.met()) << figure.claim << ": " << figure.figure << " " << figure.value;
  }
  for (const char* claim :
       {"asleep bodies cost nothing", "one awake among 10,000 asleep",
        "no joints, no triggers, no continuous bodies", "no queries", "free-flying bodies",
        "unchanged relative transform", "spherical inertia", "snapshot"}) {
    EXPECT_GT(std::ranges::count(counters, claim, &SkipFigure::claim), 0) << claim;
  }
}

TEST(SkipFigure, IsMetOnTheRightSideOfItsGoal) {
  SkipFigure figure{};
  figure.value = 2;
  figure.goal = 1;
  EXPECT_FALSE(figure.met());
  figure.at_least = true;
  EXPECT_TRUE(figure.met());
}

}  // namespace
}  // namespace lockstone::bench
