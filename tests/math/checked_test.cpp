// The checked build: with LKS_ENABLE_ASSERTS whatever leaves a documented range stops the program.
// This program compiles core/math with the define, whatever the rest of the build does.
#include <gtest/gtest.h>

#include <lockstone/quat.h>
#include <lockstone/transform.h>

#include "core/math/block_float.h"
#include "core/math/divide.h"
#include "core/math/exponential.h"
#include "core/math/predicates.h"
#include "core/math/roots.h"
#include "core/math/square_roots.h"
#include "core/math/sym_mat3.h"
#include "core/math/trig.h"

#if !defined(LKS_ENABLE_ASSERTS)
#error "this test is about the checked build"
#endif

namespace lockstone {
namespace {

constexpr std::int64_t k_min64 = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t k_max64 = std::numeric_limits<std::int64_t>::max();

/// A copy that the optimiser cannot see through, so that nothing is decided at compile time.
template <class T>
T opaque(T value) {
  volatile T hidden = value;
  return hidden;
}

#define EXPECT_TRAP(statement) EXPECT_DEATH(static_cast<void>(statement), "")

TEST(Checked, SumsAndDifferencesTrap) {
  EXPECT_TRAP(Length::max() + Length::from_raw(opaque(1)));
  EXPECT_TRAP(Length::min() - Length::from_raw(opaque(1)));
  EXPECT_TRAP(-Length::from_raw(opaque(Length::min().raw)));
  EXPECT_TRAP(Position::max() + Position::from_raw(opaque(std::int64_t{1})));
  EXPECT_TRAP(Length::max() * opaque(2));
  EXPECT_TRAP(Position::from_raw(opaque(k_min64)) * -1);
  EXPECT_TRAP(Length::max() / opaque(0));
}

TEST(Checked, ConversionsTrap) {
  EXPECT_TRAP(Length::from_integer(opaque(2048)));
  EXPECT_TRAP(Unit::from_ratio(2, opaque(1)));
  EXPECT_TRAP(Unit::from_ratio(1, opaque(0)));
  EXPECT_TRAP(rounded<Displacement>(Length::from_raw(opaque(1 << 28))));
  EXPECT_TRAP((multiply<Length>(Position::from_raw(opaque(k_max64)), Unit::max())));
  EXPECT_TRAP(raw::round_shift(opaque(k_max64), 1));
  EXPECT_TRAP(raw::round_shift(0, opaque(63)));
}

TEST(Checked, WideWordsTrap) {
  EXPECT_TRAP((divide(UInt128{5, 0}, opaque(std::uint64_t{5}))));
  EXPECT_TRAP((round_divide(Int128{1, 0}, opaque(std::int64_t{1}))));
  EXPECT_TRAP((UInt128{1, 1} << opaque(-1)));
  EXPECT_TRAP(reciprocal_sqrt(opaque(std::uint64_t{1})));
}

TEST(Checked, QuotientsAndRootsTrap) {
  EXPECT_TRAP(divide<Number>(Number::from_integer(1), Number::from_raw(opaque(0))));
  EXPECT_TRAP(divide<Number>(Number::max(), Number::from_raw(opaque(1))));
  EXPECT_TRAP(reciprocal<Number>(Number::from_raw(opaque(0))));
  EXPECT_TRAP(reciprocal<Unit>(Unit::from_raw(opaque(1))));
  EXPECT_TRAP(sqrt(Number::from_raw(opaque(-1))));
  EXPECT_TRAP((sqrt<Length>(Fixed<SquareMetre, std::int64_t, 40>::from_raw(opaque(k_max64)))));
  EXPECT_TRAP(rsqrt<Number>(Number::from_raw(opaque(0))));
  EXPECT_TRAP(rsqrt<Unit>(Unit::from_raw(opaque(1))));
  EXPECT_TRAP(hypot(Length::from_raw(opaque(Length::max().raw)), Length::max()));
}

TEST(Checked, FunctionsTrap) {
  EXPECT_TRAP(exp2<Number>(Number::from_integer(opaque(11))));
  EXPECT_TRAP(log2<Number>(Number::from_raw(opaque(0))));
  EXPECT_TRAP(tan(Angle::from_raw(opaque(210828714))));
}

TEST(Checked, BlockFloatsTrap) {
  EXPECT_TRAP(inverse_of(Mass::from_raw(opaque(std::int64_t{-1}))));
  EXPECT_TRAP(block_float(1, opaque(200)));
}

TEST(Checked, MatricesTransformsAndPredicatesTrap) {
  const std::int32_t zero = opaque(0);
  EXPECT_TRAP((inverse_raw({1, 1, 1, 1, zero, zero}, 20)));
  EXPECT_TRAP((solve_raw_saturating({zero, 1, 1, 0, 0, 0}, {1, 1, 1}, 0)));
  constexpr std::int32_t big = std::numeric_limits<std::int32_t>::max();
  const Mat3 diagonal =
      to_matrix(normalized({Unit::from_raw(opaque(1 << 28)), {}, {}, Unit::from_raw(1 << 29)}));
  EXPECT_TRAP((rotate_raw(diagonal, {big, big, big, big, big, big})));
  EXPECT_TRAP((apply(Transform{{Position::max(), {}, {}}, {}},
                     Vec3<Position>{Position::from_raw(opaque(std::int64_t{1})), {}, {}})));
  EXPECT_TRAP((to_lattice({k_max64, 0, 0}, {opaque(std::int64_t{-1}), 0, 0}, 45)));
  EXPECT_TRAP((to_lattice({opaque(k_max64), 0, 0}, {}, 0)));
  EXPECT_TRAP((side_of_sphere({}, opaque(std::int64_t{-1}), {})));
  EXPECT_TRAP((side_of_circumsphere({opaque(1 << 25), 0, 0}, {}, {}, {}, {})));
}

TEST(Checked, SaturatingFormsStandEveryInput) {
  EXPECT_EQ(saturated<Length>(Position::max()), Length::max());
  EXPECT_EQ(divide_saturating<Number>(Number::max(), Number{}), Number::max());
  EXPECT_EQ(reciprocal_saturating<Unit>(Unit{}), Unit::max());
  EXPECT_EQ(sqrt_saturating<Number>(Number::min()), Number{});
  EXPECT_EQ(rsqrt_saturating<Number>(Number::min()), Number::max());
  EXPECT_EQ(hypot_saturating(Length::min(), Length::min()), Length::max());
  EXPECT_EQ(exp2_saturating<Number>(Number::max()), Number::max());
  EXPECT_EQ(exp2_saturating<Unit>(Unit::min()).raw, 1 << 28);
  EXPECT_EQ(tan_saturating(Angle::from_raw(210828714)), Number::max());
  EXPECT_EQ(raw::saturating_add(k_max64, k_max64), k_max64);
  EXPECT_EQ(atan2_raw(k_min64, k_min64), atan2_raw(-1, -1));
  EXPECT_EQ(norm(k_min64, k_min64, k_min64), 15975348984942515102U);  // ⌊√3 · 2^63⌉
}

}  // namespace
}  // namespace lockstone
