#include <gtest/gtest.h>

#include "tools/simnet/batch.h"
#include "tools/simnet/shrink.h"
#include "tools/simnet/toy_game.h"

namespace lockstone::simnet {
namespace {

BatchOptions small_batch(std::uint64_t first_seed) {
  BatchOptions options;
  options.first_seed = first_seed;
  options.seeds = 6;
  options.ticks = 600;
  options.threads = 1;
  options.shrink = false;
  return options;
}

BatchTotals play(const BatchOptions& options, Defect defect) {
  return run_batch(options, [&](std::uint64_t seed, std::optional<Control>& control) {
    return make_toy_game(seed, options.clients, options.ticks, defect, control);
  });
}

TEST(Simnet, MatchesAreAsTheyMustBe) {
  const BatchTotals totals = play(small_batch(1), Defect::none);
  for (const BatchFailure& failure : totals.failures) {
    ADD_FAILURE() << "seed " << failure.seed << ": " << failure.what << "\n  "
                  << to_text(failure.schedule);
  }
  EXPECT_EQ(totals.matches, 6U);
  EXPECT_GE(totals.faults, 60U);
  EXPECT_GT(totals.comparisons, 6U * 600U);
}

TEST(Simnet, SameSeedsGiveTheSameMatchesOnAnyNumberOfThreads) {
  BatchOptions options = small_batch(20);
  options.ticks = 300;
  const BatchTotals alone = play(options, Defect::none);
  options.threads = 3;
  const BatchTotals together = play(options, Defect::none);
  EXPECT_EQ(alone.hash, together.hash);
  EXPECT_EQ(alone.client_ticks, together.client_ticks);
  EXPECT_EQ(alone.comparisons, together.comparisons);
}

TEST(Simnet, OneFlippedBitIsReportedAtItsTickBodyAndField) {
  BatchOptions options = small_batch(40);
  options.ticks = 300;
  options.faults = *parse_faults("loss,burst,duplicate,reorder,delay,jitter,corrupt,truncate,skew");
  const BatchTotals totals = play(options, Defect::flipped_bit);
  for (const BatchFailure& failure : totals.failures)
    ADD_FAILURE() << "seed " << failure.seed << ": " << failure.what;
}

TEST(Simnet, AFieldLeftOutOfSaveIsCaughtInEveryMatch) {
  BatchOptions options = small_batch(60);
  options.ticks = 120;
  EXPECT_EQ(play(options, Defect::unsaved).failures.size(), 6U);
}

// A fast relay match. Its client 0 dies, and comes back a moment before the end: no complaint.
TEST(Simnet, WhoComesBackAtTheVeryEndOfAFastMatchIsTooLate) {
  BatchOptions options = small_batch(1810);
  options.seeds = 1;
  options.ticks = 3600;
  options.schedule = parse_schedule(
      "burst@2:0-51000=22776,delay@0:7288-22660=461,delay@1:16435-47659=44,delay@2:0-51000=23,"
      "delay@3:2512-15744=38,jitter@3:1763-40948=23,cut_sending@2:13722-17722=0,"
      "kill@0:10475-22475=0");
  const BatchTotals end = play(options, Defect::none);
  EXPECT_TRUE(end.failures.empty());
  EXPECT_EQ(end.too_late, 1U);

  // The same death over earlier: it is back in and plays on.
  options.schedule->back().until_ms = 15'475;
  const BatchTotals back = play(options, Defect::none);
  EXPECT_TRUE(back.failures.empty());
  EXPECT_EQ(back.too_late, 0U);
  EXPECT_EQ(back.kills, 1U);
}

TEST(Schedule, SurvivesItsText) {
  const Schedule schedule = draw_schedule(7, k_all_faults, 4, 60'000);
  EXPECT_FALSE(schedule.empty());
  const std::optional<Schedule> again = parse_schedule(to_text(schedule));
  ASSERT_TRUE(again.has_value());
  EXPECT_EQ(*again, schedule);
  EXPECT_EQ(parse_schedule("none"), Schedule{});
  for (const char* text : {"", "loss", "loss@1:5-2=1", "loss@99:1-2=1", "love@1:1-2=1",
                           "loss@1:1-2=1,", "loss@1:1-2=1 "}) {
    EXPECT_FALSE(parse_schedule(text).has_value()) << text;
  }
}

TEST(Schedule, OneKindDrawsTheSameWithAndWithoutOthers) {
  const Schedule all = draw_schedule(7, k_all_faults, 4, 60'000);
  const Schedule delays = draw_schedule(7, *parse_faults("delay"), 4, 60'000);
  Schedule picked;
  std::copy_if(all.begin(), all.end(), std::back_inserter(picked),
               [](const FaultEvent& event) { return event.kind == FaultKind::delay; });
  EXPECT_EQ(picked, delays);
}

TEST(Schedule, ShrinksToTheEventsThatMatter) {
  const Schedule schedule = draw_schedule(9, k_all_faults, 8, 60'000);
  ASSERT_GT(schedule.size(), 20U);
  const FaultEvent first = schedule[3];
  const FaultEvent second = schedule[schedule.size() - 2];
  const auto holds = [](const Schedule& events, const FaultEvent& event) {
    return std::find(events.begin(), events.end(), event) != events.end();
  };
  const Schedule shrunk = shrink(schedule, [&](const Schedule& events) {
    return holds(events, first) && holds(events, second);
  });
  EXPECT_EQ(shrunk, (Schedule{first, second}));
}

}  // namespace
}  // namespace lockstone::simnet
