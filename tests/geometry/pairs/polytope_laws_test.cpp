// Laws that every pair with a polytope obeys, over random scenes of all sizes.
#include "core/geometry/distance/separation.h"
#include "core/math/roots.h"
#include "tests/geometry/pairs/polytope_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

constexpr int k_polytope_scenes = test::share_of(300);

Real tolerance(const PolytopeScene& scene) {
  return 2 * k_micrometre + scene.scale() * 4e-9L;
}

/// Faces are preferred within 2^-16 m; a capsule beside a rim within 1/2048 of the core's gap.
Real choice_slack(const PolytopeScene& scene, Real truth) {
  const Real rim = scene.capsule_radius() > 0 ? (truth + scene.capsule_radius()) / 2000 : 0;
  return tolerance(scene) + 16 * k_micrometre + rim;
}

TEST(CollidePolytope, FindsTheDistanceOfShapesApart) {
  for_random_polytope_scenes(k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    const Real truth = signed_distance(scene.real_a(), scene.real_b());
    if (truth <= 0) return;
    expect_contacts_of_gap(scene.collide(), truth, real(scene.margin), choice_slack(scene, truth));
  });
}

TEST(CollidePolytope, FindsOverlapsHardlyDeeperThanTheLeastOverlap) {
  for_random_polytope_scenes(k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    const Real truth = signed_distance(scene.real_a(), scene.real_b());
    if (truth > -tolerance(scene)) return;
    expect_contacts_of_overlap(scene.collide(), truth, tolerance(scene));
  });
}

TEST(CollidePolytope, NormalsAreUnitVectors) {
  for_random_polytope_scenes(k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    const Manifold m = scene.collide();
    if (m.normal == Vec3<Unit>{}) {
      EXPECT_EQ(m.count, 0);
      return;
    }
    EXPECT_NEAR(static_cast<double>(norm(real(m.normal))), 1.0, std::ldexp(2.0, -30));
  });
}

TEST(CollidePolytope, NoPointIsDeeperThanTheShapesAlongTheNormal) {
  for_random_polytope_scenes(k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    const Manifold m = scene.collide();
    if (m.count == 0) return;
    const RealVec n = real(m.normal);
    const Real along_normal = -scene.real_b().reach(n * -1) - scene.real_a().reach(n);
    if (along_normal < -127) return;
    EXPECT_GE(static_cast<double>(deepest(m)),
              static_cast<double>(along_normal - tolerance(scene)));
  });
}

TEST(CollidePolytope, AnchorsLieOnTheRoundSurfaceOrMidway) {
  for_random_polytope_scenes(k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    const Manifold m = scene.collide();
    const RealSolid a = scene.real_a();
    const RealSolid b = scene.real_b();
    const Real radius = scene.capsule_radius();
    for (int i = 0; i < m.count; ++i) {
      const ManifoldPoint& p = m.points[static_cast<std::size_t>(i)];
      const Real separation = real(p.separation);
      const bool core_inside = radius > 0 && separation < k_micrometre - radius;
      if (separation < -127 || core_inside) continue;
      RealVec on_a = real(p.anchor_a);
      RealVec on_b = real(p.anchor_b) + real(scene.offset);
      if (separation <= 0) {
        EXPECT_EQ(p.anchor_b, p.anchor_a - scene.offset);
        const Real share = share_of_a(scene.a, scene.b);
        on_a = on_a - real(m.normal) * (separation * share);
        on_b = on_b + real(m.normal) * (separation * (1 - share));
      }
      const bool snapped = !scene.has(ShapeKind::sphere) && !scene.has(ShapeKind::capsule);
      const Real slack = tolerance(scene) + (snapped ? 31 * k_micrometre : radius / 1000);
      const RealVec n = real(m.normal);
      EXPECT_LE(static_cast<double>(surface_distance(a, on_a) - lean_slack(a, n)),
                static_cast<double>(slack));
      EXPECT_LE(static_cast<double>(surface_distance(b, on_b) - lean_slack(b, n)),
                static_cast<double>(slack));
    }
  });
}

TEST(CollidePolytope, SwappingTheShapesFlipsTheManifoldBitForBit) {
  for_random_polytope_scenes(2 * k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    expect_flipped(scene.collide(),
                   collide(scene.posed_b(), scene.posed_a(), -scene.offset, scene.margin));
  });
}

