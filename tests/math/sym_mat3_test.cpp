#include "core/math/sym_mat3.h"

#include <cmath>

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "core/math/roots.h"
#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::Raws;
using test::worst_of;

using Exact = std::array<std::array<mpq_class, 3>, 3>;
using Tensor = SymMat3<Length>;

Exact exact_of(const RawSymMat3& s) {
  return {{{s.xx, s.xy, s.xz}, {s.xy, s.yy, s.yz}, {s.xz, s.yz, s.zz}}};
}

/// Gauss and Jordan in rationals: another way than the adjugate.
Exact exact_inverse(Exact m) {
  Exact inverse{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (std::size_t pivot = 0; pivot < 3; ++pivot) {
    const mpq_class scale = 1 / m[pivot][pivot];  // positive: the matrix is positive definite
    for (std::size_t j = 0; j < 3; ++j) {
      m[pivot][j] *= scale;
      inverse[pivot][j] *= scale;
    }
    for (std::size_t row = 0; row < 3; ++row) {
      if (row == pivot) continue;
      const mpq_class factor = m[row][pivot];
      for (std::size_t j = 0; j < 3; ++j) {
        m[row][j] -= factor * m[pivot][j];
        inverse[row][j] -= factor * inverse[pivot][j];
      }
    }
  }
  return inverse;
}

mpq_class scaled(const mpq_class& x, int shift) {
  mpq_class result = x;
  if (shift >= 0) mpq_mul_2exp(result.get_mpq_t(), x.get_mpq_t(), static_cast<unsigned>(shift));
  if (shift < 0) mpq_div_2exp(result.get_mpq_t(), x.get_mpq_t(), static_cast<unsigned>(-shift));
  return result;
}

/// B·Bᵀ + diagonal, of axes of very different scale; often nearly singular.
RawSymMat3 random_definite(Raws& raws) {
  std::array<std::array<std::int64_t, 3>, 3> b{};
  const int spread = static_cast<int>(raws.bits64() % 15);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      b[i][j] = raws.signed_below_bits(14 - (i == raws.bits64() % 3 ? spread : 0));
  const auto entry = [&b](std::size_t i, std::size_t j) {
    std::int64_t sum = i == j ? 1 : 0;
    for (std::size_t k = 0; k < 3; ++k)
      sum += b[i][k] * b[j][k];
    return static_cast<std::int32_t>(sum);
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

TEST(SymMat3Inverse, RoundsEveryEntryOfTheExactInverse) {
  Raws raws;
  double worst = 0, worst_relative = 0;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const RawSymMat3 s = random_definite(raws);
    if (!is_positive_definite(s)) continue;
    const int bits = static_cast<int>(raws.bits64() % 31);
    const EquilibratedSymMat3 ours = inverse_raw(s, bits);
    const Exact exact = exact_inverse(exact_of(s));
    const Exact found = exact_of(raw_of(ours.scaled));
    for (std::size_t r = 0; r < 3; ++r) {
      for (std::size_t c = 0; c < 3; ++c) {
        const int shift = bits + 30 - ours.exponent[r] - ours.exponent[c];
        const mpq_class error = abs(found[r][c] - scaled(exact[r][c], shift));
        ASSERT_LE(error, mpq_class(1, 2));
        worst = worst_of(worst, error.get_d());
        const mpq_class size = scaled(exact[r][r] * exact[c][c], 2 * shift);
        worst_relative = worst_of(worst_relative, error.get_d() / std::sqrt(size.get_d()));
      }
      ASSERT_GE(found[r][r], 1 << 27);
      ASSERT_LE(found[r][r], 1 << 30);
    }
  }
  EXPECT_LE(worst_relative, 0x1p-28);
  std::printf("inverse: %.6f last places, 2^%.2f of the diagonal\n", worst,
              std::log2(worst_relative));
}

TEST(SymMat3Inverse, HandlesExtremeMatrices) {
  constexpr std::int32_t big = std::numeric_limits<std::int32_t>::max();
  const EquilibratedSymMat3 identity = inverse_raw({1 << 20, 1 << 20, 1 << 20, 0, 0, 0}, 20);
  EXPECT_EQ(identity.scaled.xx.raw >> (30 - 2 * identity.exponent[0]), 1);
  for (const RawSymMat3& s :
       {RawSymMat3{big, big, big, 0, 0, 0}, RawSymMat3{1, 1, 1, 0, 0, 0},
        RawSymMat3{big, 1, big, 0, big - 1, 0}, RawSymMat3{1, big, 1, 46340, 0, 0},
        RawSymMat3{big, big, big, big - 1, big - 2, big - 1}}) {
    if (!is_positive_definite(s)) continue;
    const EquilibratedSymMat3 ours = inverse_raw(s, 0);
    const Exact exact = exact_inverse(exact_of(s)), found = exact_of(raw_of(ours.scaled));
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c)
        ASSERT_LE(abs(found[r][c] - scaled(exact[r][c], 30 - ours.exponent[r] - ours.exponent[c])),
                  mpq_class(1, 2));
  }
}

TEST(SymMat3Definite, IsExactAtTheEdge) {
  EXPECT_FALSE(is_positive_definite(RawSymMat3{}));
  EXPECT_FALSE(is_positive_definite(RawSymMat3{1, 1, 1, 1, 0, 0}));
  EXPECT_TRUE(is_positive_definite(RawSymMat3{1000, 1000, 1000, 999, 0, 0}));
  constexpr std::int32_t low = std::numeric_limits<std::int32_t>::min();
  EXPECT_FALSE(is_positive_definite(RawSymMat3{low, low, low, low, low, low}));
  EXPECT_FALSE(is_positive_definite(RawSymMat3{5, 5, 5, low, low, low}));
  Raws raws;
  // Rank 2: the determinant is exactly zero, or one step off.
  for (int i = 0; i < test::share_of(20000); ++i) {
    const auto a = static_cast<std::int32_t>(raws.signed_below_bits(14)),
               b = static_cast<std::int32_t>(raws.signed_below_bits(14)),
               c = static_cast<std::int32_t>(raws.signed_below_bits(14)) | 1;
    RawSymMat3 s{a * a + 1, b * b + 1, c * c, a * b, a * c, b * c};
    ASSERT_TRUE(is_positive_definite(s));
    s = {a * a, b * b, c * c, a * b, a * c, b * c};
    ASSERT_FALSE(is_positive_definite(s));
  }
}

TEST(SymMat3Solve, RoundsTheExactSolution) {
  Raws raws;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const RawSymMat3 s = random_definite(raws);
    if (!is_positive_definite(s)) continue;
    const Vec3<std::int32_t> b{raws.any32(), raws.any32(), raws.any32()};
    const int shift = static_cast<int>(raws.bits64() % 60) - 30;
    const Vec3<std::int64_t> x = solve_raw_saturating(s, b, shift);
    const Exact inverse = exact_inverse(exact_of(s));
    for (std::size_t r = 0; r < 3; ++r) {
      const mpq_class exact =
          scaled(inverse[r][0] * b.x + inverse[r][1] * b.y + inverse[r][2] * b.z, shift);
      const std::int64_t ours = x[static_cast<int>(r)];
      const bool at_bound = std::abs(ours) == std::numeric_limits<std::int64_t>::max();
      if (at_bound) {
        ASSERT_GE(abs(exact), mpq_class(mpz_class(1) << 62));
      } else {
        ASSERT_LE(abs(mpq_class(ours) - exact), mpq_class(1, 2));
      }
    }
  }
  const Tensor diagonal{Length::from_integer(2), Length::from_integer(4), Length::from_integer(8)};
  const Vec3<SolverVelocity> b{SolverVelocity::from_integer(1), SolverVelocity::from_integer(1),
                               SolverVelocity::from_integer(-1)};
  const Vec3<Rate> x = solve_saturating<Rate>(diagonal, b);
  EXPECT_EQ(x.x.raw, 1 << 19);
  EXPECT_EQ(x.y.raw, 1 << 18);
  EXPECT_EQ(x.z.raw, -(1 << 17));
}

