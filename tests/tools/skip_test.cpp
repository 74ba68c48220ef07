// What `lockstone bench skip` claims, but for times.

#include "tools/bench/skip/skip.h"

#include <gtest/gtest.h>

namespace lockstone::bench {
namespace {

TEST(Skips, MeetTheirGoalsInCountersAndSizes) {
  const std::vector<SkipFigure> figures = measure_skips({.times = false});
  EXPECT_GE(figures.size(), 12U);
  for (const SkipFigure& figure : figures) {
    EXPECT_FALSE(figure.is_time) << figure.figure;
    EXPECT_TRUE(figure.met()) << figure.claim << ": " << figure.figure << " " << figure.value;
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
