// Rounded boxes: sizes, masses, rays, distances, depths and contacts against long double.
#include "core/geometry/convex/compound_solid.h"
#include "core/geometry/convex/shape_traits.h"
#include "tests/geometry/pairs/pair_laws.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

Shape random_rounded(Dice& dice, double low, double high) {
  const Length radius = dice.size(low, high);
  const auto core = [&] { return min(dice.size(low, high), k_max_shape_size - radius); };
  const Length x = core(), y = core(), z = core();
  return Shape::rounded_box(max(x, k_min_shape_size), max(y, k_min_shape_size),
                            max(z, k_min_shape_size), radius);
}

TEST(RoundedBoxes, HaveTheMassOfTheIntegral) {
  Dice dice;
  for (int i = 0; i < test::share_of(3000); ++i) {
    const Shape shape = random_rounded(dice, 0.001, 200);
    ASSERT_EQ(validate(shape), Status::ok);
    const Real volume = RealRounded(shape).volume();
    const Density density = Density::from_raw(static_cast<std::int32_t>(dice.between(1, 1 << 22)));
    const Real truth = volume * real(density), step = std::ldexp(Real{1}, -Mass::frac_bits);
    const BlockFloat whole = geometry::solid_of(shape).volume;
    ASSERT_NEAR(std::ldexp(static_cast<double>(whole.mantissa), whole.exponent) /
                    static_cast<double>(volume),
                1, 1e-9);
    if (truth > std::ldexp(Real{1}, 31) * (1 - 1e-9L)) continue;
    ASSERT_NEAR(static_cast<double>(real(mass_of(shape, density)) / truth), 1,
                static_cast<double>(1e-11L + step * 0.501L / truth))
        << describe(shape);
  }
}

TEST(RoundedBoxes, HaveTheInertiaOfTheIntegral) {
  Dice dice;
  for (int i = 0; i < test::share_of(3000); ++i) {
    const Shape shape = random_rounded(dice, 0.001, 300);
    const RealRounded truth(shape);
    const Real volume = truth.volume(), x = truth.square(0), y = truth.square(1),
               z = truth.square(2);
    const Real scale = std::ldexp(Real{1}, scale_exponent(shape));
    const RealVec found = real(normalized_inertia(shape)) * (scale * scale);
    const auto step = static_cast<double>(std::ldexp(scale * scale, -29));
    ASSERT_NEAR(static_cast<double>(found.x), static_cast<double>((y + z) / volume), step);
    ASSERT_NEAR(static_cast<double>(found.y), static_cast<double>((z + x) / volume), step);
    ASSERT_NEAR(static_cast<double>(found.z), static_cast<double>((x + y) / volume), step);
  }
}

TEST(RoundedBoxes, TendToBoxesBallsAndCapsules) {
  const Density density = Density::from_integer(1000);
  const auto expect_like = [&](const Shape& rounded, const Shape& other, double share) {
    EXPECT_NEAR(as_double(mass_of(rounded, density)) / as_double(mass_of(other, density)), 1,
                share);
    const auto moments = [](const Shape& shape) {
      return real(normalized_inertia(shape)) * std::ldexp(Real{1}, 2 * scale_exponent(shape));
    };
    EXPECT_LT(static_cast<double>(norm(moments(rounded) - moments(other))), share);
  };
  const Length one = metres(1), least = k_min_shape_size;
  expect_like(Shape::rounded_box(one, one, one, least), Shape::box(one, one, one), 0.004);
  expect_like(Shape::rounded_box(least, least, least, one), Shape::sphere(one), 0.006);
  expect_like(Shape::rounded_box(least, one, least, one), Shape::capsule(one, one), 0.006);
}

TEST(RoundedBoxes, AreRefusedWhereTheyReachBeyondTheLargestSize) {
  const Length half = metres(400), radius = metres(112);
  EXPECT_EQ(validate(Shape::rounded_box(half, half, half, radius)), Status::ok);
  const Length more = radius + Length::from_raw(1);
  for (const Shape& shape :
       {Shape::rounded_box(half, metres(1), metres(1), more),
        Shape::rounded_box(metres(1), metres(1), half, more),
        Shape::rounded_box(half, half, half, {}), Shape::rounded_box({}, half, half, radius),
        Shape::rounded_box(half, half, half, -radius),
        Shape{ShapeKind::rounded_box, {half, half, half}, {std::uint64_t{1} << 40}}})
    EXPECT_EQ(validate(shape), Status::invalid_argument);
}

