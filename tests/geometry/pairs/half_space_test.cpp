// Half-spaces against everything, and rays against half-spaces and polytopes.
#include "core/geometry/dispatch/raycast.h"
#include "tests/geometry/pairs/polytope_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

/// A random bounded body over or in a half-space.
struct PlaneScene {
  TestPolytopePtr polytope;
  Shape shape;
  Mat3 plane;
  Mat3 rotation;
  Vec3<Length> offset;
  Length margin = metres(0.1);

  [[nodiscard]] PosedShape body() const {
    return {shape, rotation, polytope ? &polytope->view() : nullptr};
  }
  [[nodiscard]] Manifold collide() const {
    return lockstone::collide({Shape::half_space(), plane}, body(), offset, margin);
  }
  [[nodiscard]] RealVec normal() const { return real(plane.y) * (1 / norm(real(plane.y))); }
  /// The error by rounding.
  [[nodiscard]] Real tolerance() const {
    const RealSolid solid = real_solid(body(), {});
    Real size = norm(real(offset)) + solid.radius;
    for (const RealVec& v : solid.vertices)
      size = std::max(size, norm(v) + norm(real(offset)));
    return 2e-6L + 4e-9L * size;
  }
  /// Height of the lowest point.
  [[nodiscard]] Real lowest() const {
    return -real_solid(body(), real(offset)).reach(normal() * -1);
  }
};

