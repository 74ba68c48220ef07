// Block-sparse LDL: plans without fill, solutions of random systems, rows that say the same twice.

#include "core/dynamics/linkage/system/joint_factor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/math/product_sum.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

constexpr std::uint32_t k_rows = 3;

// A chain: each joint but the last shares a body with the next.
struct Chain {
  std::uint32_t count;
  JointFactor factor{count};
  std::vector<double> dense = std::vector<double>(std::size_t{count} * k_rows * count * k_rows);

  explicit Chain(std::uint32_t joints) : count(joints) {
    const auto next = [&](std::uint32_t k, const auto& emit) {
      if (k + 1 < count) emit(k + 1);
    };
    EXPECT_TRUE(factor.plan(count, next, [](std::uint32_t) { return k_rows; }));
    for (JointFactor::Column& column : factor.columns(0, count))
      column.count = k_rows;
  }

  double& at(std::uint32_t row, std::uint32_t column) {
    return dense[std::size_t{row} * count * k_rows + column];
  }

  void set(std::uint32_t row, std::uint32_t column, double value) {
    at(row, column) = at(column, row) = value;
    const JointFactor::Column& of = factor.columns(0, count)[column / k_rows];
    const std::uint32_t offset = row % k_rows * k_rows + column % k_rows;
    const std::uint32_t first =
        row / k_rows == column / k_rows ? of.diagonal : factor.blocks(of)[0].values;
    factor.value(first + offset) = std::llround(std::ldexp(value, k_matrix_bits));
  }

  // Diagonally dominant, with entries below 1.
  void fill(test::Random& random) {
    const std::uint32_t n = count * k_rows;
    for (std::uint32_t column = 0; column < n; ++column) {
      set(column, column, 0.9);
      const std::uint32_t end = std::min(n, (column / k_rows + 2) * k_rows);
      for (std::uint32_t row = column + 1; row < end; ++row)
        set(row, column, static_cast<double>(random.between(-1000, 1000)) / 10000);
    }
  }
};

TEST(JointFactor, OfAChainFillsNothingIn) {
  Chain chain(20);
  for (std::uint32_t k = 0; k < 20; ++k)
    EXPECT_EQ(chain.factor.columns(0, 20)[k].block_count, k < 19 ? 1U : 0U);
}

TEST(JointFactor, SolvesItsSystem) {
  test::Random random(test::run_seed());
  for (int round = 0; round < 50; ++round) {
    Chain chain(8);
    chain.fill(random);
    EXPECT_EQ(chain.factor.factor(0, chain.count), 0U);
    std::vector<double> expected(chain.count * k_rows);
    for (double& x : expected)
      x = static_cast<double>(random.between(-100000, 100000)) / 1000;
    for (std::uint32_t row = 0; row < expected.size(); ++row) {
      double sum = 0;
      for (std::uint32_t column = 0; column < expected.size(); ++column)
        sum += chain.at(row, column) * expected[column];
      chain.factor.rhs(row) = std::llround(std::ldexp(sum, 46));
    }
    EXPECT_EQ(chain.factor.solve(0, chain.count), 0);
    for (std::uint32_t row = 0; row < expected.size(); ++row)
      ASSERT_NEAR(std::ldexp(static_cast<double>(chain.factor.rhs(row)), -46), expected[row], 1e-8);
  }
}

TEST(JointFactor, LosesBitsWhereASolutionIsGreat) {
  Chain chain(1);
  for (std::uint32_t row = 0; row < k_rows; ++row) {
    for (std::uint32_t column = 0; column <= row; ++column)
      chain.set(row, column, row == column ? std::ldexp(1, -10 * static_cast<int>(row)) : 0);
  }
  EXPECT_EQ(chain.factor.factor(0, 1), 0U);
  for (std::uint32_t row = 0; row < k_rows; ++row)
    chain.factor.rhs(row) = std::int64_t{3} << 46;
  EXPECT_EQ(chain.factor.solve(0, 1), 12);
  for (std::uint32_t row = 0; row < k_rows; ++row)
    EXPECT_EQ(chain.factor.rhs(row), std::int64_t{3} << (46 - 12 + 10 * row));
}

TEST(JointFactor, LeavesOutRowsThatSayTheSameTwice) {
  Chain chain(1);
  for (std::uint32_t row = 0; row < k_rows; ++row) {
    for (std::uint32_t column = 0; column <= row; ++column)
      chain.set(row, column, row == column ? 0.5 : row == 1 ? 0.5 : 0);
  }
  EXPECT_EQ(chain.factor.factor(0, 1), 1U);
  for (std::uint32_t row = 0; row < k_rows; ++row)
    chain.factor.rhs(row) = std::int64_t{1} << 46;
  EXPECT_EQ(chain.factor.solve(0, 1), 0);
  EXPECT_EQ(chain.factor.rhs(0), std::int64_t{2} << 46);
  EXPECT_EQ(chain.factor.rhs(1), 0);
  EXPECT_EQ(chain.factor.rhs(2), std::int64_t{2} << 46);
}

TEST(JointFactor, RefusesToFillInANet) {
  constexpr std::uint32_t k_count = 100;
  JointFactor factor(k_count);
  const auto all = [](std::uint32_t k, const auto& emit) {
    for (std::uint32_t i = k + 1; i < k_count; ++i)
      emit(i);
  };
  EXPECT_FALSE(factor.plan(k_count, all, [](std::uint32_t) { return k_rows; }));
  EXPECT_TRUE(factor.plan(
      1, [](std::uint32_t, const auto&) {}, [](std::uint32_t) { return 6U; }));
}

TEST(ProductSum, RoundsOnceAwayFromZeroAndStaysInItsBounds) {
  ProductSum sum;
  sum.add(std::int64_t{1} << 61, 3);
  sum.subtract(std::int64_t{1} << 61, 3);
  sum.add(5, 1);
  EXPECT_EQ(sum.rounded(1), 3);
  EXPECT_EQ(product_rounded(-5, 1, 1), -3);
  EXPECT_EQ(product_rounded(std::int64_t{1} << 61, 8, 1), k_product_bound);
  EXPECT_EQ(product_rounded(std::int64_t{1} << 61, -8, 1), -k_product_bound);
}

TEST(ProductSum, RoundsAlikeByAnyShift) {
  test::Random random(test::run_seed());
  for (int i = 0; i < test::share_of(200'000); ++i) {
    const int shift = static_cast<int>(random.between(1, 125));
    const auto any = [&] {
      return static_cast<std::int64_t>(random.next()) >> random.between(1, 63);
    };
    const std::int64_t a = any(), b = any(), near = random.between(-2, 2);
    const std::int64_t power = std::int64_t{1} << random.between(0, 61);
    for (const std::int64_t x : {a, power, -power}) {
      ProductSum sum;
      sum.add(x, b);
      sum.add(near, 1);
      const Int128 exact = multiply_wide(x, b) + Int128::from(near);
      const std::int64_t expected = saturate_to_int64(round_shift(exact, shift));
      ASSERT_EQ(sum.rounded(shift), std::clamp(expected, -k_product_bound, k_product_bound));
    }
  }
}

}  // namespace
}  // namespace lockstone
