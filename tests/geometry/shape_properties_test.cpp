#include "core/geometry/convex/shape_properties.h"

#include "tests/geometry/scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

const Real k_pi = std::acos(Real{-1});

Density kilograms_per_metre3(double x) {
  return Density::from_raw(static_cast<std::int32_t>(std::lround(x * 256)));
}

Real volume_of(const Shape& s) {
  const RealVec size = real(s.size);
  if (s.kind == ShapeKind::sphere) return 4 * k_pi / 3 * size.x * size.x * size.x;
  if (s.kind == ShapeKind::capsule) {
    return 2 * k_pi * size.x * size.x * size.y + 4 * k_pi / 3 * size.x * size.x * size.x;
  }
  return 8 * size.x * size.y * size.z;
}

/// Moments over the mass.
RealVec inertia_of(const Shape& s) {
  const RealVec size = real(s.size);
  const auto square = [](Real x) { return x * x; };
  if (s.kind == ShapeKind::sphere) {
    const Real moment = square(size.x) * 2 / 5;
    return {moment, moment, moment};
  }
  if (s.kind == ShapeKind::box) {
    return {(square(size.y) + square(size.z)) / 3, (square(size.z) + square(size.x)) / 3,
            (square(size.x) + square(size.y)) / 3};
  }
  const Real r = size.x;
  const Real h = size.y;
  const Real cylinder = k_pi * r * r * 2 * h / volume_of(s);
  const Real balls = 1 - cylinder;
  const Real across =
      cylinder * (r * r / 4 + h * h / 3) + balls * (r * r * 2 / 5 + h * h + 2 * h * r * 3 / 8);
  return {across, cylinder * r * r / 2 + balls * r * r * 2 / 5, across};
}

template <class Check>
void for_random_shapes(Check check) {
  Dice dice;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const ShapeKind kind = k_all_kinds[static_cast<std::size_t>(i % 3)];
    const Shape shape = dice.shape(kind, 0.001, 512);
    check(dice, shape);
    if (::testing::Test::HasFailure()) {
      ADD_FAILURE() << describe(shape);
      return;
    }
  }
}

TEST(Validate, AcceptsTheBoundsAndNothingBeyond) {
  const Length low = k_min_shape_size;
  const Length high = k_max_shape_size;
  const Length step = Length::from_raw(1);
  EXPECT_EQ(validate(Shape::sphere(low)), Status::ok);
  EXPECT_EQ(validate(Shape::sphere(high)), Status::ok);
  EXPECT_EQ(validate(Shape::sphere(low - step)), Status::invalid_argument);
  EXPECT_EQ(validate(Shape::sphere(high + step)), Status::invalid_argument);
  EXPECT_EQ(validate(Shape::capsule(low, high)), Status::ok);
  EXPECT_EQ(validate(Shape::capsule({}, high)), Status::invalid_argument);
  EXPECT_EQ(validate(Shape::box(low, high, low)), Status::ok);
  EXPECT_EQ(validate(Shape::box(low, high, -low)), Status::invalid_argument);
  const Length thin = Length::from_ratio(1, 10'000);
  EXPECT_EQ(thin, k_min_box_extent);
  EXPECT_EQ(validate(Shape::box(low, thin, thin)), Status::ok);
  EXPECT_EQ(validate(Shape::box(thin, thin, high)), Status::ok);
  EXPECT_EQ(validate(Shape::box(high, thin - step, high)), Status::invalid_argument);
  EXPECT_EQ(validate(Shape::box(thin, low - step, thin)), Status::invalid_argument);
  EXPECT_EQ(validate(Shape::rounded_box(high - low, thin, low, low)), Status::invalid_argument);
  EXPECT_EQ(validate(Shape::cylinder(thin, high)), Status::invalid_argument);
  EXPECT_EQ(validate({ShapeKind::sphere, {low, low, {}}, {}}), Status::invalid_argument);
  EXPECT_EQ(validate({static_cast<ShapeKind>(7), {low, low, low}}), Status::invalid_argument);
}

TEST(MassOf, IsTheCorrectlyRoundedClosedForm) {
  for_random_shapes([](Dice& dice, const Shape& shape) {
    const Density density = kilograms_per_metre3(dice.uniform(0.01, 20000));
    const Real truth = volume_of(shape) * real(density);
    const Real found = real(mass_of(shape, density));
    const Real step = std::ldexp(Real{1}, -Mass::frac_bits);
    if (truth > std::ldexp(Real{1}, 31) * (1 - 1e-9L)) return;
    EXPECT_NEAR(static_cast<double>(found / truth), 1,
                static_cast<double>(1e-15L + step * 0.501L / truth));
  });
}

TEST(MassOf, SaturatesMassesThatAreTooLarge) {
  const Shape huge = Shape::box(k_max_shape_size, k_max_shape_size, k_max_shape_size);
  EXPECT_EQ(mass_of(huge, Density::max()), Mass::max());
  EXPECT_EQ(mass_of(Shape::capsule(k_max_shape_size, k_max_shape_size), Density::max()),
            Mass::max());
  EXPECT_EQ(mass_of(huge, Density{}), Mass{});
}

TEST(NormalizedInertia, MatchesTheClosedForm) {
  for_random_shapes([](Dice&, const Shape& shape) {
    const RealVec truth = inertia_of(shape);
    const Real scale = std::ldexp(Real{1}, scale_exponent(shape));
    const RealVec found = real(normalized_inertia(shape));
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(static_cast<double>(found[k]), static_cast<double>(truth[k] / (scale * scale)),
                  std::ldexp(1.0, -29));
      EXPECT_GT(found[k], 0);
      EXPECT_LE(found[k], 1);
    }
  });
}

