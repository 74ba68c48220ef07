// Tapered capsules: sizes, masses, rays, distances, depths and contacts against long double.
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/distance/motion/time_of_impact.h"
#include "tests/geometry/pairs/pair_laws.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

Shape random_taper(Dice& dice, double low, double high) {
  const Length bottom = dice.size(low, high);
  return Shape::tapered_capsule(dice.size(low, high), bottom,
                                dice.chance(8) ? bottom : dice.size(low, high));
}

TEST(TaperedCapsules, HaveTheMassOfTheIntegral) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_taper(dice, 0.001, 512);
    const Real volume = k_real_pi * RealTaper(shape).integral([](Real rr, Real) { return rr; });
    const Density density = Density::from_raw(static_cast<std::int32_t>(dice.between(1, 1 << 22)));
    const Real truth = volume * real(density), step = std::ldexp(Real{1}, -Mass::frac_bits);
    if (truth > std::ldexp(Real{1}, 31) * (1 - 1e-9L)) continue;
    ASSERT_NEAR(static_cast<double>(real(mass_of(shape, density)) / truth), 1,
                static_cast<double>(1e-14L + step * 0.501L / truth))
        << describe(shape);
  }
}

TEST(TaperedCapsules, HaveTheInertiaOfTheIntegral) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_taper(dice, 0.001, 512);
    const RealTaper truth(shape);
    const Real mass = truth.integral([](Real rr, Real) { return rr; });
    const Real axial = truth.integral([](Real rr, Real) { return rr * rr / 2; }) / mass;
    const Real across = truth.integral([&](Real rr, Real y) {
      const Real up = y - truth.centre;
      return rr * rr / 4 + rr * up * up;
    }) / mass;
    const Real scale = std::ldexp(Real{1}, scale_exponent(shape));
    const RealVec found = real(normalized_inertia(shape)) * (scale * scale);
    const auto step = static_cast<double>(std::ldexp(scale * scale, -29));
    ASSERT_NEAR(static_cast<double>(found.x), static_cast<double>(across), step) << describe(shape);
    ASSERT_NEAR(static_cast<double>(found.y), static_cast<double>(axial), step) << describe(shape);
    ASSERT_EQ(found.x, found.z);
  }
}

TEST(TaperedCapsules, OfTwoEqualBallsAreCapsulesAndOfNestedOnesBalls) {
  Dice dice;
  for (int i = 0; i < test::share_of(1000); ++i) {
    const Length r = dice.size(0.01, 50), h = dice.size(0.01, 50);
    const Density density = Density::from_integer(1000);
    const Shape even = Shape::tapered_capsule(h + h, r, r), capsule = Shape::capsule(h, r);
    ASSERT_NEAR(as_double(mass_of(even, density)) / as_double(mass_of(capsule, density)), 1, 1e-9);
    const RealVec apart = real(normalized_inertia(even)) - real(normalized_inertia(capsule));
    ASSERT_LT(norm(apart), 4e-9L);
    const Shape nested = Shape::tapered_capsule(r / 2, r / 4, r), ball = Shape::sphere(r);
    ASSERT_NEAR(as_double(mass_of(nested, density)) / as_double(mass_of(ball, density)), 1, 1e-9);
    ASSERT_EQ(bounding_radius(nested), r);
  }
}

TEST(TaperedCapsules, LieBetweenTheirRadiiAndWithinTheirBounds) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_taper(dice, 0.001, 512);
    const RealTaper truth(shape);
    const Mat3 rotation = to_matrix(dice.orientation());
    const Real reach = truth.reach(dice.direction());
    ASSERT_LE(reach, real(bounding_radius(shape)));
    ASSERT_LE(bounding_radius(shape), Length::from_integer(1024));
    ASSERT_GE(reach, real(inner_radius(shape)) - std::ldexp(Real{1}, -20)) << describe(shape);
    const RealVec found = real(world_half_extents(shape, rotation));
    for (int k = 0; k < 3; ++k) {
      RealVec axis;
      axis[k] = 1;
      const Real most = std::max(truth.reach(in_frame(rotation, axis)),
                                 truth.reach(in_frame(rotation, axis * -1)));
      ASSERT_GE(found[k], most - 1e-12L) << describe(shape);
      ASSERT_LE(found[k], most + 2 * k_micrometre) << describe(shape);
    }
  }
}

