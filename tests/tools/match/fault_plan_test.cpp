#include "tools/simnet/fault_plan.h"

#include <gtest/gtest.h>

namespace lockstone::simnet {
namespace {

TEST(FaultPlan, TellsOfEachEventWhenItBeginsAndWhenItEnds) {
  const Schedule schedule = *parse_schedule("loss@1:1000-2000=5000,pause@0:1500-1600=0");
  FaultPlan plan(schedule, 1);
  std::vector<std::pair<FaultKind, bool>> seen;
  const auto note = [&](const FaultEvent& event, bool active) {
    seen.emplace_back(event.kind, active);
  };
  EXPECT_FALSE(plan.advance(1'500'000, note)) << "the match has not begun";
  plan.begin(10'000'000);
  EXPECT_FALSE(plan.advance(10'900'000, note));
  EXPECT_TRUE(plan.advance(11'000'000, note));
  EXPECT_EQ(plan.faults_of(1).loss_ppm, 5000U);
  EXPECT_EQ(plan.faults_of(0).loss_ppm, 0U);
  EXPECT_TRUE(plan.advance(11'500'000, note));
  EXPECT_TRUE(plan.advance(12'000'000, note));
  EXPECT_EQ(plan.faults_of(1).loss_ppm, 0U);
  EXPECT_EQ(seen, (std::vector<std::pair<FaultKind, bool>>{{FaultKind::loss, true},
                                                           {FaultKind::pause, true},
                                                           {FaultKind::loss, false},
                                                           {FaultKind::pause, false}}));
}

TEST(FaultPlan, KnowsHowLongAClientIsDead) {
  const Schedule schedule = *parse_schedule("kill@2:1000-3000=0");
  FaultPlan plan(schedule, 1);
  plan.begin(0);
  EXPECT_EQ(plan.dead_until_us(2), 0);
  plan.advance(1'000'000, [](const FaultEvent&, bool) {});
  EXPECT_EQ(plan.dead_until_us(2), 3'000'000);
  EXPECT_EQ(plan.dead_until_us(1), 0);
}

TEST(FaultPlan, ForgesPacketsOnlyWhileThatFaultIsActive) {
  const Schedule schedule = *parse_schedule("forge@0:0-1000=200");
  FaultPlan plan(schedule, 1);
  unsigned forged = 0;
  const auto count = [&](std::size_t client, ByteView bytes) {
    EXPECT_EQ(client, 0U);
    EXPECT_FALSE(bytes.empty());
    ++forged;
  };
  plan.begin(0);
  plan.forge_packets(4'000, 1, count);
  EXPECT_EQ(forged, 0U);
  plan.advance(0, [](const FaultEvent&, bool) {});
  for (int i = 0; i < 250; ++i)
    plan.forge_packets(4'000, 1, count);
  EXPECT_GT(forged, 100U) << "about 200 a second";
  EXPECT_LT(forged, 240U);
}

}  // namespace
}  // namespace lockstone::simnet
