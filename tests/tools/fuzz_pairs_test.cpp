// The fuzzer of shape pairs: a short run with a new seed, and that its checks can fail.
#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tools/fuzz/fuzz_run.h"
#include "tools/fuzz/pair_checks.h"

namespace lockstone::fuzz {
namespace {

const Figure& figure_of(const std::array<Figure, k_checks>& figures, Check check) {
  return figures[static_cast<std::size_t>(check)];
}

// What none of ten million pairs broke.
constexpr std::array k_laws{Check::flip,   Check::distance,  Check::depth,
                            Check::turned, Check::manifold,  Check::separated,
                            Check::cast,   Check::cast_miss, Check::ray_miss};

// Of a million pairs some eighty break another bound: rims that touch within micrometres, points
// beside what they are deepest in.
constexpr std::uint64_t k_pairs = 20'000;
constexpr std::uint64_t k_rare = 12;

TEST(FuzzPairs, OfARandomSeedKeepTheLaws) {
  const FuzzReport report = fuzz_pairs(
      {.seed = test::run_seed(), .first = 0, .count = k_pairs, .threads = 2, .kinds = {}});
  EXPECT_EQ(report.pairs, k_pairs);
  for (const Check check : k_laws) {
    const Figure& figure = figure_of(report.figures, check);
    EXPECT_GT(figure.count, 1000U) << text_of(check).name;
    EXPECT_EQ(figure.failures, 0U) << text_of(check).name << " of pair " << figure.worst_index;
  }
  EXPECT_LE(report.failed_pairs, k_rare);
}

TEST(FuzzPairs, GiveOneReportForAnyNumberOfThreads) {
  FuzzOptions options{.seed = 5, .first = 100, .count = 1500, .threads = 1, .kinds = {}};
  const FuzzReport one = fuzz_pairs(options);
  options.threads = 3;
  const FuzzReport three = fuzz_pairs(options);
  EXPECT_EQ(one.kinds, three.kinds);
  EXPECT_EQ(one.failed_pairs, three.failed_pairs);
  for (std::size_t i = 0; i < k_checks; ++i) {
    EXPECT_EQ(one.figures[i].count, three.figures[i].count);
    EXPECT_EQ(one.figures[i].worst, three.figures[i].worst);
    EXPECT_EQ(one.figures[i].worst_share, three.figures[i].worst_share);
    EXPECT_EQ(one.figures[i].worst_index, three.figures[i].worst_index);
  }
}

TEST(FuzzPairs, OfChosenKindsHaveNoOthers) {
  const FuzzReport report = fuzz_pairs(
      {.seed = 1, .first = 0, .count = 300, .threads = 1, .kinds = {Kind::sphere, Kind::triangle}});
  EXPECT_GT(report.kinds[0][0], 50U);
  EXPECT_GT(report.kinds[0][4], 50U);
  EXPECT_EQ(report.kinds[0][0] + report.kinds[0][4], 300U);
}

// Answers that are off by a little more than is allowed are found out.
TEST(FuzzPairs, FindWrongAnswers) {
  HullPool pool(3);
  int wrong = 0;
  for (std::uint64_t index = 0; index < 400; ++index) {
    const Pair pair = make_pair(pool, 3, index, {Kind::box, Kind::hull});
    Answers answers(pair);
    if (answers.closest.overlapping || answers.manifold.count == 0) continue;
    answers.closest.distance += Position::from_ratio(1, 10'000);
    answers.manifold.points[0].feature = ~0U;
    answers.manifold.normal = -answers.manifold.normal;
    Verdict verdict(index);
    check_distance(pair, answers, verdict);
    check_flip(pair, answers, verdict);
    EXPECT_GT(figure_of(verdict.figures(), Check::distance).failures, 0U);
    EXPECT_GT(figure_of(verdict.figures(), Check::flip).failures, 0U);
    ++wrong;
  }
  EXPECT_GT(wrong, 10);
}

}  // namespace
}  // namespace lockstone::fuzz
