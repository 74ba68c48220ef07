// The rows of `lockstone bench stability`, in a short form; the long one is run on demand.
#include "tools/bench/stability/stability.h"

#include <gtest/gtest.h>

namespace lockstone::bench {
namespace {

struct Short {
  const char* row;
  double seconds;
};

class StableRow : public ::testing::TestWithParam<Short> {};

TEST_P(StableRow, StaysWithinItsBounds) {
  const StabilityRow* row = find_stability_row(GetParam().row);
  ASSERT_NE(row, nullptr);
  const StabilityResult result = run_stability_row(*row, {GetParam().seconds});
  EXPECT_GT(result.ticks, 0U);
  for (const StabilityFigure& figure : result.figures)
    EXPECT_TRUE(figure.met()) << figure.name << " " << figure.value << " " << figure.unit
                              << ", bound " << figure.bound;
}

INSTANTIATE_TEST_SUITE_P(Stability, StableRow,
                         ::testing::Values(Short{"stack-10", 4}, Short{"sizes", 3},
                                           Short{"overlap", 3}, Short{"mixed", 2}, Short{"spin", 2},
                                           Short{"edge", 3}, Short{"chain-100", 0.5},
                                           Short{"loops", 1}, Short{"contradictions", 2},
                                           Short{"stack-10-asleep", 4}, Short{"saturation", 3},
                                           Short{"flakes", 2}, Short{"worn-mesh", 2},
                                           Short{"rebuilt", 2}),
                         [](const auto& name) {
                           std::string text = name.param.row;
                           std::erase(text, '-');
                           return text;
                         });

TEST(Stability, KnowsItsRowsByName) {
  EXPECT_EQ(find_stability_row("tea"), nullptr);
  for (const StabilityRow& row : stability_rows())
    EXPECT_EQ(find_stability_row(row.name), &row);
}

TEST(StabilityFigure, IsMissedBeyondItsBound) {
  StabilityFigure figure{"speed", "m/s", 2, 2};
  EXPECT_TRUE(figure.met());
  figure.value = 2.1;
  EXPECT_FALSE(figure.met());
}

}  // namespace
}  // namespace lockstone::bench
