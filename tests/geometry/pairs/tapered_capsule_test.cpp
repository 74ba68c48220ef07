// Tapered capsules: sizes, masses, rays, distances, depths and contacts against long double.
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

const Real k_taper_pi = std::acos(Real{-1});

template <class Quantity>
double taper_number(Quantity x) {
  return static_cast<double>(real(x));
}

/// The hull of two balls in long double, by sums over slices across its axis.
struct RealTaper {
  Real low_radius, high_radius, length;
  Real centre = 0;  ///< of mass, above the lower ball's

  explicit RealTaper(const Shape& shape)
      : low_radius(real(shape.size.x)),
        high_radius(real(shape.size.z)),
        length(real(shape.size.y)) {
    const Real greater = std::max(low_radius, high_radius);
    if (std::fabs(low_radius - high_radius) >= length) {
      low_radius = high_radius = greater;
      length = 0;
    }
    centre = integral([](Real rr, Real y) { return rr * y; }) /
             integral([](Real rr, Real) { return rr; });
  }

  [[nodiscard]] Real slope() const { return length > 0 ? (low_radius - high_radius) / length : 0; }

  /// ∫ f(r², y) dy, y from the lower ball's centre, by Gauss and Legendre on each piece: exact for
  /// the polynomials at hand.
  template <class F>
  [[nodiscard]] Real integral(F f) const {
    const Real s = slope(), cc = 1 - s * s;
    const Real first = low_radius * s, last = length + high_radius * s;
    const auto of_ball = [](Real r, Real up) { return r * r - up * up; };
    const auto of_side = [&](Real y) {
      const Real share = last > first ? (y - first) / (last - first) : 0;
      const Real r = low_radius + (high_radius - low_radius) * share;
      return r * r * cc;
    };
    return piece(-low_radius, first, [&](Real y) { return f(of_ball(low_radius, y), y); }) +
           piece(first, last, [&](Real y) { return f(of_side(y), y); }) +
           piece(last, length + high_radius,
                 [&](Real y) { return f(of_ball(high_radius, y - length), y); });
  }

  template <class F>
  static Real piece(Real from, Real to, F f) {
    const std::array<Real, 3> places{0, 0.538469310105683091036314420700208805L,
                                     0.906179845938663992797626878299392965L};
    const std::array<Real, 3> weights{0.568888888888888888888888888888888889L,
                                      0.478628670499366468041291514835638193L,
                                      0.236926885056189087514264040719917363L};
    const Real middle = (from + to) / 2, half = (to - from) / 2;
    Real sum = weights[0] * f(middle);
    for (std::size_t i = 1; i < 3; ++i)
      sum += weights[i] * (f(middle - half * places[i]) + f(middle + half * places[i]));
    return sum * half;
  }

  [[nodiscard]] Real reach(const RealVec& n) const {
    return std::max(-centre * n.y + low_radius, (length - centre) * n.y + high_radius);
  }
  /// Distance from the surface, negative inside: of the ball that is nearest, by thirds.
  [[nodiscard]] Real outside(const RealVec& p) const {
    const auto gap = [&](Real along) {
      const RealVec from{p.x, p.y + centre - along, p.z};
      return norm(from) - low_radius + along * slope();
    };
    Real low = 0, high = length;
    for (int i = 0; i < 120; ++i) {
      const Real first = low + (high - low) / 3, second = high - (high - low) / 3;
      (gap(first) > gap(second) ? low : high) = gap(first) > gap(second) ? first : second;
    }
    return gap((low + high) / 2);
  }
};

RealVec in_taper_frame(const Mat3& rotation, const RealVec& v) {
  return {dot(real(rotation.x), v), dot(real(rotation.y), v), dot(real(rotation.z), v)};
}

Shape random_taper(Dice& dice, double low, double high) {
  const Length bottom = dice.size(low, high);
  return Shape::tapered_capsule(dice.size(low, high), bottom,
                                dice.chance(8) ? bottom : dice.size(low, high));
}

Real taper_reach_of(const PosedShape& posed, const RealVec& n) {
  const RealVec local = in_taper_frame(posed.rotation, n);
  const RealVec size = real(posed.shape.size);
  const Real flat = std::sqrt(local.x * local.x + local.z * local.z);
  switch (posed.shape.kind) {
    case ShapeKind::tapered_capsule:
      return RealTaper(posed.shape).reach(local);
    case ShapeKind::cylinder:
      return std::fabs(local.y) * size.y + flat * size.x;
    case ShapeKind::cone:
      return std::max(local.y * size.y * 3 / 4, flat * size.x - local.y * size.y / 4);
    default:
      return Placed(posed, {}).reach(n);
  }
}

