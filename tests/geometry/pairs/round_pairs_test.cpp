// Spheres and capsules, by construction.
#include "tests/geometry/scene.h"

namespace lockstone::test {
namespace {

const Vec3<Unit> k_up{{}, Unit::from_integer(1), {}};
const Vec3<Unit> k_right{Unit::from_integer(1), {}, {}};

/// A body whose y axis lies along x.
const Mat3 k_lying{{{}, Unit::from_integer(-1), {}},
                   {Unit::from_integer(1), {}, {}},
                   {{}, {}, Unit::from_integer(1)}};

Manifold meet(const Shape& a, const Mat3& ra, const Shape& b, const Mat3& rb,
              const Vec3<Length>& offset, double margin = 0.05) {
  return collide({a, ra}, {b, rb}, offset, metres(margin));
}

double separation(const Manifold& m, std::size_t i = 0) {
  return static_cast<double>(real(m.points[i].separation));
}

const Shape k_ball = Shape::sphere(metres(0.5));
const Shape k_rod = Shape::capsule(metres(1), metres(0.25));
const Shape k_box = Shape::box(metres(2), metres(1), metres(0.5));

TEST(SphereSphere, ConcentricSpheresPartUpwards) {
  const Manifold m = meet(k_ball, k_identity, k_ball, k_identity, {});
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(m.normal, k_up);
  EXPECT_EQ(separation(m), -1.0);
}

TEST(SphereSphere, AtExactTouchTheSeparationIsZero) {
  const Manifold m = meet(k_ball, k_identity, k_ball, k_identity, metres(0.6, 0, 0.8));
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(separation(m), 0, 1e-6);
  const Manifold straight = meet(k_ball, k_identity, k_ball, k_identity, metres(1, 0, 0));
  EXPECT_EQ(straight.points[0].separation.raw, 0);
  EXPECT_TRUE(overlaps({k_ball, k_identity}, {k_ball, k_identity}, metres(0, 0, -1)));
}

TEST(SphereSphere, SeparationIsFinerThanTheInput) {
  // |(1, 2^-10, 0)| = 1 + 2^-21 − …: below the input's resolution, above the output's.
  const Vec3<Length> offset{Length::from_integer(1), Length::from_raw(1 << 10), {}};
  const Manifold m = meet(k_ball, k_identity, k_ball, k_identity, offset);
  EXPECT_EQ(m.points[0].separation.raw, 1 << 3);
}

TEST(CapsuleSphere, ASphereOnTheCoreLeavesSideways) {
  const Manifold m = meet(k_rod, k_identity, k_ball, k_identity, metres(0, 0.5, 0));
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(m.normal.y.raw, 0);
  EXPECT_EQ(separation(m), -0.75);
}

TEST(CapsuleSphere, MeetsSideAndEnd) {
  const Manifold side = meet(k_rod, k_identity, k_ball, k_identity, metres(0.76, 0.9, 0));
  ASSERT_EQ(side.count, 1);
  EXPECT_EQ(side.normal, k_right);
  EXPECT_NEAR(separation(side), 0.01, 2e-6);
  const Manifold end = meet(k_rod, k_identity, k_ball, k_identity, metres(0, 1.76, 0));
  ASSERT_EQ(end.count, 1);
  EXPECT_EQ(end.normal, k_up);
  EXPECT_NEAR(separation(end), 0.01, 2e-6);
}

TEST(CapsuleCapsule, ParallelSideBySideGivesTwoPointsAtTheEndsOfTheCommonPart) {
  const Manifold m = meet(k_rod, k_identity, k_rod, k_identity, metres(0.5, 0.6, 0));
  ASSERT_EQ(m.count, 2);
  EXPECT_EQ(m.normal, k_right);
  EXPECT_EQ(m.points[0].separation.raw, 0);
  EXPECT_EQ(m.points[1].separation.raw, 0);
  EXPECT_EQ(m.points[0].anchor_a, metres(0.25, -0.4, 0));
  EXPECT_EQ(m.points[1].anchor_a, metres(0.25, 1, 0));
}

TEST(CapsuleCapsule, NearlyParallelKeepsTwoPointsAndTheirFeatures) {
  Dice dice;
  for (int i = 0; i < 200; ++i) {
    const Mat3 turn = turned(dice.uniform(-1, 1), 0.1, dice.uniform(-1, 1), 1e-5);
    const Manifold m = meet(k_rod, k_identity, k_rod, turn, metres(0.5, 0.6, 0));
    ASSERT_EQ(m.count, 2);
    EXPECT_EQ(m.points[0].feature, 1U);
    EXPECT_EQ(m.points[1].feature, 2U);
    EXPECT_NEAR(separation(m, 0), 0, 2e-5);
    EXPECT_NEAR(separation(m, 1), 0, 2e-5);
  }
}

TEST(CapsuleCapsule, CrossedGivesOnePoint) {
  const Manifold m = meet(k_rod, k_identity, k_rod, k_lying, metres(0.2, 0.3, 0.49));
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(m.normal.z, Unit::from_integer(1));
  EXPECT_NEAR(separation(m), -0.01, 2e-6);
  EXPECT_NEAR(static_cast<double>(real(m.points[0].anchor_a.y)), 0.3, 2e-6);
}

TEST(CapsuleCapsule, CollinearGivesOnePointBetweenTheEnds) {
  const Manifold m = meet(k_rod, k_identity, k_rod, k_identity, metres(0, 2.5, 0));
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(m.normal, k_up);
  EXPECT_EQ(m.points[0].separation.raw, 0);
}

TEST(CapsuleCapsule, CoincidentAndMeetingCoresPartSideways) {
  for (const double shift : {0.0, 0.7}) {
    const Manifold along = meet(k_rod, k_identity, k_rod, k_identity, metres(0, shift, 0));
    ASSERT_EQ(along.count, 2);
    EXPECT_EQ(along.normal.y.raw, 0);
    EXPECT_EQ(separation(along), -0.5);
    const Manifold across = meet(k_rod, k_identity, k_rod, k_lying, metres(0.3, shift, 0));
    ASSERT_EQ(across.count, 1);
    EXPECT_EQ(abs(across.normal.z), Unit::from_integer(1));
    EXPECT_EQ(separation(across), -0.5);
  }
}

TEST(CapsuleCapsule, AnEndOnTheOtherCorePartsSquareToBoth) {
  const Manifold m = meet(k_rod, k_identity, k_rod, k_lying, metres(1, 0.25, 0));
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(separation(m), -0.5);
  EXPECT_EQ(abs(m.normal.z), Unit::from_integer(1));
}

TEST(BoxSphere, MeetsFaceEdgeAndVertex) {
  const Manifold face = meet(k_box, k_identity, k_ball, k_identity, metres(1, 1.51, 0.2));
  ASSERT_EQ(face.count, 1);
  EXPECT_EQ(face.normal, k_up);
  EXPECT_NEAR(separation(face), 0.01, 2e-6);
  const Manifold edge = meet(k_box, k_identity, k_ball, k_identity, metres(2.3, 1.4, 0));
  ASSERT_EQ(edge.count, 1);
  EXPECT_NEAR(separation(edge), 0, 2e-6);
  EXPECT_NEAR(static_cast<double>(real(edge.normal.x)), 0.6, 2e-6);
  const Manifold vertex = meet(k_box, k_identity, k_ball, k_identity, metres(-2.3, -1.3, 0.7));
  ASSERT_EQ(vertex.count, 1);
  EXPECT_NEAR(separation(vertex), std::sqrt(0.22) - 0.5, 3e-6);
}

TEST(BoxSphere, ACentreInsideLeavesByTheNearestFaceAndTiesGoToTheFirstAxis) {
  const Manifold m = meet(k_box, k_identity, k_ball, k_identity, metres(1, 0.2, -0.4));
  EXPECT_EQ(m.normal.z, Unit::from_integer(-1));
  EXPECT_NEAR(separation(m), -0.6, 2e-6);
  const Shape cube = Shape::box(metres(1), metres(1), metres(1));
  EXPECT_EQ(meet(cube, k_identity, k_ball, k_identity, {}).normal, k_right);
}

TEST(BoxCapsule, LyingOnAFaceGivesTwoPoints) {
  const Manifold m = meet(k_box, k_identity, k_rod, k_lying, metres(0.1, 1.26, 0));
  ASSERT_EQ(m.count, 2);
  EXPECT_EQ(m.normal, k_up);
  for (std::size_t i = 0; i < 2; ++i)
    EXPECT_NEAR(separation(m, i), 0.01, 2e-6);
  EXPECT_EQ(m.points[0].anchor_b.x, metres(-1));
  EXPECT_EQ(m.points[1].anchor_b.x, metres(1));
}

TEST(BoxCapsule, HangingOverTheRimIsClippedToTheFace) {
  for (const double tilt : {0.0, 1e-6, -1e-6}) {
    const Mat3 rotation = turned(0, 0, 1, -3.14159265358979 / 2 + tilt);
    const Manifold m = meet(k_box, k_identity, k_rod, rotation, metres(1.5, 1.249, 0));
    ASSERT_EQ(m.count, 2) << tilt;
    EXPECT_NEAR(static_cast<double>(real(m.points[1].anchor_a.x)), 2, 1e-5);
    EXPECT_NEAR(static_cast<double>(real(m.points[0].anchor_a.x)), 0.5, 1e-5);
    EXPECT_NEAR(separation(m, 0), -0.001, 1e-5);
    EXPECT_NEAR(separation(m, 1), -0.001, 1e-5);
  }
}

TEST(BoxCapsule, StandingOnAFaceGivesOnePoint) {
  const Manifold m = meet(k_box, k_identity, k_rod, k_identity, metres(1, 2.26, 0.1));
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(m.normal, k_up);
  EXPECT_NEAR(separation(m), 0.01, 2e-6);
}

TEST(BoxCapsule, ACoreTouchingOrCrossingAFaceKeepsItsNormal) {
  for (const double height : {1.0001, 1.0, 0.9999, 0.9}) {
    const Manifold m = meet(k_box, k_identity, k_rod, k_lying, metres(0, height, 0));
    ASSERT_EQ(m.count, 2) << height;
    EXPECT_EQ(m.normal, k_up);
    EXPECT_NEAR(separation(m), height - 1.25, 2e-6);
  }
}

TEST(BoxCapsule, ACoreAcrossAnEdgeParsAlongTheBisector) {
  // The core runs along (1, −1, 0)/√2 and passes 0.02 inside the edge x = 2, y = 1.
  const Mat3 rotation = turned(0, 0, 1, -3 * 3.14159265358979 / 4);
  const double inside = 0.02 / std::sqrt(2.0);
  const Manifold m = meet(k_box, k_identity, k_rod, rotation, metres(2 - inside, 1 - inside, 0));
  ASSERT_EQ(m.count, 1);
  EXPECT_NEAR(separation(m), -0.27, 1e-5);
  EXPECT_NEAR(static_cast<double>(real(m.normal.x)), std::sqrt(0.5), 1e-5);
  EXPECT_NEAR(static_cast<double>(real(m.normal.y)), std::sqrt(0.5), 1e-5);
}

TEST(RoundPairs, AreFarWhenTheMarginSaysSo) {
  EXPECT_EQ(meet(k_ball, k_identity, k_ball, k_identity, metres(1.06, 0, 0)).count, 0);
  EXPECT_EQ(meet(k_ball, k_identity, k_ball, k_identity, metres(1.04, 0, 0)).count, 1);
  EXPECT_EQ(meet(k_ball, k_identity, k_ball, k_identity, metres(1.04, 0, 0), 0.04).count, 0);
}

}  // namespace
}  // namespace lockstone::test
