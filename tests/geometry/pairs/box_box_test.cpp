// Box against box, by construction.
#include <set>

#include "tests/geometry/scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

Manifold collide_boxes(const Shape& a, const Mat3& ra, const Shape& b, const Mat3& rb,
                       const Vec3<Length>& offset, double margin = 0.05) {
  return collide({a, ra}, {b, rb}, offset, metres(margin));
}

const Shape k_cube = Shape::box(metres(0.5), metres(0.5), metres(0.5));
const Shape k_ground = Shape::box(metres(50), metres(1), metres(50));

TEST(BoxBox, RestingFlatGivesFourPointsWithEqualSeparations) {
  for (const double yaw : {0.0, 1e-6, 1e-3, 0.3, 1.0}) {
    const Mat3 turn = turned(0, 1, 0, yaw);
    const Manifold m = collide_boxes(k_ground, k_identity, k_cube, turn, metres(0, 1.5 - 0.001, 0));
    ASSERT_EQ(m.count, 4) << yaw;
    EXPECT_EQ(m.normal, (Vec3<Unit>{{}, Unit::from_integer(1), {}}));
    Vec3<std::int64_t> sum{};
    for (const ManifoldPoint& p : m.points) {
      EXPECT_EQ(p.separation, m.points[0].separation);
      EXPECT_NEAR(static_cast<double>(real(p.separation)), -0.001, 1e-6);
      sum = {sum.x + p.anchor_b.x.raw, sum.y, sum.z + p.anchor_b.z.raw};
    }
    EXPECT_EQ(sum.x, 0) << yaw;
    EXPECT_EQ(sum.z, 0) << yaw;
  }
}

TEST(BoxBox, CubesStackedFlushKeepFourPointsAtTheCorners) {
  const Manifold m = collide_boxes(k_cube, k_identity, k_cube, k_identity, metres(0, 1, 0));
  ASSERT_EQ(m.count, 4);
  std::set<std::array<int, 2>> corners;
  for (const ManifoldPoint& p : m.points) {
    EXPECT_EQ(p.separation.raw, 0);
    EXPECT_EQ(abs(p.anchor_a.x), metres(0.5));
    EXPECT_EQ(p.anchor_a.y, metres(0.5));
    EXPECT_EQ(abs(p.anchor_a.z), metres(0.5));
    corners.insert({p.anchor_a.x.raw > 0, p.anchor_a.z.raw > 0});
  }
  EXPECT_EQ(corners.size(), 4U);
}

TEST(BoxBox, FeaturesOfARestingBoxSurviveTremblingByMicrometres) {
  Dice dice;
  const Shape slab = Shape::box(metres(0.5), metres(0.25), metres(0.5));
  for (const Shape& below : {k_ground, slab, k_cube}) {
    const double height = std::ldexp(below.size.y.raw, -20) + 0.5;
    const Manifold rest =
        collide_boxes(below, k_identity, k_cube, k_identity, metres(0, height - 0.0005, 0));
    for (int i = 0; i < test::share_of(500); ++i) {
      const auto jitter = [&dice] { return dice.uniform(-1e-6, 1e-6); };
      const Mat3 turn = turned(jitter(), 1, jitter(), 4 * jitter());
      const Vec3<Length> offset = metres(jitter(), height - 0.0005 + jitter(), jitter());
      const Manifold m = collide_boxes(below, k_identity, k_cube, turn, offset);
      EXPECT_EQ(features_of(m), features_of(rest));
    }
  }
}

TEST(BoxBox, PartialOverlapClipsToTheCommonRectangle) {
  const Manifold m = collide_boxes(k_cube, k_identity, k_cube, k_identity, metres(0.3, 0.99, -0.2));
  ASSERT_EQ(m.count, 4);
  for (const ManifoldPoint& p : m.points) {
    const double x = static_cast<double>(real(p.anchor_a.x));
    const double z = static_cast<double>(real(p.anchor_a.z));
    EXPECT_NEAR(std::min(std::fabs(x - 0.5), std::fabs(x + 0.2)), 0, 2e-6);
    EXPECT_NEAR(std::min(std::fabs(z + 0.5), std::fabs(z - 0.3)), 0, 2e-6);
    EXPECT_NEAR(static_cast<double>(real(p.separation)), -0.01, 1e-6);
  }
}