TEST(TaperedCapsules, HaveTheMassOfTheIntegral) {
  Dice dice;
  for (int i = 0; i < 10000; ++i) {
    const Shape shape = random_taper(dice, 0.001, 512);
    const Real volume = k_taper_pi * RealTaper(shape).integral([](Real rr, Real) { return rr; });
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
  for (int i = 0; i < 10000; ++i) {
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
  for (int i = 0; i < 1000; ++i) {
    const Length r = dice.size(0.01, 50), h = dice.size(0.01, 50);
    const Density density = Density::from_integer(1000);
    const Shape even = Shape::tapered_capsule(h + h, r, r), capsule = Shape::capsule(h, r);
    ASSERT_NEAR(taper_number(mass_of(even, density)) / taper_number(mass_of(capsule, density)), 1,
                1e-9);
    const RealVec apart = real(normalized_inertia(even)) - real(normalized_inertia(capsule));
    ASSERT_LT(norm(apart), 4e-9L);
    const Shape nested = Shape::tapered_capsule(r / 2, r / 4, r), ball = Shape::sphere(r);
    ASSERT_NEAR(taper_number(mass_of(nested, density)) / taper_number(mass_of(ball, density)), 1,
                1e-9);
    ASSERT_EQ(bounding_radius(nested), r);
  }
}

TEST(TaperedCapsules, LieBetweenTheirRadiiAndWithinTheirBounds) {
  Dice dice;
  for (int i = 0; i < 10000; ++i) {
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
      const Real most = std::max(truth.reach(in_taper_frame(rotation, axis)),
                                 truth.reach(in_taper_frame(rotation, axis * -1)));
      ASSERT_GE(found[k], most - 1e-12L) << describe(shape);
      ASSERT_LE(found[k], most + 2 * k_micrometre) << describe(shape);
    }
  }
}

TEST(TaperedCapsules, AreMetByRaysWhereTheirSurfaceIs) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < 6000; ++i) {
    const Shape shape = random_taper(dice, 0.05, 20);
    const RealTaper truth(shape);
    const Mat3 rotation = to_matrix(dice.orientation());
    const Real size = real(bounding_radius(shape));
    const RealVec from = dice.direction() * (size * static_cast<Real>(dice.uniform(0.1, 4)));
    const RealVec to = dice.direction() * (size * static_cast<Real>(dice.uniform(0, 1)));
    const Vec3<Length> origin = metres(from), way = metres((to - from) * 2);
    const ShapeRayHit hit = cast_ray(shape, rotation, origin, way);
    const RealVec start = in_taper_frame(rotation, real(origin));
    const RealVec step = in_taper_frame(rotation, real(way));
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
    const RealVec normal = in_taper_frame(rotation, real(hit.normal));
    ASSERT_LE(truth.reach(normal) - dot(normal, start + step * last), slack * 20)
        << describe(shape);
  }
  EXPECT_GT(hits, 1500);
}

struct TaperPair {
  Shape a, b;
  Mat3 rotation_a, rotation_b;
  Vec3<Length> offset;

  [[nodiscard]] PosedShape posed_a() const { return {a, rotation_a}; }
  [[nodiscard]] PosedShape posed_b() const { return {b, rotation_b}; }
  [[nodiscard]] Real separation(const RealVec& n) const {
    return dot(real(offset), n) - taper_reach_of(posed_a(), n) - taper_reach_of(posed_b(), n * -1);
  }
  [[nodiscard]] std::string text() const {
    return describe(a) + " R " + describe(rotation_a) + "\n" + describe(b) + " R " +
           describe(rotation_b) + "\n" + std::to_string(offset.x.raw) + "," +
           std::to_string(offset.y.raw) + "," + std::to_string(offset.z.raw);
  }
};

/// At `least` to `most` of where they touch along the line of centres.
TaperPair random_taper_pair(Dice& dice, double least, double most) {
  TaperPair pair;
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
  const Real touching = taper_reach_of(pair.posed_a(), n) + taper_reach_of(pair.posed_b(), n * -1);
  pair.offset = metres(n * (touching * static_cast<Real>(dice.uniform(least, most))));
  return pair;
}

