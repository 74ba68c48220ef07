// The fuzzer of shape pairs: a short run with a new seed, and that its checks can fail.
#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tools/fuzz/fuzz_run.h"
#include "tools/fuzz/pair_checks.h"

namespace lockstone::fuzz {
namespace {

const Figure& figure_of(const std::array<Figure, k_checks>& figures, Check check) {
  return figures[static_cast<std::size_t>(check)];
}

constexpr std::uint64_t k_pairs = test::share_of(20'000);

TEST(FuzzPairs, OfARandomSeedKeepTheLaws) {
  const FuzzReport report = fuzz_pairs(
      {.seed = test::run_seed(), .first = 0, .count = k_pairs, .threads = 2, .kinds = {}});
  EXPECT_EQ(report.pairs, k_pairs);
  for (int i = 0; i < k_checks; ++i) {
    const auto check = static_cast<Check>(i);
    const Figure& figure = figure_of(report.figures, check);
    EXPECT_GT(figure.count, test::share_of(1000U)) << text_of(check).name;
    EXPECT_EQ(figure.failures, 0U) << text_of(check).name << " of pair " << figure.worst_index;
  }
}

// Those of ten million that once broke a bound: normals of other features than the points, deepest
// points at the wrong vertices of slivers, corners moved onto many sides, boxes that are not quite
// square, edges taken for four times the depth, and a way out through 240 m (8313088).
TEST(FuzzPairs, ThatBrokeABoundKeepIt) {
  constexpr std::uint64_t seed = 20261121;
  HullPool pool(seed);
  for (const std::uint64_t index : {281954U, 1124006U, 1764039U, 2323353U, 3752046U, 6170449U,
                                    6882126U, 7015749U, 7139934U, 8313088U, 8653509U, 8689195U}) {
    Verdict verdict(index);
    check_pair(make_pair(pool, seed, index, all_kinds()), verdict);
    EXPECT_FALSE(verdict.failed()) << index;
  }
}

TEST(FuzzPairs, GiveOneReportForAnyNumberOfThreads) {
  FuzzOptions options{
      .seed = 5, .first = 100, .count = test::share_of(1500), .threads = 1, .kinds = {}};
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

// The checks find results that are off by a little more than their bound.
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