TEST(TaperedCapsules, AreMetByRaysWhereTheirSurfaceIs) {
  expect_rays_end_at_surfaces<RealTaper>(random_taper);
}

/// At `least` to `most` of where they touch along the line of centres.
ReachPair random_taper_pair(Dice& dice, double least, double most) {
  ReachPair pair;
  pair.a = random_taper(dice, 0.1, 3);
  switch (dice.between(0, 5)) {
    case 0:
      pair.b = Shape::sphere(dice.size(0.1, 3));
      break;
    case 1:
      pair.b = Shape::capsule(dice.size(0.1, 3), dice.size(0.1, 3));
      break;
    case 2:
      pair.b = Shape::cylinder(dice.size(0.1, 3), dice.size(0.1, 3));
      break;
    case 3:
      pair.b = Shape::cone(dice.size(0.1, 3), dice.size(0.1, 3));
      break;
    case 4:
      pair.b = random_taper(dice, 0.1, 3);
      break;
    default:
      pair.b = dice.shape(ShapeKind::box, 0.1, 3);
  }
  pair.rotation_a = to_matrix(dice.orientation());
  pair.rotation_b = to_matrix(dice.orientation());
  if (dice.chance(2)) {
    std::swap(pair.a, pair.b);
    std::swap(pair.rotation_a, pair.rotation_b);
  }
  const RealVec n = dice.direction();
  pair.place(dice, n, least, most);
  return pair;
}

TEST(TaperedCapsules, AreApartByTheDistanceAlongItsNormal) {
  expect_distances_along_normals(random_taper_pair, 6000, 2e-6);
}

TEST(TaperedCapsules, OverlapByTheDepthAlongItsNormal) {
  expect_depths_along_normals(random_taper_pair, 6000, 500);
}

TEST(TaperedCapsules, TouchAtTheirLeastSeparation) {
  expect_contacts_at_least_separation(random_taper_pair, 6000);
}

TEST(TaperedCapsules, AreMetBySweptShapesWhereTheyTouch) {
  expect_casts_end_where_shapes_touch(random_taper_pair);
}

TEST(TaperedCapsules, StandOnOnePointAndLieOnTwo) {
  const Mat3 upright;
  const Shape floor = Shape::box(metres(5), metres(1), metres(5)), plane = Shape::half_space();
  const Shape taper = Shape::tapered_capsule(metres(1), metres(0.5), metres(0.2));
  const RealTaper truth(taper);
  const double tilt = std::asin(0.3);  // the side is so much steeper than the axis
  const Mat3 lying = turned(0, 0, 1, std::acos(-1.0) / 2 + tilt);
  for (const Shape& ground : {floor, plane}) {
    const double top = ground == floor ? 1 : 0;
    const auto meet = [&](const Mat3& rotation) {
      const RealVec down{0, -1, 0};
      const auto low = static_cast<double>(truth.reach(in_frame(rotation, down)));
      return collide({ground, upright}, {taper, rotation}, metres(0, top + low - 0.001, 0),
                     metres(0.02));
    };
    const Manifold standing = meet(upright);
    ASSERT_EQ(standing.count, 1);
    EXPECT_EQ(standing.normal, upright.y);
    EXPECT_NEAR(as_double(standing.points[0].separation), -0.001, 2e-6);
    const Manifold on_side = meet(lying);
    ASSERT_EQ(on_side.count, 2);
    EXPECT_EQ(on_side.normal, upright.y);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(as_double(on_side.points[i].separation), -0.001, 2e-6);
    const Real span = norm(real(on_side.points[0].anchor_b) - real(on_side.points[1].anchor_b));
    EXPECT_NEAR(static_cast<double>(span), std::sqrt(1 - 0.09), 4e-6);
  }
}

