// Distance of convex shapes.
#include "core/geometry/distance/gjk/gjk.h"

#include "tests/geometry/pairs/convex_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

ClosestPoints distance_of(ConvexPair& pair) {
  return distance(pair.a.posed(), pair.b.posed(), pair.offset);
}

RealVec picked(const std::vector<RealVec>& points, const ClosestFeature& f, bool of_a, int i) {
  const std::size_t k = static_cast<std::size_t>(std::min(i, f.count - 1));
  return points[static_cast<std::size_t>(of_a ? f.a[k] : f.b[k])];
}

/// A witness is on the surface: at the radius from the feature's core, outward along the normal.
Real surface_error(const std::vector<RealVec>& points, const ClosestFeature& f, bool of_a,
                   const RealVec& core) {
  return point_to_triangle(core, picked(points, f, of_a, 0), picked(points, f, of_a, 1),
                           picked(points, f, of_a, 2));
}

/// Upper bound: the witnesses are in the shapes and as far apart as said. Lower bound: the normal
/// separates by as much.
void expect_proven(ConvexPair& pair, const ClosestPoints& found) {
  const RealPair reals(pair);
  const Real slack = tolerance(reals);
  const Real said = real(found.distance);
  const RealVec n = real(found.normal);
  ASSERT_NEAR(static_cast<double>(norm(n)), 1.0, std::ldexp(1.0, -29));
  EXPECT_NEAR(static_cast<double>(reals.separation(n)), static_cast<double>(said),
              static_cast<double>(slack));
  const RealVec on_a = real(found.point_a);
  const RealVec on_b = real(found.point_b) + real(pair.offset);
  EXPECT_NEAR(static_cast<double>(norm(on_b - on_a)), static_cast<double>(said),
              static_cast<double>(slack));
  EXPECT_LE(surface_error(reals.a, found.feature, true, on_a - n * pair.a.radius()), slack);
  EXPECT_LE(surface_error(reals.b, found.feature, false, on_b + n * pair.b.radius()), slack);
}

/// Bit for bit the mirrored result.
void expect_mirrored(const ClosestPoints& found, const ClosestPoints& other) {
  EXPECT_EQ(found.overlapping, other.overlapping);
  EXPECT_EQ(found.cores_overlap, other.cores_overlap);
  EXPECT_EQ(found.distance, other.distance);
  EXPECT_EQ(found.normal, -other.normal);
  EXPECT_EQ(found.point_a, other.point_b);
  EXPECT_EQ(found.point_b, other.point_a);
  EXPECT_EQ(found.feature.a, other.feature.b);
  EXPECT_EQ(found.feature.b, other.feature.a);
}

TEST(Distance, SwappingTheShapesMirrorsTheResultBitForBit) {
  for_convex_pairs(300, [](Dice& dice, ConvexPair& pair) {
    if (dice.chance(6)) pair.b = pair.a;
    expect_mirrored(distance_of(pair), distance(pair.b.posed(), pair.a.posed(), -pair.offset));
  });
}

/// Kinds whose signed distance `signed_distance` knows.
bool is_primitive_pair(const ConvexPair& pair) {
  return pair.a.vertices.empty() && pair.b.vertices.empty();
}

TEST(Distance, IsThatOfAllPairsOfFeatures) {
  int compared = 0;
  for_convex_pairs(250, [&compared](Dice&, ConvexPair& pair) {
    const RealPair reals(pair);
    const Real slack = tolerance(reals);
    const ClosestPoints found = distance_of(pair);
    Real truth = 0;
    if (is_primitive_pair(pair)) {
      const Real known =
          signed_distance(Placed(pair.a.posed(), {}), Placed(pair.b.posed(), real(pair.offset)));
      truth = std::max(Real{0}, known);
      if (std::fabs(known) > slack) {
        EXPECT_EQ(found.overlapping, known < 0);
      }
    } else if (reals.a.size() <= 4 && reals.b.size() <= 4 && !found.cores_overlap) {
      truth = std::max(Real{0}, apart_simplices(reals.a, reals.b) - reals.radii);
    } else {
      return;
    }
    ++compared;
    EXPECT_NEAR(static_cast<double>(real(found.distance)), static_cast<double>(truth),
                static_cast<double>(slack));
  });
  EXPECT_GT(compared, 2000);
}

TEST(Distance, ProvesItselfByWitnessesAndASeparatingPlane) {
  int apart = 0;
  for_convex_pairs(600, [&apart](Dice&, ConvexPair& pair) {
    const ClosestPoints found = distance_of(pair);
    if (found.overlapping) return;
    ++apart;
    expect_proven(pair, found);
  });
  EXPECT_GT(apart, 2000);
}

TEST(Distance, RefusesAWrongNormal) {
  // The proof can fail: tilt the normal by a milliradian and the plane no longer separates as much.
  ConvexPair pair{convex(Shape::box(metres(1), metres(1), metres(1))),
                  convex(Shape::box(metres(1), metres(1), metres(1))), metres(3, 0.5, 0)};
  const ClosestPoints found = distance_of(pair);
  const RealPair reals(pair);
  const RealVec tilted = real(found.normal) + RealVec{0, 1e-3L, 0};
  EXPECT_LT(reals.separation(tilted * (1 / norm(tilted))), real(found.distance) - tolerance(reals));
}

