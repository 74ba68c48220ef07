// Distance of convex shapes.
#include "core/geometry/gjk.h"

#include "tests/geometry/convex_scene.h"

namespace lockstone::test {
namespace {

constexpr Real k_micrometre = 1e-6L;

Real tolerance(const RealPair& pair) {
  return 2 * k_micrometre + 4e-9L * pair.size;
}

ClosestPoints distance_of(ConvexPair& pair) {
  return distance(pair.a.posed(), pair.b.posed(), pair.offset);
}

RealVec picked(const std::vector<RealVec>& points, const ClosestFeature& f, bool of_a, int i) {
  const std::size_t k = static_cast<std::size_t>(std::min(i, f.count - 1));
  return points[of_a ? f.a[k] : f.b[k]];
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

}  // namespace
}  // namespace lockstone::test
