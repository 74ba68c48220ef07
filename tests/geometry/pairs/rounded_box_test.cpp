// Rounded boxes: sizes, masses, rays, distances, depths and contacts against long double.
#include "core/geometry/convex/compound_solid.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/dispatch/raycast.h"
#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/distance/motion/shape_cast.h"
#include "core/geometry/distance/motion/time_of_impact.h"
#include "tests/geometry/scene.h"

namespace lockstone::test {
namespace {

const Real k_round_pi = std::acos(Real{-1});

template <class Quantity>
double round_number(Quantity x) {
  return static_cast<double>(real(x));
}

/// A rounded box in long double.
struct RealRounded {
  RealVec half;
  Real radius;

  explicit RealRounded(const Shape& shape)
      : half(real(shape.size)), radius(real(shape.fourth_size())) {}

  /// ∫ f(z) A(z) dz over the sections across an axis, each a rectangle rounded by √(r² − t²): by
  /// Gauss and Legendre in the core, by Simpson's rule in the angle of the caps.
  template <class F>
  [[nodiscard]] Real integral(int axis, F f) const {
    const Real a = half[(axis + 1) % 3], b = half[(axis + 2) % 3], c = half[axis];
    const auto area = [&](Real round) {
      return 4 * a * b + 4 * round * (a + b) + k_round_pi * round * round;
    };
    const Real inner = c / std::sqrt(Real{3});  // exact for squares
    Real sum = area(radius) * c * (f(-inner) + f(inner));
    constexpr int k_steps = 512;
    for (int i = 0; i <= k_steps; ++i) {
      const Real angle = k_round_pi / 2 * i / k_steps;
      const Real t = radius * std::sin(angle), round = radius * std::cos(angle);
      const Real weight = i == 0 || i == k_steps ? 1 : 2 + 2 * (i % 2);
      sum += weight * round * area(round) * (f(c + t) + f(-c - t)) * k_round_pi / 2 / k_steps / 3;
    }
    return sum;
  }
  [[nodiscard]] Real volume() const {
    return integral(0, [](Real) { return 1; });
  }
  [[nodiscard]] Real square(int axis) const {
    return integral(axis, [](Real x) { return x * x; });
  }

