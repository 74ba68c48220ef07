// Laws that every pair of shapes obeys, over random scenes of all sizes.
#include <set>

#include "tests/geometry/scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

constexpr int k_scenes = test::share_of(4000);

bool is_pair_of(const Scene& scene, ShapeKind kind) {
  return scene.a.kind == kind && scene.b.kind == kind;
}

bool is_pair_of_sphere(const Scene& scene) {
  return scene.a.kind == ShapeKind::sphere || scene.b.kind == ShapeKind::sphere;
}

/// Of capsules: the error that two points along one may have is a share of it.
Real smallest_radius(const Scene& scene) {
  Real least = 1e30L;
  if (scene.a.kind == ShapeKind::capsule) least = std::min(least, real(scene.a.size.x));
  if (scene.b.kind == ShapeKind::capsule) least = std::min(least, real(scene.b.size.x));
  return least > 1e29L || is_pair_of_sphere(scene) ? 0 : least;
}

/// A capsule's core inside a box: the point is then the deepest of the core, not of the surface.
bool core_is_inside(const Scene& scene, Real separation) {
  const bool box = scene.a.kind == ShapeKind::box || scene.b.kind == ShapeKind::box;
  return box && separation < k_micrometre - smallest_radius(scene) && smallest_radius(scene) > 0;
}

/// The error by rounding of inputs, rotations and results.
Real tolerance(const Scene& scene) {
  return 2 * k_micrometre + scene.scale() * 4e-9L;
}

TEST(Collide, FindsTheDistanceOfShapesApart) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Real truth = signed_distance(scene.placed_a(), scene.placed_b());
    if (truth <= 0) return;
    const Real margin = real(scene.margin);
    // Faces are preferred within 2^-16 m; a capsule beside a rim within 1/2048 of the core's gap.
    const Real slack = tolerance(scene) + 16 * k_micrometre +
                       (truth + scene.placed_a().radius() + scene.placed_b().radius()) / 2000;
    expect_contacts_of_gap(scene.collide(), truth, margin, slack);
  });
}

TEST(Collide, FindsOverlapsHardlyDeeperThanTheLeastOverlap) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Real truth = signed_distance(scene.placed_a(), scene.placed_b());
    if (truth > -tolerance(scene)) return;
    expect_contacts_of_overlap(scene.collide(), truth, tolerance(scene));
  });
}

TEST(Collide, NormalsAreUnitVectors) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Manifold m = scene.collide();
    if (m.count == 0) return;
    EXPECT_NEAR(static_cast<double>(norm(real(m.normal))), 1.0, std::ldexp(2.0, -30));
  });
}

TEST(Collide, NoPointIsDeeperThanTheShapesAlongTheNormal) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Manifold m = scene.collide();
    if (m.count == 0) return;
    const RealVec n = real(m.normal);
    const Real along_normal =
        dot(n, real(scene.offset)) - scene.placed_a().reach(n) - scene.placed_b().reach(n);
    if (along_normal < -127) return;
    EXPECT_GE(static_cast<double>(deepest(m)),
              static_cast<double>(along_normal - tolerance(scene)));
  });
}

/// How far surface points may be off, beyond rounding: between boxes k_snap, and along a capsule
/// (two points share a normal that is square to neither core) a share of its radius.
Real surface_slack(const Scene& scene, const Placed& shape) {
  if (is_pair_of(scene, ShapeKind::box)) return 31 * k_micrometre;
  return smallest_radius(scene) > 0 ? shape.radius() / 1000 : 0;
}

Real lean_slack(const Placed& shape, const RealVec& normal) {
  if (shape.kind != ShapeKind::capsule) return 0;
  return end_within_side(shape.radius(), dot(shape.axes[1], normal));
}

TEST(Collide, AnchorsLieOnTheRoundSurfaceOrMidway) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Manifold m = scene.collide();
    const Placed a = scene.placed_a();
    const Placed b = scene.placed_b();
    for (int i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[static_cast<std::size_t>(i)];
      const Real separation = real(p.separation);
      if (separation < -127 || core_is_inside(scene, separation)) continue;
      RealVec on_a = real(p.anchor_a);
      RealVec on_b = real(p.anchor_b) + real(scene.offset);
      if (separation <= 0) {
        EXPECT_EQ(p.anchor_b, p.anchor_a - scene.offset);
        const Real share = share_of_a(scene.a, scene.b);
        on_a = on_a - real(m.normal) * (separation * share);
        on_b = on_b + real(m.normal) * (separation * (1 - share));
      }
      const auto expect_on_surface = [&](const Placed& shape, const RealVec& point) {
        const auto slack = static_cast<double>(tolerance(scene) + surface_slack(scene, shape));
        const auto outside = static_cast<double>(surface_distance(shape, point));
        EXPECT_LE(outside, slack);
        EXPECT_GE(outside, -slack - static_cast<double>(lean_slack(shape, real(m.normal))));
      };
      expect_on_surface(a, on_a);
      expect_on_surface(b, on_b);
    }
  });
}