TEST(CollidePolytope, SwappingTwoOfOneAssetFlipsTheManifoldBitForBit) {
  Dice dice;
  for (int i = 0; i < test::share_of(2000); ++i) {
    const auto polytope = random_polytope(dice, 1);
    if (geometry::is_flat(polytope->view())) continue;
    const Shape shape{ShapeKind::hull, {}, {5}};
    const Mat3 ra = to_matrix(dice.orientation());
    const Mat3 rb = to_matrix(dice.orientation());
    if (ra == rb) continue;
    const PosedShape a{shape, ra, &polytope->view()};
    const PosedShape b{shape, rb, &polytope->view()};
    Vec3<Length> offset = metres(dice.direction() * dice.uniform(0, 2));
    if (dice.chance(3)) offset = {};
    expect_flipped(collide(a, b, offset, metres(0.1)), collide(b, a, -offset, metres(0.1)));
    if (::testing::Test::HasFailure()) return;
  }
}

TEST(CollidePolytope, KeepsOnlyPointsWithinTheMarginAndNamesThemOnceAscending) {
  for_random_polytope_scenes(2 * k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    const Manifold m = scene.collide();
    for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
      const Displacement s = m.points[i].separation;
      EXPECT_TRUE(s <= Displacement{} || real(s) < real(scene.margin));
      if (i > 0) {
        EXPECT_LT(m.points[i - 1].feature, m.points[i].feature);
      }
    }
  });
}

TEST(CollidePolytope, ACommonRotationKeepsTheDistance) {
  for_random_polytope_scenes(k_polytope_scenes / 2, [](Dice& dice, const PolytopeScene& scene) {
    const Real truth = signed_distance(scene.real_a(), scene.real_b());
    const Real slack = 2 * choice_slack(scene, truth) + scene.scale() * 4e-9L;
    if (std::fabs(truth - real(scene.margin)) < slack || truth < 0) return;
    const Mat3 turn = to_matrix(dice.orientation());
    const auto product = [&turn](const Mat3& m) {
      return Mat3{rotate(turn, m.x), rotate(turn, m.y), rotate(turn, m.z)};
    };
    const Mat3 ra = product(scene.rotation_a);
    const Mat3 rb = product(scene.rotation_b);
    const Manifold m = scene.collide();
    const Manifold t =
        collide({scene.a, ra, scene.posed_a().polytope}, {scene.b, rb, scene.posed_b().polytope},
                rotate(turn, scene.offset), scene.margin);
    ASSERT_EQ(m.count > 0, t.count > 0);
    if (m.count == 0) return;
    EXPECT_NEAR(static_cast<double>(deepest(m)), static_cast<double>(deepest(t)),
                static_cast<double>(slack));
  });
}

TEST(CollidePolytope, OverlapsAgreesWithAZeroMarginManifold) {
  for_random_polytope_scenes(k_polytope_scenes, [](Dice&, const PolytopeScene& scene) {
    const bool touching = overlaps(scene.posed_a(), scene.posed_b(), scene.offset);
    const Manifold m = collide(scene.posed_a(), scene.posed_b(), scene.offset, {});
    EXPECT_EQ(touching, m.count > 0);
    const Real truth = signed_distance(scene.real_a(), scene.real_b());
    if (std::fabs(truth) > tolerance(scene) + 4 * k_micrometre) {
      EXPECT_EQ(touching, truth < 0) << static_cast<double>(truth);
    }
  });
}

TEST(SeparatedAlong, ImpliesNoPoints) {
  int separated = 0;
  for_random_polytope_scenes(k_polytope_scenes, [&](Dice& dice, const PolytopeScene& scene) {
    const Manifold m = scene.collide();
    const RealVec d = dice.chance(2) ? dice.direction() : real(scene.offset);
    const auto raw = [](Real x) { return static_cast<std::int64_t>(x * (1 << 24)); };
    for (const Vec3<Unit>& axis : {m.normal, direction_of(raw(d.x), raw(d.y), raw(d.z))}) {
      if (axis == Vec3<Unit>{}) continue;
      const bool found =
          separated_along(scene.posed_a(), scene.posed_b(), scene.offset, scene.margin, axis);
      EXPECT_EQ(found, separated_along(scene.posed_b(), scene.posed_a(), -scene.offset,
                                       scene.margin, -axis));
      if (!found) continue;
      ++separated;
      EXPECT_EQ(m.count, 0);
    }
  });
  EXPECT_GT(separated, k_polytope_scenes / 4);
}

}  // namespace
}  // namespace lockstone::test