  [[nodiscard]] Real reach(const RealVec& n) const {
    return std::fabs(n.x) * half.x + std::fabs(n.y) * half.y + std::fabs(n.z) * half.z +
           radius * norm(n);
  }
  /// Distance from the surface, negative inside.
  [[nodiscard]] Real outside(const RealVec& p) const {
    RealVec beyond;
    Real most = -1e30L;
    for (int k = 0; k < 3; ++k) {
      const Real over = std::fabs(p[k]) - half[k];
      most = std::max(most, over);
      beyond[k] = std::max(over, Real{0});
    }
    return (most > 0 ? norm(beyond) : most) - radius;
  }
};

RealVec in_round_frame(const Mat3& rotation, const RealVec& v) {
  return {dot(real(rotation.x), v), dot(real(rotation.y), v), dot(real(rotation.z), v)};
}

Shape random_rounded(Dice& dice, double low, double high) {
  const Length radius = dice.size(low, high);
  const auto core = [&] { return min(dice.size(low, high), k_max_shape_size - radius); };
  const Length x = core(), y = core(), z = core();
  return Shape::rounded_box(max(x, k_min_shape_size), max(y, k_min_shape_size),
                            max(z, k_min_shape_size), radius);
}

Real round_reach_of(const PosedShape& posed, const RealVec& n) {
  const RealVec local = in_round_frame(posed.rotation, n), size = real(posed.shape.size);
  const Real flat = std::sqrt(local.x * local.x + local.z * local.z);
  switch (posed.shape.kind) {
    case ShapeKind::rounded_box:
      return RealRounded(posed.shape).reach(local);
    case ShapeKind::cylinder:
      return std::fabs(local.y) * size.y + flat * size.x;
    case ShapeKind::cone:
      return std::max(local.y * size.y * 3 / 4, flat * size.x - local.y * size.y / 4);
    default:
      return Placed(posed, {}).reach(n);
  }
}

TEST(RoundedBoxes, HaveTheMassOfTheIntegral) {
  Dice dice;
  for (int i = 0; i < 3000; ++i) {
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
  for (int i = 0; i < 3000; ++i) {
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
    EXPECT_NEAR(round_number(mass_of(rounded, density)) / round_number(mass_of(other, density)), 1,
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
  for (int i = 0; i < 10000; ++i) {
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
      const Real most = truth.reach(in_round_frame(rotation, axis));
      ASSERT_GE(found[k], most - 1e-6L) << describe(shape);
      ASSERT_LE(found[k], most + 2 * k_micrometre) << describe(shape);
    }
  }
}

TEST(RoundedBoxes, HoldThePointsWithinTheirSurface) {
  Dice dice;
  int inside = 0;
  for (int i = 0; i < 20000; ++i) {
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
  EXPECT_GT(inside, 5000);
}

TEST(RoundedBoxes, ShrinkBelowTheirSurface) {
  Dice dice;
  for (int i = 0; i < 5000; ++i) {
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
  Dice dice;
  int hits = 0;
  for (int i = 0; i < 6000; ++i) {
    const Shape shape = random_rounded(dice, 0.05, 20);
    const RealRounded truth(shape);
    const Mat3 rotation = to_matrix(dice.orientation());
    const Real size = real(bounding_radius(shape));
    const RealVec from = dice.direction() * (size * static_cast<Real>(dice.uniform(0.1, 4)));
    const RealVec to = dice.direction() * (size * static_cast<Real>(dice.uniform(0, 1)));
    const Vec3<Length> origin = metres(from), way = metres((to - from) * 2);
    const ShapeRayHit hit = cast_ray(shape, rotation, origin, way);
    const RealVec start = in_round_frame(rotation, real(origin));
    const RealVec step = in_round_frame(rotation, real(way));
    const Real slack = 2 * k_micrometre + size * 1e-8L;
    const Real last = hit.hit ? real(hit.fraction) : 1;
    if (hit.hit && hit.fraction == Unit{}) {
      ASSERT_LE(truth.outside(start), slack);
      continue;
    }
    for (int k = 0; k <= 24 && (!hit.hit || k < 24); ++k)
      ASSERT_GT(truth.outside(start + step * (last * k / 24)), -slack) << describe(shape);
    if (!hit.hit) continue;
    ++hits;
    const Real at = truth.outside(start + step * last);
    ASSERT_LE(std::fabs(at), slack + norm(step) * 2e-9L) << describe(shape);
    const RealVec normal = in_round_frame(rotation, real(hit.normal));
    ASSERT_LE(truth.reach(normal) - dot(normal, start + step * last), slack * 20)
        << describe(shape);
  }
  EXPECT_GT(hits, 1500);
}

struct RoundedPair {
  Shape a, b;
  Mat3 rotation_a, rotation_b;
  Vec3<Length> offset;

  [[nodiscard]] PosedShape posed_a() const { return {a, rotation_a}; }
  [[nodiscard]] PosedShape posed_b() const { return {b, rotation_b}; }
  [[nodiscard]] Real separation(const RealVec& n) const {
    return dot(real(offset), n) - round_reach_of(posed_a(), n) - round_reach_of(posed_b(), n * -1);
  }
  [[nodiscard]] std::string text() const {
    return describe(a) + " R " + describe(rotation_a) + "\n" + describe(b) + " R " +
           describe(rotation_b) + "\n" + std::to_string(offset.x.raw) + "," +
           std::to_string(offset.y.raw) + "," + std::to_string(offset.z.raw) + " radii " +
           std::to_string(a.fourth_size().raw) + "," + std::to_string(b.fourth_size().raw);
  }
};

/// At `least` to `most` of where they touch along the line of centres.
RoundedPair random_rounded_pair(Dice& dice, double least, double most) {
  RoundedPair pair;
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
  const Real touching = round_reach_of(pair.posed_a(), n) + round_reach_of(pair.posed_b(), n * -1);
  pair.offset = metres(n * (touching * static_cast<Real>(dice.uniform(least, most))));
  return pair;
}

TEST(RoundedBoxes, AreApartByTheDistanceAlongItsNormal) {
  Dice dice;
  for (int i = 0; i < 6000; ++i) {
    const RoundedPair pair = random_rounded_pair(dice, 0.9, 1.6);
    const ClosestPoints found = distance(pair.posed_a(), pair.posed_b(), pair.offset);
    const ClosestPoints back = distance(pair.posed_b(), pair.posed_a(), -pair.offset);
    ASSERT_EQ(found.distance, back.distance);
    ASSERT_EQ(found.normal, -back.normal);
    ASSERT_EQ(found.point_a, back.point_b);
    if (found.overlapping) continue;
    const Real apart = real(found.distance), along = pair.separation(real(found.normal));
    ASSERT_NEAR(static_cast<double>(along), static_cast<double>(apart), 2e-6) << pair.text();
    const RealVec between = real(found.point_b) + real(pair.offset) - real(found.point_a);
    ASSERT_NEAR(static_cast<double>(norm(between)), static_cast<double>(apart), 4e-6)
        << pair.text();
  }
}

TEST(RoundedBoxes, OverlapByTheDepthAlongItsNormal) {
  Dice dice;
  int deep = 0;
  for (int i = 0; i < 6000; ++i) {
    const RoundedPair pair = random_rounded_pair(dice, 0.0, 1.0);
    const Penetration found = penetration(pair.posed_a(), pair.posed_b(), pair.offset);
    if (!found.overlapping) continue;
    if (distance(pair.posed_a(), pair.posed_b(), pair.offset).cores_overlap) ++deep;
    const RealVec normal = real(found.normal);
    const Real along = pair.separation(normal);
    ASSERT_NEAR(static_cast<double>(along), -static_cast<double>(real(found.depth)), 5e-6)
        << pair.text();
    for (int k = 0; k < 60; ++k) {
      // Half of them near the direction found.
      RealVec n = dice.direction();
      if (k % 2 == 0) n = normal + n * 0.05L;
      const Real other = pair.separation(n * (1 / norm(n)));
      ASSERT_LE(other, along + 5 * k_micrometre) << pair.text();
    }
  }
  EXPECT_GT(deep, 500);
}

TEST(RoundedBoxes, TouchAtTheirLeastSeparation) {
  Dice dice;
  int contacts = 0;
  for (int i = 0; i < 12000; ++i) {
    const RoundedPair pair = random_rounded_pair(dice, 0.8, 1.05);
    const Manifold m = collide(pair.posed_a(), pair.posed_b(), pair.offset, metres(0.01));
    const Manifold back = collide(pair.posed_b(), pair.posed_a(), -pair.offset, metres(0.01));
    ASSERT_EQ(m.count, back.count);
    if (m.count == 0) continue;
    ++contacts;
    ASSERT_EQ(m.normal, -back.normal);
    ASSERT_EQ(features_of(m).size(), static_cast<std::size_t>(m.count));
    ASSERT_NEAR(static_cast<double>(deepest(m)),
                static_cast<double>(pair.separation(real(m.normal))), 3e-5)
        << pair.text();
    const Penetration depth = penetration(pair.posed_a(), pair.posed_b(), pair.offset);
    if (depth.overlapping) {
      ASSERT_GE(deepest(m), -real(depth.depth) * 1.12L - 0.0006L) << pair.text();
    }
  }
  EXPECT_GT(contacts, 3000);
}

// Points ------------------------------------------------------------------------------------------

const Shape k_floor_of_die = Shape::box(metres(5), metres(1), metres(5));

/// The die on a floor of either kind, 1 mm deep, turned about z and x.
Manifold die_on(const Shape& ground, const Shape& die, const Mat3& rotation) {
  const Mat3 upright;
  const Real low = RealRounded(die).reach(in_round_frame(rotation, {0, -1, 0}));
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
      EXPECT_NEAR(round_number(m.points[i].separation), -0.001, 2e-6);
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
      EXPECT_NEAR(round_number(edge.points[i].separation), -0.001, 2e-6);
    const Real span = norm(real(edge.points[0].anchor_b) - real(edge.points[1].anchor_b));
    EXPECT_NEAR(static_cast<double>(span), 1, 4e-6);
    const Manifold corner = die_on(ground, die, on_corner);
    ASSERT_EQ(corner.count, 1);
    EXPECT_NEAR(round_number(corner.points[0].separation), -0.001, 3e-6);
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

TEST(RoundedBoxes, AreMetBySweptShapesWhereTheyTouch) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const RoundedPair pair = random_rounded_pair(dice, 1.5, 3);
    const Vec3<Length> way = metres(real(pair.offset) * -1 + dice.direction() * 0.3L);
    const ShapeCastHit hit =
        cast_shape(pair.posed_a(), pair.posed_b(), pair.offset, way, Unit::max());
    if (!hit.hit || hit.overlapping) continue;
    ++hits;
    RoundedPair there = pair;
    there.offset = metres(real(pair.offset) + real(way) * real(hit.fraction));
    ASSERT_NEAR(static_cast<double>(there.separation(real(hit.normal))), 0, 6e-6) << pair.text();
  }
  EXPECT_GT(hits, 500);
}

}  // namespace
}  // namespace lockstone::test
