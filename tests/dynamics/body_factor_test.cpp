// Cholesky factors of islands: solutions of random systems, independence, limits; and the scales
// and roots that rows are made of.

#include "core/dynamics/problem/body_factor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/dynamics/contact/row_scale.h"
#include "core/dynamics/problem/proximal_rows.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

constexpr double k_gamma = 1.0 / (1 << BodyFactor::k_least_bits);

double of_q30(std::int64_t raw) {
  return std::ldexp(static_cast<double>(raw), -30);
}

RowSide random_side(test::Random& random) {
  RowSide side{};
  for (std::int32_t& x : side)
    x = static_cast<std::int32_t>(random.between(-(1 << 27), 1 << 27));
  return side;
}

// An island, its matrix in doubles, and a solution that is known.
struct Island {
  std::uint32_t bodies;
  std::vector<BodyFactor::Pair> pairs;
  BodyFactor::Plan plan;
  std::vector<double> matrix;
  std::vector<double> wanted;
  std::vector<BodyVector> sides;

  explicit Island(std::uint32_t count) : bodies(count), matrix(36U * count * count) {}

  [[nodiscard]] std::size_t size() const { return std::size_t{6} * bodies; }

  void add_row(BodyFactor& factor, std::uint32_t a, std::uint32_t b, const RowSide& x,
               const RowSide& y, std::int32_t weight) {
    std::vector<double> row(size());
    for (std::size_t i = 0; i < 6; ++i) {
      row[6U * a + i] = of_q30(x[i]);
      if (b < bodies) row[6U * b + i] = of_q30(y[i]);
    }
    for (std::size_t i = 0; i < size(); ++i)
      for (std::size_t j = 0; j < size(); ++j)
        matrix[i * size() + j] += of_q30(weight) * row[i] * row[j];
    factor.add(factor.diagonal(plan, a), x, x, weight);
    if (b == bodies) return;
    factor.add(factor.diagonal(plan, b), y, y, weight);
    const BodyFactor::Place place = factor.find(plan, a, b);
    factor.add(place.block, place.a_is_row ? x : y, place.a_is_row ? y : x, weight);
  }

  // A path through all bodies, further pairs, and three rows a pair; one body is held by the
  // ground.
  void fill(BodyFactor& factor, test::Random& random) {
    for (std::uint32_t i = 1; i < bodies; ++i)
      pairs.emplace_back(i - 1, i);
    for (std::uint32_t i = 0; i + 2 < bodies; ++i)
      if (random.between(0, 2) == 0)
        pairs.emplace_back(static_cast<std::uint32_t>(random.between(i + 2, bodies - 1)), i);
    ASSERT_TRUE(factor.plan(bodies, pairs, plan));
    factor.reset(plan);
    for (std::size_t i = 0; i < size(); ++i)
      matrix[i * size() + i] = k_gamma;
    const auto weight = [&] { return static_cast<std::int32_t>(1 << random.between(26, 30)); };
    for (const auto& [a, b] : pairs)
      for (int row = 0; row < 3; ++row)
        add_row(factor, a, b, random_side(random), random_side(random), weight());
    for (int row = 0; row < 3; ++row)
      add_row(factor, 0, bodies, random_side(random), {}, weight());
  }

  void ask(test::Random& random) {
    wanted.resize(size());
    for (double& x : wanted)
      x = static_cast<double>(random.between(-(1 << 24), 1 << 24));
    sides.assign(bodies, {});
    for (std::size_t i = 0; i < size(); ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < size(); ++j)
        sum += matrix[i * size() + j] * wanted[j];
      sides[i / 6][i % 6] = std::llround(sum);
    }
  }

  [[nodiscard]] double worst_error() const {
    double worst = 0;
    for (std::size_t i = 0; i < size(); ++i)
      worst = std::max(worst, std::fabs(static_cast<double>(sides[i / 6][i % 6]) - wanted[i]));
    return worst;
  }

  // K·x against the right-hand side.
  [[nodiscard]] double worst_residual() const {
    double worst = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      double sum = 0;
      for (std::size_t j = 0; j < size(); ++j)
        sum += matrix[i * size() + j] * (static_cast<double>(sides[j / 6][j % 6]) - wanted[j]);
      worst = std::max(worst, std::fabs(sum));
    }
    return worst;
  }
};

// An entry errs by 2^-31, and the least eigenvalue is 2^-14: no more than 2^-11 of the unknowns in
// the softest direction, and next to nothing in the rows' velocities.
TEST(BodyFactor, SolvesRandomIslands) {
  for (const std::uint32_t bodies : {1U, 2U, 3U, 5U, 9U, 20U, 40U}) {
    test::Random random;
    BodyFactor factor(64, 1024);
    Island island(bodies);
    island.fill(factor, random);
    island.ask(random);
    factor.factor(island.plan);
    ASSERT_TRUE(factor.solve(island.plan, island.sides)) << bodies;
    EXPECT_LT(island.worst_error(), 1 << 14) << bodies;
    EXPECT_LT(island.worst_residual(), 16) << bodies;
  }
}

