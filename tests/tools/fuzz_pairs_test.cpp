// The fuzzer of shape pairs: a short run with a new seed, and that its checks can fail.
#include <vector>

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

const std::vector<Kind> k_without_rims{Kind::sphere, Kind::capsule,  Kind::box,
                                       Kind::hull,   Kind::triangle, Kind::half_space};

const std::vector<Kind> k_with_rims{Kind::sphere,   Kind::capsule,    Kind::box,      Kind::hull,
                                    Kind::triangle, Kind::half_space, Kind::cylinder, Kind::cone};

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
    check_pair(make_pair(pool, seed, index, k_without_rims), verdict);
    EXPECT_FALSE(verdict.failed()) << index;
  }
}

struct RimCase {
  std::uint64_t seed;
  std::uint64_t index;
  std::vector<Kind> kinds;
  Places places = Places::random;
};

void expect_no_findings(const std::vector<RimCase>& cases) {
  for (const RimCase& rim : cases) {
    HullPool pool(rim.seed);
    Verdict verdict(rim.index);
    check_pair(make_pair(pool, rim.seed, rim.index, rim.kinds, rim.places), verdict);
    EXPECT_FALSE(verdict.failed()) << rim.seed << " " << rim.index;
  }
}

// Small things in the middle of drums, and leaving them all around about as deep; a sphere beside
// the end that it is nearest to; discs of 400 m at a grain; triangles behind their front; needles
// side by side, askew; a ball on the axis of a cone; a sliver of 40 m across a cone's rim.
TEST(FuzzPairs, OfCylindersAndConesThatBrokeABoundKeepIt) {
  const std::vector<Kind> spheres{Kind::cylinder, Kind::sphere}, boxes{Kind::cylinder, Kind::box},
      hulls{Kind::cylinder, Kind::hull}, rims{Kind::cylinder, Kind::cone},
      triangles{Kind::cylinder, Kind::triangle};
  const std::vector<RimCase> cases{
      {5, 197, spheres},       {5, 280, spheres},       {5, 1736, spheres},
      {5, 2025, spheres},      {5, 5, triangles},       {5, 1317, triangles},
      {5, 165, boxes},         {5, 328, boxes},         {5, 152, hulls},
      {5, 1805, hulls},        {5, 2850, hulls},        {5, 11397, hulls},
      {5, 1150, rims},         {5, 1378, rims},         {5, 13036, rims},
      {5, 14707, rims},        {6, 1756, rims},         {6, 2286, rims},
      {5, 1241, k_with_rims},  {5, 18185, k_with_rims}, {6, 1296, k_with_rims},
      {6, 30940, k_with_rims}, {7, 39706, k_with_rims}, {8, 30498, k_with_rims},
      {8, 43199, k_with_rims}, {9, 8479, k_with_rims}};
  expect_no_findings(cases);
}

// Something small in the middle of a cone with many ways out about as short; cones one in the
// other, nearly coaxial; a disc of 69 m nearly flush with a half-space; a rim on an edge beside
// another valley; capsules deep in discs; apexes, edges and faces in special positions.
TEST(FuzzPairs, OfCylindersAndConesInSpecialPlacesThatBrokeABoundKeepIt) {
  const std::vector<Kind> rims{Kind::cylinder, Kind::cone},
      solids{Kind::cylinder, Kind::cone, Kind::hull, Kind::box, Kind::capsule, Kind::triangle},
      bounded{Kind::sphere,   Kind::capsule,  Kind::box, Kind::hull,
              Kind::triangle, Kind::cylinder, Kind::cone};
  constexpr Places special = Places::special;
  const std::vector<RimCase> cases{{51, 23681, k_with_rims},
                                   {41, 57829, k_with_rims},
                                   {31, 21661, k_with_rims},
                                   {4, 2233, k_with_rims},
                                   {6001, 5231, k_with_rims},
                                   {6001, 28836, k_with_rims},
                                   {6001, 34512, k_with_rims},
                                   {1001, 2058, rims},
                                   {1001, 12063, rims},
                                   {5000, 18837, rims},
                                   {3000, 13929, solids},
                                   {2001, 33, rims, special},
                                   {5001, 25863, rims, special},
                                   {5001, 29231, rims, special},
                                   {2001, 2413, solids, special},
                                   {3001, 3934, solids, special},
                                   {4001, 11788, solids, special},
                                   {4001, 14522, solids, special},
                                   {5001, 3143, solids, special},
                                   {5001, 12860, solids, special},
                                   {9004, 5304, bounded, special},
                                   {9012, 23255, bounded, special}};
  expect_no_findings(cases);
}

// A small triangle in the middle of a club; steep ones under a plane; needles of 470 m past a
// sliver and along a box; axes that cross; balls that hold the other; a hull with merged faces.
TEST(FuzzPairs, OfTaperedCapsulesThatBrokeABoundKeepIt) {
  const std::vector<Kind> all{
      Kind::tapered_capsule, Kind::sphere,     Kind::capsule,  Kind::box, Kind::hull,
      Kind::triangle,        Kind::half_space, Kind::cylinder, Kind::cone};
  std::vector<RimCase> cases;
  for (const std::uint64_t index : {3337U, 6542U, 12889U, 13331U, 13617U, 14604U, 16395U, 21213U,
                                    25825U, 26369U, 47330U, 51157U})
    cases.push_back({1, index, all});
  expect_no_findings(cases);
}

TEST(FuzzPairs, InSpecialPlacesKeepTheLaws) {
  const FuzzReport report = fuzz_pairs({.seed = test::run_seed(),
                                        .first = 0,
                                        .count = k_pairs / 8,
                                        .threads = 2,
                                        .kinds = {},
                                        .places = Places::special});
  for (int i = 0; i < k_checks; ++i) {
    const auto check = static_cast<Check>(i);
    const Figure& figure = figure_of(report.figures, check);
    EXPECT_EQ(figure.failures, 0U) << text_of(check).name << " of pair " << figure.worst_index;
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