TEST(ScaleExponent, IsTheFirstPowerOfTwoThatHoldsTheShape) {
  for_random_shapes([](Dice&, const Shape& shape) {
    const Real scale = std::ldexp(Real{1}, scale_exponent(shape));
    EXPECT_GE(scale, real(bounding_radius(shape)));
    EXPECT_LT(scale / 2, real(bounding_radius(shape)));
  });
  EXPECT_EQ(scale_exponent(Shape::sphere(k_min_shape_size)), -10);
  EXPECT_EQ(scale_exponent(Shape::sphere(metres(1))), 0);
  EXPECT_EQ(scale_exponent(Shape::sphere(metres(1) + Length::from_raw(1))), 1);
  EXPECT_EQ(scale_exponent(Shape::capsule(k_max_shape_size, k_max_shape_size)), 10);
}

TEST(Radii, HoldTheShapeAndAreHeldByIt) {
  for_random_shapes([](Dice& dice, const Shape& shape) {
    const Mat3 identity;
    const Placed placed({shape, identity}, {});
    const Real outer = real(bounding_radius(shape));
    const Real inner = real(inner_radius(shape));
    const RealVec n = dice.direction();
    EXPECT_LE(placed.reach(n), outer * (1 + 1e-15L));
    EXPECT_GE(placed.reach(n), inner * (1 - 1e-15L));
    if (shape.kind != ShapeKind::box) return;
    EXPECT_LT(outer - norm(real(shape.size)), std::ldexp(Real{1}, -20));
  });
}

TEST(WorldHalfExtents, BoundTheTurnedShapeTightly) {
  for_random_shapes([](Dice& dice, const Shape& shape) {
    const Mat3 rotation = to_matrix(dice.orientation());
    const Placed placed({shape, rotation}, {});
    const RealVec found = real(world_half_extents(shape, rotation));
    for (int k = 0; k < 3; ++k) {
      RealVec axis;
      axis[k] = 1;
      EXPECT_GE(found[k], placed.reach(axis) - 1e-15L);
      EXPECT_LE(found[k], placed.reach(axis) + std::ldexp(Real{1}, -20));
    }
  });
}

}  // namespace
}  // namespace lockstone::test