// Nearly a cylinder, along a face: its side falls by micrometres from one end of the face to the
// other. Contact points are on the side wherever it is deepest.
TEST(TaperedCapsules, AlongAFaceTouchItWithTheirSide) {
  constexpr double k_rounding = 1e-4;
  const Mat3 upright;
  Dice dice;
  int beside = 0;
  for (int i = 0; i < test::share_of(6000); ++i) {
    const double size = std::exp(dice.uniform(std::log(0.1), std::log(60)));
    const double x = size * dice.uniform(0.3, 1), y = size * dice.uniform(0.3, 1),
                 z = size * dice.uniform(0.3, 1);
    const double length = size * std::exp(dice.uniform(std::log(0.5), std::log(8)));
    const double radius = std::max(0.002, size * std::exp(dice.uniform(std::log(1e-3), -1.2)));
    const double other = radius * (1 - std::exp(dice.uniform(std::log(1e-6), std::log(0.5))));
    const Shape box = Shape::box(metres(x), metres(y), metres(z));
    const Shape taper = Shape::tapered_capsule(metres(length), metres(radius), metres(other));
    const double gap = std::max(-0.5 * other, size * dice.uniform(-0.01, 0.001));
    const Vec3<Length> offset = metres(x + radius + gap, dice.uniform(-0.6, 0.6) * (length + y),
                                       dice.uniform(-0.95, 0.95) * z);
    const Manifold met = collide({box, upright}, {taper, upright}, offset, metres(0.02 * size));
    for (std::size_t k = 0; k < static_cast<std::size_t>(met.count); ++k) {
      const RealVec at = real(met.points[k].anchor_b);
      const auto from_axis = static_cast<double>(std::hypot(at.x, at.z));
      ASSERT_LE(from_axis, radius + k_rounding) << "pair " << i << ", point " << k;
      ++beside;
    }
  }
  EXPECT_GT(beside, test::share_of(4000));
}

// A turning club that swings past: up to its time of impact the distance is not less than the
// target by more than rounding. A pair that begins nearer than the target is a hit at once.
TEST(TaperedCapsules, ReachTheirTimeOfImpactApart) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < test::share_of(600); ++i) {
    ReachPair pair = random_taper_pair(dice, 1.1, 2.5);
    const auto sweep = [&](const Quat& turned, const RealVec& at, const RealVec& way) {
      Sweep s;
      s.start.position = rounded<Position>(metres(at));
      s.start.orientation = turned;
      s.translation = rounded<Position>(metres(way));
      for (int k = 0; k < 3; ++k)
        s.rotation[k] =
            decltype(s.rotation.x)::from_raw(static_cast<decltype(s.rotation.x)::Representation>(
                std::ldexp(dice.uniform(-2, 2), decltype(s.rotation.x)::frac_bits)));
      return s;
    };
    const Quat of_a = dice.orientation(), of_b = dice.orientation();
    const RealVec offset = real(pair.offset);
    const Sweep sweep_a = sweep(of_a, {}, {}), sweep_b = sweep(of_b, offset, offset * -1);
    const SweptShape a{pair.a, sweep_a}, b{pair.b, sweep_b};
    const TimeOfImpactLimits limits{metres(0.001), metres(0.0005), 64};
    const TimeOfImpact found = time_of_impact(a, b, limits);
    if (found.state != TimeOfImpactState::hit) continue;
    ++hits;
    if (as_double(found.distance) < 0.001) {
      EXPECT_EQ(found.fraction, Unit{}) << pair.text();
      continue;
    }
    for (int k = 0; k <= 8; ++k) {
      const Unit at =
          Unit::from_raw(static_cast<std::int32_t>(std::int64_t{found.fraction.raw} * k / 8));
      const Transform pose_a = pose_at(a.sweep, at), pose_b = pose_at(b.sweep, at);
      const Mat3 turned_a = to_matrix(pose_a.orientation), turned_b = to_matrix(pose_b.orientation);
      const Vec3<Length> between = metres(real(pose_b.position) - real(pose_a.position));
      const ClosestPoints gap = distance({pair.a, turned_a}, {pair.b, turned_b}, between);
      ASSERT_GT(as_double(gap.distance), 0.001 - 1e-5) << pair.text();
    }
  }
  EXPECT_GT(hits, test::share_of(150));
}

}  // namespace
}  // namespace lockstone::test
