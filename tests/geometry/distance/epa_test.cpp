// Depth of overlapping convex shapes.
#include "core/geometry/distance/epa/epa.h"

#include <numbers>

#include "tests/geometry/pairs/convex_scene.h"

namespace lockstone::test {
namespace {

Penetration penetration_of(ConvexPair& pair) {
  return penetration(pair.a.posed(), pair.b.posed(), pair.offset);
}

/// The least overlap over the directions in which a polytope's edges and faces can separate.
Real least_overlap(const RealPair& pair) {
  std::vector<RealVec> edges_a;
  std::vector<RealVec> edges_b;
  const auto list_edges = [](const std::vector<RealVec>& points, std::vector<RealVec>& edges) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k)
        edges.push_back(points[i] - points[k]);
    }
  };
  list_edges(pair.a, edges_a);
  list_edges(pair.b, edges_b);
  std::vector<RealVec> axes;
  const auto add_crosses = [&axes](const auto& us, const auto& vs) {
    for (const RealVec& u : us) {
      for (const RealVec& v : vs)
        axes.push_back(cross(u, v));
    }
  };
  add_crosses(edges_a, edges_a);
  add_crosses(edges_b, edges_b);
  add_crosses(edges_a, edges_b);
  Real most = -1e30L;
  for (const RealVec& axis : axes) {
    if (norm(axis) < 1e-9L * pair.size * pair.size) continue;
    const RealVec n = axis * (1 / norm(axis));
    most = std::max({most, pair.separation(n), pair.separation(n * -1)});
  }
  return -most;
}

/// The depth is the overlap along its normal, and the points lie that far apart along it.
void expect_depth_along_normal(const ConvexPair& pair, const Penetration& found) {
  const Real slack = depth_tolerance(pair);
  const Real depth = real(found.depth);
  const RealVec n = real(found.normal);
  EXPECT_TRUE(found.exact);
  ASSERT_NEAR(static_cast<double>(norm(n)), 1.0, std::ldexp(1.0, -29));
  EXPECT_NEAR(static_cast<double>(depth), static_cast<double>(-RealPair(pair).separation(n)),
              static_cast<double>(slack));
  const RealVec gap = real(found.point_b) + real(pair.offset) - real(found.point_a);
  EXPECT_NEAR(static_cast<double>(norm(gap + n * depth)), 0, static_cast<double>(2 * slack));
}

TEST(Penetration, IsNeverMoreThanTheLeastOverlapAndSeparates) {
  int deep = 0;
  for_convex_pairs(200, [&deep](Dice&, ConvexPair& pair) {
    const Penetration found = penetration_of(pair);
    if (!found.overlapping) return;
    ++deep;
    expect_depth_along_normal(pair, found);
  });
  EXPECT_GT(deep, 500);
}

Length steps(std::int32_t raw) {
  return Length::from_raw(raw);
}

Vec3<Unit> unit_vector(std::int32_t x, std::int32_t y, std::int32_t z) {
  return {Unit::from_raw(x), Unit::from_raw(y), Unit::from_raw(z)};
}

// Faces in one plane, whose vertices the lattice puts beside it: 3.93 µm of 120 m.
TEST(Penetration, OfLargeBoxesAlongOneAxisIsExactToTheStepsOfTheLattice) {
  const Mat3 rotation{unit_vector(-780719991, 734938744, -57121321),
                      unit_vector(718970772, 740804695, -295314980),
                      unit_vector(-162723174, -252972234, -1030751049)};
  ConvexPair pair{convex(Shape::box(steps(65847650), steps(348923425), steps(337760698)), rotation),
                  convex(Shape::box(steps(163009998), steps(54017659), steps(89818382)), rotation),
                  {steps(211474311), steps(224600743), steps(71277810)}};
  const Penetration found = penetration_of(pair);
  EXPECT_TRUE(found.overlapping);
  expect_depth_along_normal(pair, found);
}

