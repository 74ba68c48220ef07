#include "core/dynamics/contact/block_words.h"

#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/problem/proximal_words.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

TEST(SmallProductSum, RoundsAsProductSumDoes) {
  test::Random random;
  for (int i = 0; i < test::share_of(100000); ++i) {
    ProductSum sum;
    SmallProductSum small;
    for (int k = 0; k < 3; ++k) {
      const std::int64_t a = random.between(-(std::int64_t{1} << 31), std::int64_t{1} << 31);
      const std::int64_t b = random.between(-(std::int64_t{1} << 28), std::int64_t{1} << 28);
      sum.add(a, b);
      small.add(a, b);
    }
    EXPECT_EQ(small.rounded(30), sum.rounded(30));
  }
}

TEST(SmallProductSum, RoundsTiesAwayFromZero) {
  for (const std::int64_t x : {1, -1, 3, -3}) {
    ProductSum sum;
    SmallProductSum small;
    sum.add(x, std::int64_t{1} << 29);
    small.add(x, std::int64_t{1} << 29);
    EXPECT_EQ(small.rounded(30), sum.rounded(30));
  }
}

TEST(ClampAll, ClampsAtTheRangeOfUnitsAndTellsWhenItHadTo) {
  constexpr std::int64_t k_most = lanes::k_most_unit;
  for (const std::int64_t x : {k_most, -k_most, k_most - 1, std::int64_t{0}}) {
    std::vector<BodyVector> vectors{{0, x}};
    EXPECT_TRUE(proximal::clamp_all(vectors));
    EXPECT_EQ(vectors[0][1], x);
  }
  for (const std::int64_t x : {k_most + 1, -k_most - 1, INT64_MAX, INT64_MIN}) {
    std::vector<BodyVector> vectors{{0, x}};
    EXPECT_FALSE(proximal::clamp_all(vectors));
    EXPECT_EQ(vectors[0][1], x > 0 ? k_most : -k_most);
  }
}

}  // namespace
}  // namespace lockstone