TEST(SymMat3Rotate, RoundsTheExactTensorOnce) {
  Raws raws;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const auto unit = [&] { return Unit::from_raw(raws.any32()); };
    const Mat3 r = to_matrix(normalized({unit(), unit(), unit(), unit()}));
    const auto entry = [&] { return static_cast<std::int32_t>(raws.signed_below_bits(29)); };
    const RawSymMat3 s{entry(), entry(), entry(), entry(), entry(), entry()};
    const Exact m = exact_of(s), ours = exact_of(rotate_raw(r, s));
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        mpq_class sum = 0;
        for (int j = 0; j < 9; ++j)
          sum += mpq_class(r.column(j / 3)[a].raw) * r.column(j % 3)[b].raw *
                 m[static_cast<std::size_t>(j / 3)][static_cast<std::size_t>(j % 3)];
        const mpq_class error =
            ours[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] - scaled(sum, -60);
        ASSERT_LE(abs(error), mpq_class(1, 2));
      }
    }
  }
}

TEST(SymMat3Product, IsExact) {
  using Entry = decltype(Tensor::xx);
  const auto entry = [](std::int32_t raw) { return Entry::from_raw(raw); };
  const Tensor s{entry(1), entry(2), entry(3), entry(4), entry(5), entry(6)};
  const Vec3<Length> v{Length::from_raw(10), Length::from_raw(20), Length::from_raw(30)};
  const auto product = s * v;
  EXPECT_EQ(product.x.raw, 10 + 80 + 150);
  EXPECT_EQ(product.y.raw, 40 + 40 + 180);
  EXPECT_EQ(product.z.raw, 50 + 120 + 90);
  EXPECT_EQ((s + s).yz.raw, 12);
  EXPECT_EQ((s - s), Tensor{});
}

}  // namespace
}  // namespace lockstone
