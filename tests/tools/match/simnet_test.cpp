#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/workload.h"
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
  EXPECT_EQ(totals.matches, options.seeds);
}

// On connections with all faults but deaths: where two of four are dead, nobody has a majority.
TEST(Simnet, ALiarKeepsNobodyFromPlayingToTheEnd) {
  BatchOptions options = small_batch(80);
  options.seeds = 2;
  options.faults =
      *parse_faults("loss,burst,duplicate,reorder,delay,jitter,corrupt,truncate,skew,pause");
  for (std::size_t lie = 1; lie < k_lies; ++lie) {
    for (const net::DesyncPolicy policy : {net::DesyncPolicy::kick, net::DesyncPolicy::resync}) {
      options.lie = static_cast<Lie>(lie);
      options.policy = policy;
      options.first_seed += options.seeds;
      for (const BatchFailure& failure : play(options, Defect::none).failures) {
        ADD_FAILURE() << to_string(options.lie) << ", seed " << failure.seed << ": " << failure.what
                      << "\n  " << to_text(failure.mode);
      }
    }
  }
}

TEST(Simnet, AFieldLeftOutOfSaveIsCaughtInEveryMatch) {
  BatchOptions options = small_batch(60);
  options.ticks = 120;
  EXPECT_EQ(play(options, Defect::unsaved).failures.size(), 6U);
}

// Fast relay matches. Client 0 dies, and comes back in time, or a moment before the end, or after.
TEST(Simnet, WhoComesBackAtTheVeryEndOfAFastMatchIsTooLate) {
  BatchOptions options = small_batch(1810);
  options.seeds = 1;
  std::uint64_t in_time = 0, too_late = 0;
  constexpr std::uint32_t k_step_ms = 50 * std::min(test::k_share, 2);
  for (std::uint32_t until_ms = 5'000; until_ms < 8'500; until_ms += k_step_ms) {
    options.schedule =
        Schedule{{FaultKind::delay, 2, 0, 8'500, 23}, {FaultKind::kill, 0, 500, until_ms, 0}};
    const BatchTotals totals = play(options, Defect::none);
    for (const BatchFailure& failure : totals.failures)
      ADD_FAILURE() << failure.what << "\n  " << to_text(failure.schedule);
    EXPECT_EQ(totals.kills, 1U);
    too_late += totals.too_late;
    if (totals.too_late == 0) ++in_time;
  }
  EXPECT_GT(in_time, 0U);
  EXPECT_GT(too_late, 0U);
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
