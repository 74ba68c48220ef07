// Cylinders and cones: sizes, masses, rays, distances and contacts against long double.
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/dispatch/raycast.h"
#include "tests/geometry/pairs/pair_laws.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

constexpr std::array<ShapeKind, 2> k_rim_kinds{ShapeKind::cylinder, ShapeKind::cone};

Shape rim_shape(ShapeKind kind, Length x, Length y) {
  return kind == ShapeKind::cylinder ? Shape::cylinder(y, x) : Shape::cone(y, x);
}

Shape random_rim_shape(Dice& dice, double low, double high) {
  const ShapeKind kind = k_rim_kinds[dice.chance(2) ? 0 : 1];
  return rim_shape(kind, dice.size(low, high), dice.size(low, high));
}

TEST(RimShapes, HaveTheMassOfTheClosedForm) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_rim_shape(dice, 0.001, 512);
    const Real r = real(shape.size.x), y = real(shape.size.y);
    const Real volume = k_real_pi * r * r * (shape.kind == ShapeKind::cone ? y / 3 : 2 * y);
    const Density density = Density::from_raw(static_cast<std::int32_t>(dice.between(1, 1 << 22)));
    const Real truth = volume * real(density), step = std::ldexp(Real{1}, -Mass::frac_bits);
    if (truth > std::ldexp(Real{1}, 31) * (1 - 1e-9L)) continue;
    ASSERT_NEAR(static_cast<double>(real(mass_of(shape, density)) / truth), 1,
                static_cast<double>(1e-15L + step * 0.501L / truth))
        << describe(shape);
  }
}

TEST(RimShapes, HaveTheInertiaOfTheClosedForm) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_rim_shape(dice, 0.001, 512);
    const Real r = real(shape.size.x), y = real(shape.size.y);
    const bool cone = shape.kind == ShapeKind::cone;
    const Real axial = r * r * (cone ? 0.3L : 0.5L);
    const Real across = cone ? r * r * 3 / 20 + y * y * 3 / 80 : r * r / 4 + y * y / 3;
    const Real scale = std::ldexp(Real{1}, scale_exponent(shape));
    const RealVec found = real(normalized_inertia(shape)) * (scale * scale);
    const Real step = std::ldexp(scale * scale, -29);
    ASSERT_NEAR(static_cast<double>(found.x), static_cast<double>(across),
                static_cast<double>(step));
    ASSERT_NEAR(static_cast<double>(found.y), static_cast<double>(axial),
                static_cast<double>(step));
    ASSERT_EQ(found.x, found.z);
  }
}

TEST(RimShapes, LieBetweenTheirRadii) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_rim_shape(dice, 0.001, 512);
    const RealVec n = dice.direction();
    const Real reach = RealRims(shape).reach(n);
    ASSERT_LE(reach, real(bounding_radius(shape)));
    ASSERT_GE(reach, real(inner_radius(shape)) - std::ldexp(Real{1}, -20)) << describe(shape);
  }
}

TEST(RimShapes, AreWithinTheirBoundsAndNearlyTouchThem) {
  Dice dice;
  for (int i = 0; i < test::share_of(10000); ++i) {
    const Shape shape = random_rim_shape(dice, 0.001, 512);
    const Mat3 rotation = to_matrix(dice.orientation());
    const RealVec found = real(world_half_extents(shape, rotation));
    for (int k = 0; k < 3; ++k) {
      RealVec axis;
      axis[k] = 1;
      const RealRims rims(shape);
      const Real reach =
          std::max(rims.reach(in_frame(rotation, axis)), rims.reach(in_frame(rotation, axis * -1)));
      ASSERT_GE(found[k], reach - 1e-12L) << describe(shape);
      ASSERT_LE(found[k], reach + 3 * k_micrometre + reach * 3e-9L) << describe(shape);
    }
  }
}

// A ray at a random cylinder or cone, in the shape's frame.
struct RimRay {
  explicit RimRay(Dice& dice) : shape(random_rim_shape(dice, 0.05, 20)), rims(shape) {
    const Mat3 rotation = to_matrix(dice.orientation());
    const Real size = real(bounding_radius(shape));
    const RealVec from = dice.direction() * (size * static_cast<Real>(dice.uniform(0.1, 4)));
    const RealVec to = dice.direction() * (size * static_cast<Real>(dice.uniform(0, 1)));
    const Vec3<Length> origin = metres(from), way = metres((to - from) * 2);
    hit = cast_ray(shape, rotation, origin, way);
    start = in_frame(rotation, real(origin));
    step = in_frame(rotation, real(way));
    normal = in_frame(rotation, real(hit.normal));
    slack = 4 * k_micrometre + size * 1e-8L;
  }