TEST(BoxBox, ABoxWithinAFaceIsMirroredBitForBit) {
  Dice dice;
  const auto mirrored = [](const auto& v) { return std::decay_t<decltype(v)>{-v.x, v.y, v.z}; };
  const auto mirrored_rotation = [&mirrored](const Mat3& m) {
    return Mat3{-mirrored(m.x), mirrored(m.y), mirrored(m.z)};
  };
  for (int i = 0; i < test::share_of(2000); ++i) {
    const Mat3 ground = to_matrix(dice.orientation());
    // The cube stands on the ground's own y axis, turned about it and tilted a little.
    const Mat3 local =
        turned(dice.uniform(-0.01, 0.01), 1, dice.uniform(-0.01, 0.01), dice.uniform(-3, 3));
    const Mat3 cube{rotate(ground, local.x), rotate(ground, local.y), rotate(ground, local.z)};
    const Vec3<Length> offset =
        rotate(ground, metres(dice.uniform(-20, 20), dice.uniform(1.49, 1.51), 3));
    const Manifold m = collide_boxes(k_ground, ground, k_cube, cube, offset, 0.5);
    const Manifold w = collide_boxes(k_ground, mirrored_rotation(ground), k_cube,
                                     mirrored_rotation(cube), mirrored(offset), 0.5);
    ASSERT_EQ(m.count, 4);
    ASSERT_EQ(w.count, 4);
    EXPECT_EQ(m.normal, mirrored(w.normal));
    int matches = 0;
    for (const ManifoldPoint& p : m.points) {
      for (const ManifoldPoint& q : w.points) {
        if (p.separation == q.separation && p.anchor_a == mirrored(q.anchor_a) &&
            p.anchor_b == mirrored(q.anchor_b)) {
          ++matches;
        }
      }
    }
    EXPECT_EQ(matches, 4);
  }
}

TEST(BoxBox, AnEighthTurnGivesFourOfTheEightCorners) {
  const Manifold m = collide_boxes(k_cube, k_identity, k_cube, turned(0, 1, 0, 3.14159265 / 4),
                                   metres(0, 0.999, 0));
  ASSERT_EQ(m.count, 4);
  EXPECT_EQ(features_of(m).size(), 4U);
  // The four span most of the octagon: its circle has radius 0.541.
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      const RealVec d = real(m.points[i].anchor_a) - real(m.points[j].anchor_a);
      area = std::max(area, static_cast<double>(norm(d)));
    }
  }
  EXPECT_NEAR(area, 1.0824, 1e-3);
}

TEST(BoxBox, AVertexOverAFaceGivesOnePoint) {
  // A cube on its corner: the diagonal is vertical.
  const Mat3 on_corner = turned(1, 0, -1, std::acos(1 / std::sqrt(3.0)));
  const double height = 1 + std::sqrt(0.75);
  for (const double gap : {0.02, -0.001}) {
    const Manifold m =
        collide_boxes(k_ground, k_identity, k_cube, on_corner, metres(3, height + gap, 2));
    ASSERT_GE(m.count, 1);
    EXPECT_EQ(m.normal, (Vec3<Unit>{{}, Unit::from_integer(1), {}}));
    double least = 1;
    for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i) {
      least = std::min(least, static_cast<double>(real(m.points[i].separation)));
    }
    EXPECT_NEAR(least, gap, 2e-6);
  }
}

TEST(BoxBox, CrossedEdgesGiveOnePointBetweenThem) {
  const double quarter = 3.14159265358979 / 4;
  const Mat3 roof = turned(0, 0, 1, quarter);  // an edge along z on top
  const Mat3 keel = turned(1, 0, 0, quarter);  // an edge along x below
  const double touch = 2 * std::sqrt(0.5);
  for (const double gap : {0.03, 0.0, -0.01}) {
    const Manifold m = collide_boxes(k_cube, roof, k_cube, keel, metres(0.1, touch + gap, 0.2));
    ASSERT_EQ(m.count, 1) << gap;
    const ManifoldPoint& p = m.points[0];
    EXPECT_NEAR(static_cast<double>(real(m.normal.y)), 1, 1e-8);
    EXPECT_NEAR(static_cast<double>(real(p.separation)), gap, 3e-6);
    EXPECT_NEAR(static_cast<double>(real(p.anchor_a.x)), 0, 3e-6);
    EXPECT_NEAR(static_cast<double>(real(p.anchor_a.z)), 0.2, 3e-6);
  }
}