TEST(Penetration, IsTheLeastOverlapOfAllSeparatingAxes) {
  int compared = 0;
  for_convex_pairs(60, [&compared](Dice&, ConvexPair& pair) {
    const RealPair reals(pair);
    if (reals.a.size() * reals.b.size() > 32 || reals.a.size() * reals.b.size() < 8) return;
    const ClosestPoints apart = distance(pair.a.posed(), pair.b.posed(), pair.offset);
    if (!apart.cores_overlap) return;
    ++compared;
    EXPECT_NEAR(static_cast<double>(real(penetration_of(pair).depth)),
                static_cast<double>(least_overlap(reals)),
                static_cast<double>(depth_tolerance(pair)));
  });
  EXPECT_GT(compared, 80);
}

TEST(Penetration, IsThatOfSeparatingAxesForBoxesAndCapsules) {
  for_random_scenes(500, [](Dice&, const Scene& scene) {
    const Real truth = signed_distance(scene.placed_a(), scene.placed_b());
    const Penetration found = penetration(scene.posed_a(), scene.posed_b(), scene.offset);
    const Real slack = depth_tolerance(
        {convex(scene.a, scene.rotation_a), convex(scene.b, scene.rotation_b), scene.offset});
    if (std::fabs(truth) > slack) {
      EXPECT_EQ(found.overlapping, truth < 0);
    }
    if (truth > 0) return;
    EXPECT_NEAR(static_cast<double>(real(found.depth)), static_cast<double>(-truth),
                static_cast<double>(slack));
  });
}

TEST(Penetration, SwappingTheShapesMirrorsTheResultBitForBit) {
  for_convex_pairs(100, [](Dice& dice, ConvexPair& pair) {
    if (dice.chance(6)) pair.b = pair.a;
    const Penetration one = penetration_of(pair);
    const Penetration two = penetration(pair.b.posed(), pair.a.posed(), -pair.offset);
    EXPECT_EQ(one.overlapping, two.overlapping);
    EXPECT_EQ(one.depth, two.depth);
    EXPECT_EQ(one.normal, -two.normal);
    EXPECT_EQ(one.point_a, two.point_b);
    EXPECT_EQ(one.point_b, two.point_a);
  });
}

TEST(Penetration, AndDistanceFromAHalfSpaceAreThoseOfTheDeepestPoint) {
  for_convex_pairs(20, [](Dice&, ConvexPair& pair) {
    const RealPair reals(pair);
    pair.a = convex(Shape::half_space(), pair.a.rotation);
    const RealVec n = real(pair.a.rotation.y);
    const Real height = -reach_along(reals.b, n * -1) - pair.b.radius();
    const Real slack = tolerance(reals);
    const ClosestPoints found = distance(pair.a.posed(), pair.b.posed(), pair.offset);
    const Penetration deep = penetration(pair.a.posed(), pair.b.posed(), pair.offset);
    EXPECT_EQ(found.overlapping, deep.overlapping);
    EXPECT_NEAR(static_cast<double>(real(found.distance) - real(deep.depth)),
                static_cast<double>(height), static_cast<double>(slack));
    const RealVec gap = real(found.point_b) + real(pair.offset) - real(found.point_a);
    EXPECT_NEAR(static_cast<double>(norm(gap - n * height)), 0, static_cast<double>(slack));
    EXPECT_NEAR(static_cast<double>(dot(n, real(found.point_a))), 0, static_cast<double>(slack));
    const ClosestPoints other = distance(pair.b.posed(), pair.a.posed(), -pair.offset);
    EXPECT_EQ(found.normal, -other.normal);
    EXPECT_EQ(found.point_a, other.point_b);
  });
}

TEST(Penetration, OfConcentricSpheresIsUpwards) {
  ConvexPair pair{convex(Shape::sphere(metres(1))), convex(Shape::sphere(metres(2))), {}};
  const Penetration found = penetration_of(pair);
  EXPECT_TRUE(found.overlapping);
  EXPECT_EQ(found.depth, Position::from_integer(3));
  EXPECT_EQ(abs(found.normal.y), unit(1));
}

TEST(Penetration, OfCrossingCapsulesIsTheirRadiiSquareToBoth) {
  // About x and y: the difference of the cores is flat.
  ConvexPair pair{
      convex(Shape::capsule(metres(2), metres(0.25)), turned(0, 0, 1, std::numbers::pi / 2)),
      convex(Shape::capsule(metres(2), metres(0.5))), metres(0.5, 0.25, 0)};
  const Penetration found = penetration_of(pair);
  EXPECT_TRUE(found.overlapping);
  EXPECT_EQ(found.depth, Position::from_ratio(3, 4));
  EXPECT_EQ(abs(found.normal.z), unit(1));
}