  [[nodiscard]] RealVec at(Real fraction) const { return start + step * fraction; }
  /// Of the hit.
  [[nodiscard]] Real fraction() const { return real(hit.fraction); }
  [[nodiscard]] bool begins_inside() const { return hit.hit && hit.fraction == Unit{}; }

  Shape shape;
  RealRims rims;
  ShapeRayHit hit;
  RealVec start, step, normal;
  Real slack;
};

TEST(RimShapes, RaysThatMissStayOutside) {
  Dice dice;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const RimRay ray(dice);
    for (int k = 0; k <= 64 && !ray.hit.hit; ++k)
      ASSERT_GT(ray.rims.beyond(ray.at(Real{1} * k / 64)), -ray.slack) << describe(ray.shape);
  }
}

TEST(RimShapes, RaysEnterWhereTheSurfaceIs) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const RimRay ray(dice);
    if (!ray.hit.hit) continue;
    ++hits;
    if (ray.begins_inside()) {
      ASSERT_LE(ray.rims.beyond(ray.start), ray.slack);
      continue;
    }
    const Real f = ray.fraction();
    ASSERT_LE(std::fabs(ray.rims.beyond(ray.at(f))), ray.slack + norm(ray.step) * 2e-9L)
        << describe(ray.shape);
    for (int k = 0; k < 32; ++k)
      ASSERT_GT(ray.rims.beyond(ray.at(f * k / 32)), -ray.slack) << describe(ray.shape);
  }
  EXPECT_GT(hits, test::share_of(5000));
}

TEST(RimShapes, NormalsOfRaysAreThoseOfAPlaneThatTheShapeLiesBelow) {
  Dice dice;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const RimRay ray(dice);
    if (!ray.hit.hit || ray.begins_inside()) continue;
    const Real height = dot(ray.normal, ray.at(ray.fraction()));
    ASSERT_LE(ray.rims.reach(ray.normal) - height, ray.slack * 20) << describe(ray.shape);
  }
}

// Also along the axis, where no side is nearer than the others.
TEST(RimShapes, FacesHaveUnitNormals) {
  Dice dice;
  for (int i = 0; i < test::share_of(2000); ++i) {
    const Shape shape = random_rim_shape(dice, 0.05, 20);
    const auto is_unit = [&](const Vec3<Unit>& axis) {
      return geometry::is_unit(geometry::traits_of(shape).face_along(shape, axis));
    };
    ASSERT_TRUE(is_unit(Mat3{}.y) && is_unit(-Mat3{}.y)) << describe(shape);
    ASSERT_TRUE(is_unit(to_matrix(dice.orientation()).x)) << describe(shape);
  }
}

/// At `least` to `most` of where they touch along the line of centres.
ReachPair random_rim_pair(Dice& dice, double least, double most) {
  ReachPair pair;
  pair.a = random_rim_shape(dice, 0.1, 3);
  const int other = static_cast<int>(dice.between(0, 4));
  pair.b = other < 3 ? dice.shape(static_cast<ShapeKind>(other), 0.1, 3)
                     : random_rim_shape(dice, 0.1, 3);
  pair.rotation_a = to_matrix(dice.orientation());
  pair.rotation_b = to_matrix(dice.orientation());
  const RealVec n = dice.direction();
  pair.place(dice, n, least, most);
  return pair;
}

TEST(RimShapes, AreApartByTheDistanceAlongItsNormal) {
  expect_distances_along_normals(random_rim_pair, 6000, 4e-6);
}

TEST(RimShapes, OverlapByTheDepthAlongItsNormal) {
  expect_depths_along_normals(random_rim_pair, 6000, 500);
}

TEST(RimShapes, TouchAtTheirLeastSeparation) {
  expect_contacts_at_least_separation(random_rim_pair, 6000);
}