TEST(BodyFactor, OfAnIslandDoesNotDependOnOthers) {
  test::Random random;
  BodyFactor alone(64, 1024), beside(64, 1024);
  Island other(12), first(15), second(15);
  other.fill(beside, random);
  test::Random same = random, again = random;
  first.fill(alone, same);
  second.fill(beside, again);
  other.ask(random);
  first.ask(same);
  second.ask(again);
  beside.factor(other.plan);
  alone.factor(first.plan);
  beside.factor(second.plan);
  ASSERT_TRUE(beside.solve(other.plan, other.sides));
  ASSERT_TRUE(alone.solve(first.plan, first.sides));
  ASSERT_TRUE(beside.solve(second.plan, second.sides));
  EXPECT_EQ(first.sides, second.sides);
}

TEST(BodyFactor, RefusesIslandsThatAreTooLarge) {
  constexpr std::uint32_t k_clique = 60;  // 60² + 59² + … products
  BodyFactor factor(2 * BodyFactor::k_most_bodies, 2048);
  BodyFactor::Plan plan;
  EXPECT_FALSE(factor.plan(BodyFactor::k_most_bodies + 1, {}, plan));
  std::vector<BodyFactor::Pair> pairs;
  for (std::uint32_t i = 0; i < k_clique; ++i)
    for (std::uint32_t k = 0; k < i; ++k)
      pairs.emplace_back(i, k);
  EXPECT_FALSE(factor.plan(k_clique, pairs, plan));
  test::Random random;
  Island island(8);
  island.fill(factor, random);
  island.ask(random);
  factor.factor(island.plan);
  ASSERT_TRUE(factor.solve(island.plan, island.sides));
  EXPECT_LT(island.worst_error(), 1 << 14);
}

TEST(BodyFactor, TellsWhenASolutionDoesNotFit) {
  BodyFactor factor(4, 4);
  BodyFactor::Plan plan;
  ASSERT_TRUE(factor.plan(1, {}, plan));
  factor.reset(plan);
  factor.factor(plan);
  std::vector<BodyVector> sides(1);
  sides[0][0] = 1 << 16;  // 2^30 when divided by γ
  EXPECT_TRUE(factor.solve(plan, sides));
  EXPECT_NEAR(of_q30(sides[0][0]), 1.0, 1e-6);
  sides[0] = {1 << 18};
  EXPECT_FALSE(factor.solve(plan, sides));
}

TEST(RowScale, MultipliesAndInvertsWithinTwoStepsOfItsMantissa) {
  test::Random random;
  for (int i = 0; i < test::share_of(2000); ++i) {
    const auto value = static_cast<std::uint64_t>(random.between(1, std::int64_t{1} << 60));
    const auto other = static_cast<std::uint64_t>(random.between(1, std::int64_t{1} << 60));
    const int shift = static_cast<int>(random.between(20, 80));
    const RowScale x = RowScale::of(value, shift), y = RowScale::of(other, 30);
    const auto size = [](const RowScale& scale) {
      return std::ldexp(static_cast<double>(scale.mantissa), -scale.shift);
    };
    const double exact = std::ldexp(static_cast<double>(value), -shift);
    EXPECT_NEAR(size(x) / exact, 1, 2e-9);
    EXPECT_NEAR(size(x * y) / (size(x) * size(y)), 1, 2e-9);
    EXPECT_NEAR(size(x.reciprocal()) * size(x), 1, 2e-9);
  }
}

using RealMatrix = std::array<std::array<double, 3>, 3>;

RealMatrix times_transpose(const RealMatrix& a) {
  RealMatrix m{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < 3; ++k)
        m[r][c] += a[r][k] * a[c][k];
  return m;
}

// B·Bᵀ of a lower triangle B, so that it is positive; often an axis is locked.
RealMatrix random_inertia(test::Random& random) {
  RealMatrix b{};
  const auto locked = static_cast<std::size_t>(random.between(0, 3));
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c <= r; ++c) {
      if (r == locked || c == locked) continue;
      const std::int64_t least = r == c ? 50 : -500;
      b[r][c] = static_cast<double>(random.between(least, 500)) / 1000;
    }
  }
  return times_transpose(b);
}

InverseInertia raw_of(const RealMatrix& m, int exponent) {
  const auto raw = [](double x) {
    return static_cast<std::int32_t>(std::lround(std::ldexp(x, 30)));
  };
  return {raw(m[0][0]), raw(m[1][1]), raw(m[2][2]), raw(m[0][1]),
          raw(m[0][2]), raw(m[1][2]), exponent};
}

RealMatrix real(const InertiaRoot& root) {
  RealMatrix c{};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t k = 0; k < 3; ++k)
      c[r][k] = std::ldexp(static_cast<double>(root.c[r][k]), root.shift - 30);
  return c;
}

// C·Cᵀ = M.
TEST(InertiaRoot, SquaredIsTheInertia) {
  test::Random random;
  for (int i = 0; i < test::share_of(2000); ++i) {
    const RealMatrix m = random_inertia(random);
    const int exponent = static_cast<int>(random.between(0, 12));
    const RealMatrix square = times_transpose(real(inertia_root(raw_of(m, exponent))));
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        EXPECT_NEAR(std::ldexp(square[r][c], -exponent), m[r][c], 2e-5);
  }
}

}  // namespace
}  // namespace lockstone