TEST(Distance, OfParallelBoxesIsTheGapBetweenTheirFaces) {
  ConvexPair pair{convex(Shape::box(metres(1), metres(2), metres(3))),
                  convex(Shape::box(metres(3), metres(2), metres(1))), metres(4.25, 1, -1)};
  const ClosestPoints found = distance_of(pair);
  EXPECT_EQ(found.distance, Position::from_ratio(1, 4));
  EXPECT_EQ(found.normal, (Vec3<Unit>{unit(1), {}, {}}));
  EXPECT_EQ(found.point_a.x, metres(1));
  EXPECT_EQ(found.point_b.x, metres(-3));
}

TEST(Distance, TellsOneStepOfLengthFromTouching) {
  ConvexPair pair{convex(Shape::box(metres(1), metres(1), metres(1))),
                  convex(Shape::box(metres(1), metres(1), metres(1))), metres(2, 0.25, 0.5)};
  EXPECT_TRUE(distance_of(pair).overlapping);
  pair.offset.x.raw += 1;
  const ClosestPoints apart = distance_of(pair);
  EXPECT_FALSE(apart.overlapping);
  EXPECT_EQ(apart.distance.raw, std::int64_t{1} << 12);
  EXPECT_EQ(apart.normal, (Vec3<Unit>{unit(1), {}, {}}));
  pair.offset.x.raw -= 2;
  EXPECT_TRUE(distance_of(pair).overlapping);
}

TEST(Distance, OfConcentricAndNestedShapesIsOverlap) {
  for_convex_pairs(20, [](Dice&, ConvexPair& pair) {
    if (!is_primitive_pair(pair)) return;
    pair.offset = {};
    const ClosestPoints found = distance_of(pair);
    EXPECT_TRUE(found.overlapping);
    EXPECT_EQ(found.distance, Position{});
  });
}

TEST(Distance, OfACrumbBesideAGiantIsExactToTheMicrometre) {
  Dice dice;
  for (int i = 0; i < test::share_of(500); ++i) {
    ConvexPair pair = random_pair(dice, 2, static_cast<int>(dice.between(0, 5)), 0.001, 0.002);
    pair.a = convex(Shape::box(metres(500), metres(500), metres(500)), pair.a.rotation);
    // Over the middle of the face that A's x axis leaves by.
    const RealVec n = real(pair.a.rotation.x);
    const RealVec there = n * (500 + static_cast<Real>(dice.uniform(0.006, 0.02)));
    pair.offset = metres(static_cast<double>(there.x), static_cast<double>(there.y),
                         static_cast<double>(there.z));
    const ClosestPoints found = distance_of(pair);
    ASSERT_FALSE(found.overlapping);
    expect_proven(pair, found);
  }
}

TEST(Distance, OfSliversProvesItself) {
  Dice dice;
  int apart = 0;
  for (int i = 0; i < test::share_of(2000); ++i) {
    // Nearly flat and nearly straight: two lengths of micrometres to metres.
    const auto sliver = [&dice] {
      std::vector<Vec3<Length>> vertices;
      const double y = real_size(dice, 1e-6, 1);
      const double z = real_size(dice, 1e-6, 1e-3);
      for (int k = 0; k < 8; ++k)
        vertices.push_back(metres(dice.uniform(-5, 5), dice.uniform(-y, y), dice.uniform(-z, z)));
      return convex(vertices, to_matrix(dice.orientation()));
    };
    ConvexPair pair{sliver(), sliver(), {}};
    const RealVec d = dice.direction() * static_cast<Real>(dice.uniform(0, 3));
    pair.offset =
        metres(static_cast<double>(d.x), static_cast<double>(d.y), static_cast<double>(d.z));
    const ClosestPoints found = distance_of(pair);
    if (found.overlapping) continue;
    ++apart;
    expect_proven(pair, found);
    if (HasFailure()) {
      ADD_FAILURE() << describe(pair);
      return;
    }
  }
  EXPECT_GT(apart, 200);
}

TEST(Distance, IsTheSeparationOfTheManifold) {
  int compared = 0;
  for_random_scenes(300, [&compared](Dice&, const Scene& scene) {
    const Manifold manifold =
        collide(scene.posed_a(), scene.posed_b(), scene.offset, Length::from_integer(64));
    const ClosestPoints found = distance(scene.posed_a(), scene.posed_b(), scene.offset);
    if (manifold.count == 0 || found.overlapping) return;
    ++compared;
    Real least = 1e30L;
    for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i)
      least = std::min(least, real(manifold.points[i].separation));
    // The documented bounds of `collide`: faces within 2^-16 m, and 1/2048 beside a box's rim.
    const Real slack = 20 * k_micrometre + 8e-9L * scene.scale() +
                       (least + scene.placed_a().radius() + scene.placed_b().radius()) / 2000;
    EXPECT_NEAR(static_cast<double>(real(found.distance)), static_cast<double>(least),
                static_cast<double>(slack));
  });
  EXPECT_GT(compared, 400);
}

}  // namespace
}  // namespace lockstone::test