TEST(RimShapes, AreMetBySweptShapesWhereTheyTouch) {
  expect_casts_end_where_shapes_touch(random_rim_pair);
}

TEST(RimShapes, StandOnFourPointsOfAFlatFace) {
  const Mat3 upright;
  const Shape floor = Shape::box(metres(5), metres(1), metres(5)), plane = Shape::half_space();
  for (const ShapeKind kind : k_rim_kinds) {
    const Shape shape = rim_shape(kind, metres(0.5), metres(1));
    const double base = kind == ShapeKind::cone ? 0.25 : 1;
    for (const Shape& ground : {floor, plane}) {
      const double top = ground == floor ? 1 : 0;
      const Manifold m = collide({ground, upright}, {shape, upright},
                                 metres(0, top + base - 0.001, 0), metres(0.02));
      ASSERT_EQ(m.count, 4);
      EXPECT_EQ(m.normal, upright.y);
      EXPECT_EQ(features_of(m).size(), 4U);
      Real widest = 0;
      for (const ManifoldPoint& p : m.points) {
        EXPECT_NEAR(static_cast<double>(real(p.separation)), -0.001, 1e-6);
        EXPECT_NEAR(std::hypot(as_double(p.anchor_b.x), as_double(p.anchor_b.z)), 0.5, 2e-6);
        widest = std::max(widest, norm(real(p.anchor_b) - real(m.points[0].anchor_b)));
      }
      EXPECT_GT(widest, 0.9L);
    }
  }
}

TEST(RimShapes, LieOnTwoPointsOfTheLineThatTouches) {
  const Mat3 upright, lying = turned(1, 0, 0, std::acos(-1.0) / 2);
  const Shape floor = Shape::box(metres(5), metres(1), metres(5)), plane = Shape::half_space();
  const Shape roller = Shape::cylinder(metres(1), metres(0.5));
  for (const Shape& ground : {floor, plane}) {
    const double top = ground == floor ? 1 : 0;
    const Manifold m =
        collide({ground, upright}, {roller, lying}, metres(0, top + 0.4999, 0), metres(0.02));
    ASSERT_EQ(m.count, 2);
    EXPECT_EQ(m.normal, upright.y);
    for (int i = 0; i < 2; ++i) {
      const ManifoldPoint& p = m.points[static_cast<std::size_t>(i)];
      EXPECT_NEAR(as_double(p.anchor_b.x), 0, 2e-6);
      EXPECT_NEAR(as_double(p.anchor_b.y), -0.5, 2e-6);
      EXPECT_NEAR(std::fabs(as_double(p.anchor_b.z)), 1, 2e-6);
    }
  }
}

TEST(RimShapes, RollOnEachOtherAlongTheirCommonLine) {
  const Mat3 lying = turned(1, 0, 0, std::acos(-1.0) / 2);
  const Shape lower = Shape::cylinder(metres(1), metres(0.5));
  const Shape upper = Shape::cylinder(metres(0.6), metres(0.3));
  const Manifold m =
      collide({lower, lying}, {upper, lying}, metres(0.48, 0.6399, 0.1), metres(0.02));
  ASSERT_EQ(m.count, 2);
  EXPECT_NEAR(as_double(m.normal.x), 0.6, 1e-4);
  EXPECT_NEAR(as_double(m.normal.z), 0, 1e-9);
}

TEST(RimShapes, MeetASweptShapeWhereTheyTouch) {
  const Mat3 upright;
  const Shape drum = Shape::cylinder(metres(1), metres(0.5)), ball = Shape::sphere(metres(0.25));
  const ShapeCastHit side =
      cast_shape({drum, upright}, {ball, upright}, metres(3, 0, 0), metres(-4, 0, 0), Unit::max());
  ASSERT_TRUE(side.hit);
  EXPECT_NEAR(as_double(side.fraction), 2.25 / 4, 2e-6);
  EXPECT_NEAR(as_double(side.normal.x), 1, 1e-6);
  const ShapeCastHit top = cast_shape({drum, upright}, {ball, upright}, metres(0.2, 3, 0.1),
                                      metres(0, -4, 0), Unit::max());
  ASSERT_TRUE(top.hit);
  EXPECT_NEAR(as_double(top.fraction), 1.75 / 4, 2e-6);
}

}  // namespace
}  // namespace lockstone::test