TEST(Penetration, OfAPointOnASegmentIsSquareToIt) {
  ConvexPair pair{convex(Shape::capsule(metres(2), metres(0.25))),
                  convex(Shape::sphere(metres(0.5))), metres(0, 1, 0)};
  const Penetration found = penetration_of(pair);
  EXPECT_EQ(found.depth, Position::from_ratio(3, 4));
  EXPECT_EQ(found.normal.y, Unit{});
}

TEST(Penetration, OfFlatShapesInOnePlaneIsZeroAcrossIt) {
  ConvexPair pair{convex({metres(-1, 0, -1), metres(1, 0, -1), metres(0, 0, 1)}),
                  convex({metres(-1, 0, 0), metres(1, 0, 0), metres(0, 0, 2)}),
                  metres(0.125, 0, 0.25)};
  const Penetration found = penetration_of(pair);
  EXPECT_TRUE(found.overlapping);
  EXPECT_EQ(found.depth, Position{});
  EXPECT_EQ(abs(found.normal.y), unit(1));
}

TEST(Penetration, OfASegmentThroughATriangleIsTheLesserEnd) {
  // The capsule's core pierces the triangle's plane, a quarter of a metre beyond it.
  ConvexPair pair{convex({metres(-5, 0, -5), metres(5, 0, -5), metres(0, 0, 5)}),
                  convex(Shape::capsule(metres(1), metres(0.125))), metres(0, 0.75, 0)};
  const Penetration found = penetration_of(pair);
  EXPECT_EQ(found.depth, Position::from_ratio(3, 8));
  EXPECT_EQ(found.normal, (Vec3<Unit>{{}, unit(1), {}}));
}

TEST(Penetration, OfTouchingBoxesIsZeroAlongTheFace) {
  ConvexPair pair{convex(Shape::box(metres(1), metres(1), metres(1))),
                  convex(Shape::box(metres(1), metres(1), metres(1))), metres(2, 0.25, 0.5)};
  const Penetration found = penetration_of(pair);
  EXPECT_TRUE(found.overlapping);
  EXPECT_EQ(found.depth, Position{});
  EXPECT_EQ(found.normal, (Vec3<Unit>{unit(1), {}, {}}));
}

TEST(Penetration, OfNestedBoxesIsTheWayToTheNearestFace) {
  ConvexPair pair{convex(Shape::box(metres(500), metres(500), metres(500))),
                  convex(Shape::box(metres(0.001), metres(0.001), metres(0.001))),
                  metres(-300, 10, 20)};
  const Penetration found = penetration_of(pair);
  EXPECT_NEAR(static_cast<double>(real(found.depth)), 200.001, 3e-6);
  EXPECT_EQ(found.normal, (Vec3<Unit>{unit(-1), {}, {}}));
}

TEST(Penetration, OfRoundHullsOfManyVerticesIsExactOrSaysNot) {
  Dice dice;
  for (int i = 0; i < 20; ++i) {
    const auto ball = [&dice] {
      std::vector<Vec3<Length>> vertices;
      for (int k = 0; k < geometry::k_max_polytope_vertices; ++k) {
        const RealVec d = dice.direction();
        vertices.push_back(
            metres(static_cast<double>(d.x), static_cast<double>(d.y), static_cast<double>(d.z)));
      }
      return convex(vertices, to_matrix(dice.orientation()));
    };
    // Concentric: every face of the difference is about as near.
    ConvexPair pair{ball(), ball(), {}};
    const Penetration found = penetration_of(pair);
    const RealPair reals(pair);
    const Real separation = reals.separation(real(found.normal));
    EXPECT_LE(static_cast<double>(-separation),
              static_cast<double>(real(found.depth) + depth_tolerance(pair)));
    EXPECT_GT(real(found.depth), 1.5L);
    EXPECT_LT(real(found.depth), 2.0L);
  }
}

}  // namespace
}  // namespace lockstone::test