TEST(Collide, SwappingTheShapesFlipsTheManifoldBitForBit) {
  // Two spheres touch halfway, and the odd half step of the midpoint stays with B.

  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Manifold m = scene.collide();
    const Manifold f = collide(scene.posed_b(), scene.posed_a(), -scene.offset, scene.margin);
    ASSERT_EQ(m.count, f.count);
    if (m.count == 0) return;
    EXPECT_EQ(m.normal, -f.normal);
    for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
      const int steps = is_pair_of(scene, ShapeKind::sphere) ? 1 : 0;
      const Vec3<Length> shift_a = m.points[i].anchor_a - f.points[i].anchor_b;
      const Vec3<Length> shift_b = m.points[i].anchor_b - f.points[i].anchor_a;
      for (int k = 0; k < 3; ++k) {
        EXPECT_LE(abs(shift_a[k]).raw, steps);
        EXPECT_LE(abs(shift_b[k]).raw, steps);
      }
      EXPECT_EQ(m.points[i].separation, f.points[i].separation);
      EXPECT_EQ(m.points[i].feature, f.points[i].feature);
    }
  });
}

TEST(Collide, KeepsOnlyPointsWithinTheMargin) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Manifold m = scene.collide();
    for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
      const Displacement s = m.points[i].separation;
      EXPECT_TRUE(s <= Displacement{} || real(s) < real(scene.margin));
    }
  });
}

TEST(Collide, FeaturesAreUniqueAndAscending) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Manifold m = scene.collide();
    for (std::size_t i = 1; i < static_cast<std::size_t>(m.count); ++i) {
      EXPECT_LT(m.points[i - 1].feature, m.points[i].feature);
    }
  });
}

Vec3<Length> mirror_image(const Vec3<Length>& v) {
  return {-v.x, v.y, v.z};
}
Vec3<Unit> mirror_image(const Vec3<Unit>& v) {
  return {-v.x, v.y, v.z};
}

/// The mirror image in x of a rotation of a shape that is its own mirror image: M·R·M.
Mat3 mirror_image(const Mat3& m) {
  return {-mirror_image(m.x), mirror_image(m.y), mirror_image(m.z)};
}

using PointKey = std::array<std::int32_t, 7>;

std::multiset<PointKey> points_of(const Manifold& m, bool mirror) {
  std::multiset<PointKey> points;
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
    const ManifoldPoint& p = m.points[i];
    const Vec3<Length> a = mirror ? mirror_image(p.anchor_a) : p.anchor_a;
    const Vec3<Length> b = mirror ? mirror_image(p.anchor_b) : p.anchor_b;
    points.insert({a.x.raw, a.y.raw, a.z.raw, b.x.raw, b.y.raw, b.z.raw, p.separation.raw});
  }
  return points;
}

TEST(Collide, MirrorImagesGiveMirrorImagesBitForBit) {
  // Left out, because a tie must fall to one side: boxes whose polygon had to be reduced (the
  // choice of four among more), the nearest of equally near vertices, the order of equal shapes,
  // and centres that lie level.
  int compared = 0;
  for_random_scenes(k_scenes, [&compared](Dice&, const Scene& scene) {
    Scene image = scene;
    image.rotation_a = mirror_image(scene.rotation_a);
    image.rotation_b = mirror_image(scene.rotation_b);
    image.offset = mirror_image(scene.offset);
    const Manifold m = scene.collide();
    const Manifold w = image.collide();
    ASSERT_EQ(m.count > 0, w.count > 0);
    if (m.count == 0 || (is_pair_of(scene, ShapeKind::box) && m.count + w.count > 2)) return;
    if (m.points[0].feature >> 13 == 3) return;
    if (scene.offset.x.raw == 0 || scene.offset.y.raw == 0 || scene.offset.z.raw == 0) return;
    if (scene.a == scene.b && scene.a.kind != ShapeKind::sphere) return;
    ++compared;
    EXPECT_EQ(m.normal, mirror_image(w.normal));
    EXPECT_EQ(points_of(m, false), points_of(w, true));
  });
  EXPECT_GT(compared, k_scenes);
}

TEST(Collide, ACommonRotationRotatesTheResult) {
  for_random_scenes(k_scenes / 2, [](Dice& dice, const Scene& scene) {
    const Mat3 turn = to_matrix(dice.orientation());
    Scene turned_scene = scene;
    const auto product = [&turn](const Mat3& m) {
      return Mat3{rotate(turn, m.x), rotate(turn, m.y), rotate(turn, m.z)};
    };
    turned_scene.rotation_a = product(scene.rotation_a);
    turned_scene.rotation_b = product(scene.rotation_b);
    turned_scene.offset = rotate(turn, scene.offset);
    const Real truth = signed_distance(scene.placed_a(), scene.placed_b());
    const Real slack = 2 * tolerance(scene) + 32 * k_micrometre + (std::fabs(truth) / 4000);
    if (std::fabs(truth - real(scene.margin)) < slack || truth < 0) return;
    const Manifold m = scene.collide();
    const Manifold t = turned_scene.collide();
    ASSERT_EQ(m.count > 0, t.count > 0);
    if (m.count == 0 || truth > 120) return;
    const Real rim = (scene.placed_a().radius() + scene.placed_b().radius()) / 2000;
    EXPECT_NEAR(static_cast<double>(deepest(m)), static_cast<double>(deepest(t)),
                static_cast<double>(slack + rim));
  });
}

TEST(Overlaps, AgreesWithAZeroMarginManifold) {
  for_random_scenes(k_scenes, [](Dice&, const Scene& scene) {
    const Manifold m = collide(scene.posed_a(), scene.posed_b(), scene.offset, {});
    EXPECT_EQ(overlaps(scene.posed_a(), scene.posed_b(), scene.offset), m.count > 0);
    const Real truth = signed_distance(scene.placed_a(), scene.placed_b());
    if (std::fabs(truth) > tolerance(scene) + 4 * k_micrometre) {
      EXPECT_EQ(m.count > 0, truth < 0);
    }
  });
}

}  // namespace
}  // namespace lockstone::test