TEST(TaperedCapsules, AreApartByTheDistanceAlongItsNormal) {
  Dice dice;
  for (int i = 0; i < 6000; ++i) {
    const TaperPair pair = random_taper_pair(dice, 0.9, 1.6);
    const ClosestPoints found = distance(pair.posed_a(), pair.posed_b(), pair.offset);
    const ClosestPoints back = distance(pair.posed_b(), pair.posed_a(), -pair.offset);
    ASSERT_EQ(found.distance, back.distance);
    ASSERT_EQ(found.normal, -back.normal);
    ASSERT_EQ(found.point_a, back.point_b);
    if (found.overlapping) continue;
    const Real apart = real(found.distance), along = pair.separation(real(found.normal));
    // Points on both surfaces are no nearer than the distance, planes separate by no more.
    ASSERT_NEAR(static_cast<double>(along), static_cast<double>(apart), 2e-6) << pair.text();
    const RealVec between = real(found.point_b) + real(pair.offset) - real(found.point_a);
    ASSERT_NEAR(static_cast<double>(norm(between)), static_cast<double>(apart), 4e-6)
        << pair.text();
  }
}

TEST(TaperedCapsules, OverlapByTheDepthAlongItsNormal) {
  Dice dice;
  int deep = 0;
  for (int i = 0; i < 6000; ++i) {
    const TaperPair pair = random_taper_pair(dice, 0.0, 1.0);
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

TEST(TaperedCapsules, TouchAtTheirLeastSeparation) {
  Dice dice;
  int contacts = 0;
  for (int i = 0; i < 6000; ++i) {
    const TaperPair pair = random_taper_pair(dice, 0.8, 1.05);
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
  EXPECT_GT(contacts, 1500);
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
      const auto low = static_cast<double>(truth.reach(in_taper_frame(rotation, down)));
      return collide({ground, upright}, {taper, rotation}, metres(0, top + low - 0.001, 0),
                     metres(0.02));
    };
    const Manifold standing = meet(upright);
    ASSERT_EQ(standing.count, 1);
    EXPECT_EQ(standing.normal, upright.y);
    EXPECT_NEAR(taper_number(standing.points[0].separation), -0.001, 2e-6);
    const Manifold on_side = meet(lying);
    ASSERT_EQ(on_side.count, 2);
    EXPECT_EQ(on_side.normal, upright.y);
    for (std::size_t i = 0; i < 2; ++i)
      EXPECT_NEAR(taper_number(on_side.points[i].separation), -0.001, 2e-6);
    const Real span = norm(real(on_side.points[0].anchor_b) - real(on_side.points[1].anchor_b));
    EXPECT_NEAR(static_cast<double>(span), std::sqrt(1 - 0.09), 4e-6);
  }
}

TEST(TaperedCapsules, AreMetBySweptShapesWhereTheyTouch) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const TaperPair pair = random_taper_pair(dice, 1.5, 3);
    const Vec3<Length> way = metres(real(pair.offset) * -1 + dice.direction() * 0.3L);
    const ShapeCastHit hit =
        cast_shape(pair.posed_a(), pair.posed_b(), pair.offset, way, Unit::max());
    if (!hit.hit || hit.overlapping) continue;
    ++hits;
    TaperPair there = pair;
    there.offset = metres(real(pair.offset) + real(way) * real(hit.fraction));
    ASSERT_NEAR(static_cast<double>(there.separation(real(hit.normal))), 0, 6e-6) << pair.text();
  }
  EXPECT_GT(hits, 500);
}

// A turning club that swings past: up to its time of impact the distance is not less than the
// target by more than rounding.
TEST(TaperedCapsules, ReachTheirTimeOfImpactApart) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < 600; ++i) {
    TaperPair pair = random_taper_pair(dice, 1.1, 2.5);
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
    for (int k = 0; k <= 8; ++k) {
      const Unit at =
          Unit::from_raw(static_cast<std::int32_t>(std::int64_t{found.fraction.raw} * k / 8));
      const Transform pose_a = pose_at(a.sweep, at), pose_b = pose_at(b.sweep, at);
      const Mat3 turned_a = to_matrix(pose_a.orientation), turned_b = to_matrix(pose_b.orientation);
      const Vec3<Length> between = metres(real(pose_b.position) - real(pose_a.position));
      const ClosestPoints gap = distance({pair.a, turned_a}, {pair.b, turned_b}, between);
      ASSERT_GT(taper_number(gap.distance), 0.001 - 1e-5) << pair.text();
    }
  }
  EXPECT_GT(hits, 150);
}

}  // namespace
}  // namespace lockstone::test