TEST(BoxBox, CornersApartMeetCornerToCorner) {
  const Manifold m =
      collide_boxes(k_cube, k_identity, k_cube, k_identity, metres(1.01, 1.02, 1.02));
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(static_cast<double>(real(m.points[0].separation)), 0.03, 1e-6);
  EXPECT_EQ(m.points[0].anchor_a, metres(0.5, 0.5, 0.5));
}

TEST(BoxBox, ANestedBoxLeavesByTheNearestFace) {
  const Shape small = Shape::box(metres(0.1), metres(0.1), metres(0.1));
  const Shape large = Shape::box(metres(5), metres(4), metres(3));
  const Manifold m = collide_boxes(large, k_identity, small, k_identity, metres(0.5, 0.5, -0.5));
  ASSERT_EQ(m.count, 4);
  EXPECT_EQ(m.normal, (Vec3<Unit>{{}, {}, Unit::from_integer(-1)}));
  EXPECT_NEAR(static_cast<double>(real(m.points[0].separation)), -2.6, 1e-6);
}

TEST(BoxBox, ConcentricEqualCubesHaveADefinedResult) {
  const Manifold m = collide_boxes(k_cube, k_identity, k_cube, k_identity, {});
  ASSERT_EQ(m.count, 4);
  EXPECT_EQ(m.normal, (Vec3<Unit>{Unit::from_integer(1), {}, {}}));
  EXPECT_NEAR(static_cast<double>(real(m.points[0].separation)), -1, 1e-6);
}

TEST(BoxBox, AGrainOnAPlateauIsMeasuredLikeAnywhereElse) {
  const Shape grain = Shape::box(k_min_shape_size, k_min_shape_size, k_min_shape_size);
  const Shape plateau = Shape::box(k_max_shape_size, k_max_shape_size, k_max_shape_size);
  for (const double x : {0.0, 300.0, 511.9}) {
    const Vec3<Length> offset{metres(x), k_max_shape_size + k_min_shape_size, metres(-x)};
    const Manifold m = collide_boxes(plateau, k_identity, grain, k_identity, offset);
    ASSERT_EQ(m.count, 4);
    for (const ManifoldPoint& p : m.points) {
      EXPECT_EQ(p.separation.raw, 0);
      EXPECT_EQ(abs(p.anchor_b.x), k_min_shape_size);
    }
  }
}

TEST(BoxBox, AtExactTouchOverlapsAndOneStepApartDoesNot) {
  const PosedShape cube{k_cube, k_identity};
  const Length one_step = Length::from_raw(1);
  EXPECT_TRUE(overlaps(cube, cube, metres(1, 0.3, 0.2)));
  EXPECT_FALSE(overlaps(cube, cube, {metres(1) + one_step, metres(0.3), metres(0.2)}));
  EXPECT_TRUE(overlaps(cube, cube, metres(1, 1, 1)));
  EXPECT_FALSE(overlaps(cube, cube, metres(1, 1, 1) + Vec3<Length>{one_step, {}, {}}));
}

TEST(BoxBox, FarCornersOfTheRangeDoNotOverflow) {
  Dice dice;
  const Shape huge = Shape::box(k_max_shape_size, k_max_shape_size, k_max_shape_size);
  for (int i = 0; i < test::share_of(3000); ++i) {
    const auto extreme = [&dice] {
      return metres(static_cast<double>(dice.between(-1, 1)) * 2000);
    };
    const Mat3 turn_a = to_matrix(dice.orientation());
    const Mat3 turn_b = to_matrix(dice.orientation());
    for (const Shape& b : {huge, Shape::capsule(k_max_shape_size, k_max_shape_size),
                           Shape::sphere(k_max_shape_size)}) {
      const Vec3<Length> offset{extreme(), extreme(), extreme()};
      const Manifold m = collide({huge, turn_a}, {b, turn_b}, offset, metres(64));
      EXPECT_LE(m.count, 4);
      const Manifold c = collide({Shape::capsule(k_max_shape_size, k_max_shape_size), turn_a},
                                 {b, turn_b}, offset, metres(64));
      EXPECT_LE(c.count, 4);
    }
  }
}

}  // namespace
}  // namespace lockstone::test