template <class Check>
void for_random_planes(Check check) {
  Dice dice;
  for (int i = 0; i < test::share_of(4000); ++i) {
    PlaneScene scene;
    const ShapeKind kind = k_kinds_beside_hulls[static_cast<std::size_t>(i % 4)];
    const double size = std::exp(dice.uniform(std::log(0.01), std::log(400)));
    if (kind == ShapeKind::hull) {
      scene.polytope = random_polytope(dice, size);
      scene.shape = {ShapeKind::hull, {}, {3}};
    } else {
      scene.shape = dice.shape(kind, size / 5, size);
    }
    scene.plane = to_matrix(dice.orientation());
    scene.rotation = dice.chance(6) ? scene.plane : to_matrix(dice.orientation());
    scene.offset = metres(dice.direction() * size);
    const Real wanted = dice.uniform(-0.5, 0.2) * (dice.chance(3) ? size : 0.2);
    const Real move = wanted - scene.lowest();
    scene.offset = scene.offset + metres(scene.normal() * move);
    check(scene);
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(HalfSpace, FindsTheDepthOfTheLowestPoint) {
  for_random_planes([](const PlaneScene& scene) {
    const Real truth = scene.lowest();
    const Real tolerance = scene.tolerance();
    const Manifold m = scene.collide();
    if (std::fabs(truth - 0.1L) < tolerance) return;
    ASSERT_EQ(m.count > 0, truth < 0.1L) << static_cast<double>(truth);
    if (m.count == 0 || truth < -127) return;
    const Real reduced = m.count == 4 ? 8e-6L : 0;  // k_deeper
    EXPECT_NEAR(static_cast<double>(deepest(m)), static_cast<double>(truth),
                static_cast<double>(tolerance + reduced));
    EXPECT_NEAR(static_cast<double>(norm(real(m.normal) - scene.normal())), 0, 4e-9);
    EXPECT_EQ(overlaps(scene.body(), {Shape::half_space(), scene.plane}, -scene.offset),
              deepest(m) <= 0);
  });
}

TEST(HalfSpace, PointsLieOnBothSurfaces) {
  for_random_planes([](const PlaneScene& scene) {
    const Manifold m = scene.collide();
    const RealSolid body = real_solid(scene.body(), real(scene.offset));
    const Real tolerance = scene.tolerance();
    for (int i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[static_cast<std::size_t>(i)];
      if (real(p.separation) < -127) continue;
      const Real depth = std::min<Real>(real(p.separation), 0);
      const Real of_plane = body.radius > 0 ? depth : depth / 2;  // else midway
      const RealVec on_plane = real(p.anchor_a) - scene.normal() * of_plane;
      const RealVec on_body =
          real(p.anchor_b) + real(scene.offset) + scene.normal() * (depth - of_plane);
      EXPECT_NEAR(static_cast<double>(dot(on_plane, scene.normal())), 0,
                  static_cast<double>(tolerance));
      EXPECT_LE(
          static_cast<double>(surface_distance(body, on_body) - lean_slack(body, scene.normal())),
          static_cast<double>(tolerance + body.radius / 1000));
      if (i > 0) {
        EXPECT_LT(m.points[static_cast<std::size_t>(i - 1)].feature, p.feature);
      }
    }
  });
}

TEST(HalfSpace, SwappedGivesTheFlippedManifold) {
  for_random_planes([](const PlaneScene& scene) {
    const Manifold m = scene.collide();
    const Manifold f =
        collide(scene.body(), {Shape::half_space(), scene.plane}, -scene.offset, scene.margin);
    ASSERT_EQ(m.count, f.count);
    EXPECT_EQ(m.normal, -f.normal);
    for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
      EXPECT_EQ(m.points[i].anchor_a, f.points[i].anchor_b);
      EXPECT_EQ(m.points[i].feature, f.points[i].feature);
    }
  });
}

TEST(HalfSpace, HoldsABoxAndAHullByTheFourCornersOfTheirBase) {
  const TestPolytope cube(box_points(0.5, 0.5, 0.5));
  const Body plane{Shape::half_space(), k_identity};
  for (const Body& body : {Body{Shape::box(metres(0.5), metres(0.5), metres(0.5)), k_identity},
                           Body{{ShapeKind::hull, {}, {1}}, k_identity, &cube.view()}}) {
    const Manifold m = collide(plane.posed(), body.posed(), metres(7, 0.49, -3), metres(0.02));
    ASSERT_EQ(m.count, 4);
    for (const ManifoldPoint& p : m.points) {
      EXPECT_EQ(abs(p.anchor_b.x), metres(0.5));
      EXPECT_EQ(abs(p.anchor_b.z), metres(0.5));
      EXPECT_NEAR(static_cast<double>(real(p.separation)), -0.01, 1e-6);
    }
  }
}

// Rays
// -------------------------------------------------------------------------------------------------

TEST(RayHalfSpace, MeetsThePlaneFromAboveOnly) {
  const PosedShape plane{Shape::half_space(), k_identity};
  const ShapeRayHit hit = cast_ray(plane, metres(3, 2, 1), metres(0, -8, 4));
  ASSERT_TRUE(hit.hit);
  EXPECT_EQ(hit.fraction, Unit::from_ratio(1, 4));
  EXPECT_EQ(hit.normal, (Vec3<Unit>{{}, Unit::from_integer(1), {}}));
  EXPECT_FALSE(cast_ray(plane, metres(3, 2, 1), metres(0, -1.9, 4)).hit);
  EXPECT_FALSE(cast_ray(plane, metres(3, 2, 1), metres(0, 8, 4)).hit);
  const ShapeRayHit inside = cast_ray(plane, metres(3, -2, 1), metres(0, 8, 4));
  EXPECT_TRUE(inside.hit);
  EXPECT_EQ(inside.fraction.raw, 0);
  EXPECT_EQ(inside.normal, Vec3<Unit>{});
}

struct RealRayHit {
  bool hit = false;
  Real fraction = 0;
};

/// Of a flat polytope: the point of its plane, in the polygon grown by `by` and by the shift from
/// the plane's own error.
RealRayHit reference_flat(const RealSolid& solid, const RealVec& o, const RealVec& t, Real by) {
  const Real height = dot(o - solid.faces[0][0], solid.normals[0]);
  const Real rise = dot(t, solid.normals[0]);
  const Real fraction = height / -rise;
  if (!(fraction >= -1e-6L && fraction <= 1 + 1e-6L)) return {};
  const Real grown = by * (1 + norm(t) / std::fabs(rise));
  const RealVec p = o + t * fraction;
  for (std::size_t i = 0; i < solid.faces[0].size(); ++i) {
    const RealVec from = solid.faces[0][i];
    const RealVec side =
        cross(solid.faces[0][(i + 1) % solid.faces[0].size()] - from, solid.normals[0]);
    if (dot(side, p - from) > grown * norm(side)) return {};
  }
  return {true, fraction};
}

/// Against planes pushed outward by `by`.
RealRayHit reference_ray(const RealSolid& solid, const RealVec& o, const RealVec& t, Real by) {
  if (solid.faces.size() == 2) return reference_flat(solid, o, t, by);
  Real enter = -1e30L, leave = 1;
  for (std::size_t i = 0; i < solid.faces.size(); ++i) {
    const Real height = dot(o - solid.faces[i][0], solid.normals[i]) - by;
    const Real rise = dot(t, solid.normals[i]);
    if (rise == 0 && height > 0) return {};
    if (rise < 0) enter = std::max(enter, height / -rise);
    if (rise > 0) leave = std::min(leave, -height / rise);
  }
  if (enter > leave || leave < 0) return {};
  return {true, std::max<Real>(enter, 0)};
}

// A ray at a random polytope, and where it meets one a little smaller and one a little larger.
struct PolytopeRay {
  explicit PolytopeRay(Dice& dice) {
    const double size = std::exp(dice.uniform(std::log(0.01), std::log(500)));
    const auto polytope = random_polytope(dice, size);
    const PosedShape posed{
        {ShapeKind::hull, {}, {1}}, to_matrix(dice.orientation()), &polytope->view()};
    solid = real_solid(posed, {});
    const Vec3<Length> origin = metres(dice.direction() * dice.uniform(0, 2 * size));
    const RealVec target = dice.direction() * (size * dice.uniform(0, 0.7));
    const Vec3<Length> translation = metres((target - real(origin)) * dice.uniform(0.5, 1.4));
    found = cast_ray(posed, origin, translation);
    way = real(translation);
    slack = 4e-6L + 4e-9L * size;
    small = reference_ray(solid, real(origin), way, -slack);
    large = reference_ray(solid, real(origin), way, slack);
  }

  [[nodiscard]] bool is_flat() const { return solid.faces.size() == 2; }
  [[nodiscard]] bool ends_at_the_surface() const {
    return small.fraction < 1e-6L || small.fraction > 1 - 1e-6L;
  }

  RealSolid solid;
  RealVec way;
  Real slack;
  ShapeRayHit found;
  RealRayHit small, large;
};

TEST(RayPolytope, HitsWherePlanesInLongDoubleSaySo) {
  Dice dice;
  int hits = 0;
  for (int i = 0; i < test::share_of(5000); ++i) {
    const PolytopeRay ray(dice);
    hits += ray.found.hit ? 1 : 0;
    if (ray.small.hit && !(ray.is_flat() && ray.ends_at_the_surface())) {
      ASSERT_TRUE(ray.found.hit);
    }
    if (!ray.large.hit) {
      ASSERT_FALSE(ray.found.hit);
    }
  }
  EXPECT_GT(hits, test::share_of(1000));
}

TEST(RayPolytope, EntersASolidBetweenASmallerAndALargerOne) {
  Dice dice;
  for (int i = 0; i < test::share_of(5000); ++i) {
    const PolytopeRay ray(dice);
    if (!ray.found.hit || ray.is_flat()) continue;
    const auto fraction = static_cast<double>(real(ray.found.fraction));
    ASSERT_GE(fraction, static_cast<double>(ray.large.fraction) - 1e-8);
    if (ray.small.hit) {
      ASSERT_LE(fraction, static_cast<double>(ray.small.fraction) + 1e-8);
    }
    EXPECT_EQ(ray.found.fraction.raw == 0, ray.found.normal == Vec3<Unit>{});
  }
}

TEST(RayPolytope, MeetsAFlatOneAtItsPlane) {
  Dice dice;
  for (int i = 0; i < test::share_of(5000); ++i) {
    const PolytopeRay ray(dice);
    if (!ray.found.hit || !ray.is_flat()) continue;
    const Real rise = std::fabs(dot(ray.way, ray.solid.normals[0]));
    ASSERT_NEAR(static_cast<double>(real(ray.found.fraction) * rise),
                static_cast<double>(ray.large.fraction * rise), static_cast<double>(2 * ray.slack));
  }
}

TEST(RayPolytope, MeetsATriangleWithinItsEdgesAndAOneSidedOneFromTheFront) {
  const std::vector loop{metres(-1, 0, 1), metres(1, 0, 1), metres(0, 0, -1)};
  const auto both = TestPolytope::flat(loop);
  const auto front = TestPolytope::flat(loop, true);
  const PosedShape plate{{ShapeKind::hull, {}, {1}}, k_identity, &both->view()};
  const PosedShape skin{{ShapeKind::hull, {}, {1}}, k_identity, &front->view()};
  for (const PosedShape& posed : {plate, skin}) {
    EXPECT_EQ(cast_ray(posed, metres(0, 1, 0), metres(0, -2, 0)).fraction, Unit::from_ratio(1, 2));
    EXPECT_TRUE(cast_ray(posed, metres(0.999, 1, 0.9999), metres(0, -2, 0)).hit);
    EXPECT_TRUE(cast_ray(posed, metres(0, 1, 1), metres(0, -2, 0)).hit);
    EXPECT_FALSE(cast_ray(posed, metres(0, 1, 1.0001), metres(0, -2, 0)).hit);
    EXPECT_FALSE(cast_ray(posed, metres(0, 1, 0), metres(0, -0.9, 0)).hit);
    EXPECT_FALSE(cast_ray(posed, metres(0, 1, 0), metres(2, 0, 0)).hit);
  }
  const ShapeRayHit behind = cast_ray(plate, metres(0, -1, 0), metres(0, 2, 0));
  EXPECT_TRUE(behind.hit);
  EXPECT_EQ(behind.normal.y, -Unit::from_integer(1));
  EXPECT_FALSE(cast_ray(skin, metres(0, -1, 0), metres(0, 2, 0)).hit);
}

}  // namespace
}  // namespace lockstone::test
