#include "core/math/principal_axes.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/math/int192.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

using Real = long double;
using Tensor = SymMat3<std::int64_t>;
using Matrix = std::array<std::array<Real, 3>, 3>;

constexpr std::int64_t k_one = std::int64_t{1} << 60;

Real real(std::int64_t x) {
  return std::ldexp(static_cast<Real>(x), -60);
}

Matrix matrix_of(const Tensor& s) {
  return {{{real(s.xx), real(s.xy), real(s.xz)},
           {real(s.xy), real(s.yy), real(s.yz)},
           {real(s.xz), real(s.yz), real(s.zz)}}};
}

/// The tensor with these principal axes and moments.
Matrix matrix_of(const PrincipalAxes& principal) {
  const Mat3 axes = to_matrix(principal.axes);
  Matrix m{};
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        m[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] +=
            real(principal.moments[k]) *
            std::ldexp(static_cast<Real>(axes.column(k)[i].raw) * axes.column(k)[j].raw, -60);
  return m;
}

Real difference(const Matrix& a, const Matrix& b) {
  Real most = 0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      most = std::max(most, std::fabs(a[i][j] - b[i][j]));
  return most;
}

/// v·vᵀ summed over a few random vectors: positive semi-definite, entries at most 1.
Tensor random_tensor(Random& random, int vectors, int thin_bits) {
  std::array<Real, 6> sum{};
  for (int i = 0; i < vectors; ++i) {
    const auto component = [&random](int bits) {
      return std::ldexp(static_cast<Real>(random.between(-1000000, 1000000)), -20 - bits);
    };
    const Real x = component(0), y = component(thin_bits), z = component(2 * thin_bits);
    const std::array<Real, 6> product{x * x, y * y, z * z, x * y, x * z, y * z};
    for (std::size_t k = 0; k < 6; ++k)
      sum[k] += product[k] / vectors;
  }
  const auto raw = [&sum](std::size_t k) {
    return static_cast<std::int64_t>(std::llround(std::ldexp(sum[k], 60)));
  };
  return {raw(0), raw(1), raw(2), raw(3), raw(4), raw(5)};
}

TEST(PrincipalAxes, GiveTheTensorBack) {
  Random random;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const Tensor tensor = random_tensor(random, 1 + i % 5, i % 7);
    const PrincipalAxes principal = principal_axes(tensor);
    ASSERT_LT(difference(matrix_of(principal), matrix_of(tensor)), 8e-9L);
    ASSERT_GE(principal.axes.w, Unit{});
    // The trace is exact but for the rotations' roundings.
    const auto& [x, y, z] = principal.moments;
    ASSERT_NEAR(static_cast<double>(real(x) + real(y) + real(z)),
                static_cast<double>(real(tensor.xx) + real(tensor.yy) + real(tensor.zz)), 1e-15);
  }
}

TEST(PrincipalAxes, OfADiagonalAreItsOwn) {
  Random random;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t a = random.between(0, k_one), b = random.between(0, k_one);
    const PrincipalAxes principal = principal_axes({a, b, i % 2 == 0 ? a : k_one, 0, 0, 0});
    EXPECT_EQ(principal.axes, Quat{});
    EXPECT_EQ(principal.moments, (Vec3<std::int64_t>{a, b, i % 2 == 0 ? a : k_one}));
  }
}

TEST(PrincipalAxes, OfEqualMomentsAreNotTurnedByNoise) {
  constexpr std::int64_t a = k_one / 3;
  EXPECT_EQ(principal_axes({a, a, a, a >> 23, -(a >> 23), a >> 24}).axes, Quat{});
  EXPECT_EQ(principal_axes({a, a + (a >> 20), a, a >> 23, 0, 0}).axes, Quat{});
  EXPECT_NE(principal_axes({a, a, a, a >> 20, 0, 0}).axes, Quat{});
  EXPECT_NE(principal_axes({a, 2 * a, a, a >> 23, 0, 0}).axes, Quat{});
}

TEST(PrincipalAxes, StayTheNearest) {
  Random random;
  for (int i = 0; i < 1000; ++i) {  // a plane rotation by less than 45 degrees is found as such
    const Real angle = static_cast<Real>(random.between(-780, 780)) / 1000;
    const Real c = std::cos(angle), s = std::sin(angle);
    const auto raw = [](Real x) {
      return static_cast<std::int64_t>(std::llround(std::ldexp(x, 60)));
    };
    const Real p = 0.25L, q = 0.75L;
    const Tensor tensor{raw(c * c * p + s * s * q),
                        raw(s * s * p + c * c * q),
                        raw(0.5L),
                        raw(c * s * (p - q)),
                        0,
                        0};
    const PrincipalAxes principal = principal_axes(tensor);
    EXPECT_NEAR(principal.axes.z.raw, static_cast<double>(std::ldexp(std::sin(angle / 2), 30)), 2);
    EXPECT_NEAR(principal.axes.w.raw, static_cast<double>(std::ldexp(std::cos(angle / 2), 30)), 2);
  }
}

TEST(Int192, MultipliesAndAddsExactly) {
  Random random;
  const auto word = [&random] {
    return static_cast<std::int64_t>(random.next()) >> (random.next() % 64);
  };
  for (int i = 0; i < test::share_of(20000); ++i) {
    const std::int64_t a = word() >> 1, b = word() >> 1, c = word(), d = word();
    const Int128 ab = multiply_wide(a, b);
    // (ab)·c + (ab)·d = ab·(c + d), by two halves of d that cannot overflow the sum
    const std::int64_t half = d >> 1, other = c >> 1;
    EXPECT_EQ(multiply(ab, other) + multiply(ab, half), multiply(ab, other + half));
    EXPECT_EQ(multiply(ab, c), multiply(multiply_wide(b, a), c));
    EXPECT_EQ(multiply(Int128::from(c), d), Int192::from(multiply_wide(c, d)));
    EXPECT_EQ(-multiply(ab, half), multiply(ab, -half));
    EXPECT_EQ(multiply(ab, half) + -multiply(ab, half), Int192{});
  }
}

TEST(Int192, ScalesAsNarrowerOnesDo) {
  Random random;
  const auto word = [&random] {
    return static_cast<std::int64_t>(random.next()) >> (random.next() % 64);
  };
  for (int i = 0; i < test::share_of(20000); ++i) {
    const Int128 x = multiply_wide(word(), word());
    const int shift = static_cast<int>(random.between(0, 63));
    EXPECT_EQ(scaled(Int192::from(x), -shift), round_shift(x, shift));
    const Int128 narrow = Int128::from(word());
    EXPECT_EQ(scaled(Int192::from(narrow), shift), narrow << shift);
    // 2^64 · x, shifted by 63, is 2 · x
    const Int192 shifted = multiply(x >> 1, std::int64_t{1} << 62);
    EXPECT_EQ(scaled(shifted, -62), x >> 1);
  }
}

}  // namespace
}  // namespace lockstone::test