TEST(RoundedBoxes, LieBetweenTheirRadiiAndWithinTheirBounds) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_rounded(dice, 0.001, 300);
    const RealRounded truth(shape);
    const Mat3 rotation = to_matrix(dice.orientation());
    const Real reach = truth.reach(dice.direction());
    ASSERT_LE(reach, real(bounding_radius(shape)));
    ASSERT_LE(bounding_radius(shape), Length::from_integer(1024));
    ASSERT_GE(reach, real(inner_radius(shape)) - 1e-9L) << describe(shape);
    const RealVec found = real(world_half_extents(shape, rotation));
    for (int k = 0; k < 3; ++k) {
      RealVec axis;
      axis[k] = 1;
      const Real most = truth.reach(in_frame(rotation, axis));
      ASSERT_GE(found[k], most - 1e-6L) << describe(shape);
      ASSERT_LE(found[k], most + 2 * k_micrometre) << describe(shape);
    }
  }
}

TEST(RoundedBoxes, HoldThePointsWithinTheirSurface) {
  Dice dice;
  int inside = 0;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const Shape shape = random_rounded(dice, 0.05, 20);
    const RealVec at = dice.direction() *
                       (real(bounding_radius(shape)) * static_cast<Real>(dice.uniform(0.2, 1.1)));
    const Real out = RealRounded(shape).outside(at);
    const Length slack = dice.size(0.001, 0.1);
    if (std::fabs(out - real(slack)) < 3 * k_micrometre) continue;
    const bool held = geometry::traits_of(shape).holds(shape, metres(at), slack);
    ASSERT_EQ(held, out < real(slack)) << describe(shape);
    inside += held ? 1 : 0;
  }
  EXPECT_GT(inside, test::share_of(5000));
}

TEST(RoundedBoxes, ShrinkBelowTheirSurface) {
  Dice dice;
  for (int i = 0; i < test::share_of(5000); ++i) {
    const Shape shape = random_rounded(dice, 0.05, 5);
    const Real share = static_cast<Real>(dice.uniform(0.05, 0.95));
    const Length depth = metres(static_cast<double>(real(inner_radius(shape)) * share));
    const Shape less = geometry::traits_of(shape).shrunk(shape, depth);
    const RealVec n = dice.direction();
    const Real fall = RealRounded(shape).reach(n) - RealRounded(less).reach(n);
    ASSERT_GE(fall, real(depth) - 5 * k_micrometre) << describe(shape);
    ASSERT_LE(fall, real(depth) * 1.8L + 5 * k_micrometre) << describe(shape);
  }
}

TEST(RoundedBoxes, AreMetByRaysWhereTheirSurfaceIs) {
  expect_rays_end_at_surfaces<RealRounded>(random_rounded);
}

/// At `least` to `most` of where they touch along the line of centres.
ReachPair random_rounded_pair(Dice& dice, double least, double most) {
  ReachPair pair;
  pair.a = random_rounded(dice, 0.1, 3);
  const Length x = dice.size(0.1, 3), y = dice.size(0.1, 3);
  switch (dice.between(0, 5)) {
    case 0:
      pair.b = Shape::sphere(x);
      break;
    case 1:
      pair.b = Shape::capsule(x, y);
      break;
    case 2:
      pair.b = Shape::cylinder(x, y);
      break;
    case 3:
      pair.b = Shape::cone(x, y);
      break;
    case 4:
      pair.b = random_rounded(dice, 0.1, 3);
      break;
    default:
      pair.b = dice.shape(ShapeKind::box, 0.1, 3);
  }
  pair.rotation_a = to_matrix(dice.orientation());
  pair.rotation_b = dice.chance(4) ? pair.rotation_a : to_matrix(dice.orientation());
  if (dice.chance(2)) {
    std::swap(pair.a, pair.b);
    std::swap(pair.rotation_a, pair.rotation_b);
  }
  const RealVec n = dice.chance(4)
                        ? real(pair.rotation_a.column(static_cast<int>(dice.between(0, 2))))
                        : dice.direction();
  pair.place(dice, n, least, most);
  return pair;
}

TEST(RoundedBoxes, AreApartByTheDistanceAlongItsNormal) {
  expect_distances_along_normals(random_rounded_pair, 6000, 2e-6);
}

TEST(RoundedBoxes, OverlapByTheDepthAlongItsNormal) {
  expect_depths_along_normals(random_rounded_pair, 6000, 500);
}

TEST(RoundedBoxes, TouchAtTheirLeastSeparation) {
  expect_contacts_at_least_separation(random_rounded_pair, 12000);
}

TEST(RoundedBoxes, AreMetBySweptShapesWhereTheyTouch) {
  expect_casts_end_where_shapes_touch(random_rounded_pair);
}

// Points ------------------------------------------------------------------------------------------

const Shape k_floor_of_die = Shape::box(metres(5), metres(1), metres(5));

/// The die on a floor of either kind, 1 mm deep, turned about z and x.
Manifold die_on(const Shape& ground, const Shape& die, const Mat3& rotation) {
  const Mat3 upright;
  const Real low = RealRounded(die).reach(in_frame(rotation, {0, -1, 0}));
  const double top = ground.kind == ShapeKind::box ? 1 : 0;
  return collide({ground, upright}, {die, rotation},
                 metres(0, top + static_cast<double>(low) - 0.001, 0), metres(0.02));
}

TEST(RoundedBoxes, RestOnTheFlatPartOfAFace) {
  const Shape die = Shape::rounded_box(metres(0.3), metres(0.4), metres(0.5), metres(0.1));
  for (const Shape& ground : {k_floor_of_die, Shape::half_space()}) {
    const Manifold m = die_on(ground, die, Mat3{});
    ASSERT_EQ(m.count, 4);
    EXPECT_EQ(m.normal, Mat3{}.y);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(as_double(m.points[i].separation), -0.001, 2e-6);
      const RealVec at = real(m.points[i].anchor_b);
      EXPECT_NEAR(std::fabs(static_cast<double>(at.x)), 0.3, 2e-6);
      EXPECT_NEAR(static_cast<double>(at.y), -0.5 + 0.0005, 2e-6);
      EXPECT_NEAR(std::fabs(static_cast<double>(at.z)), 0.5, 2e-6);
    }
  }
}

TEST(RoundedBoxes, LieOnTwoPointsOfAnEdgeAndOnOneOfACorner) {
  const Shape die = Shape::rounded_box(metres(0.3), metres(0.3), metres(0.5), metres(0.1));
  const Mat3 on_edge = turned(0, 0, 1, std::acos(-1.0) / 4);
  const Mat3 on_corner = multiply(turned(1, 0, 0, 0.6), on_edge);
  for (const Shape& ground : {k_floor_of_die, Shape::half_space()}) {
    const Manifold edge = die_on(ground, die, on_edge);
    ASSERT_EQ(edge.count, 2);
    EXPECT_EQ(edge.normal, Mat3{}.y);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(as_double(edge.points[i].separation), -0.001, 2e-6);
    const Real span = norm(real(edge.points[0].anchor_b) - real(edge.points[1].anchor_b));
    EXPECT_NEAR(static_cast<double>(span), 1, 4e-6);
    const Manifold corner = die_on(ground, die, on_corner);
    ASSERT_EQ(corner.count, 1);
    EXPECT_NEAR(as_double(corner.points[0].separation), -0.001, 3e-6);
  }
}

TEST(RoundedBoxes, TouchAlongEdgesThatRunSideBySide) {
  const Shape die = Shape::rounded_box(metres(0.3), metres(0.3), metres(0.5), metres(0.1));
  const Mat3 on_edge = turned(0, 0, 1, std::acos(-1.0) / 4);
  const double high = 2 * (0.3 * std::sqrt(2.0) + 0.1) - 0.001;
  const Manifold m = collide({die, on_edge}, {die, on_edge}, metres(0, high, 0.2), metres(0.02));
  ASSERT_EQ(m.count, 2);
  const Real span = norm(real(m.points[0].anchor_b) - real(m.points[1].anchor_b));
  EXPECT_NEAR(static_cast<double>(span), 0.8, 4e-6);
}

// The features of a die that rocks a little about its rest keep their numbers.
TEST(RoundedBoxes, KeepTheirFeaturesWhileTheyRock) {
  const Shape die = Shape::rounded_box(metres(0.3), metres(0.4), metres(0.5), metres(0.1));
  for (const Shape& ground : {k_floor_of_die, Shape::half_space()}) {
    const auto features = features_of(die_on(ground, die, Mat3{}));
    for (const double tilt : {-0.01, -0.002, 0.003, 0.012}) {
      const Mat3 rotation = turned(0.6, 0, 0.8, tilt);
      EXPECT_EQ(features_of(die_on(ground, die, rotation)), features) << tilt;
    }
  }
}

}  // namespace
}  // namespace lockstone::test
