// Pairs that `lockstone fuzz-pairs` found broken once, each with its defect.
#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/motion/shape_cast.h"
#include "core/geometry/mesh_contact/triangle_polytope.h"
#include "tests/geometry/pairs/convex_scene.h"

namespace lockstone::test {
namespace {

constexpr Vec3<Length> raw(std::int32_t x, std::int32_t y, std::int32_t z) {
  return {Length::from_raw(x), Length::from_raw(y), Length::from_raw(z)};
}
constexpr Vec3<Unit> raw_unit(std::int32_t x, std::int32_t y, std::int32_t z) {
  return {Unit::from_raw(x), Unit::from_raw(y), Unit::from_raw(z)};
}
constexpr Shape raw_box(std::int32_t x, std::int32_t y, std::int32_t z) {
  return Shape::box(Length::from_raw(x), Length::from_raw(y), Length::from_raw(z));
}

// The normal was +y whatever the order.
TEST(FuzzedPairs, ConcentricSpheresOfTwoSizesFlip) {
  const Mat3 identity;
  const Shape small = Shape::sphere(metres(0.25)), large = Shape::sphere(metres(1));
  const Manifold one = collide({small, identity}, {large, identity}, {}, {});
  const Manifold two = collide({large, identity}, {small, identity}, {}, {});
  EXPECT_EQ(one.normal, -two.normal);
  EXPECT_EQ(two.normal, raw_unit(0, 1 << 30, 0));
}

// A step left less between flush faces than the lattice rounds by; the cast then answered the place
// before the step, 84 m away.
TEST(FuzzedPairs, ACastOntoAFlushFaceComesNear) {
  const Mat3 turn{raw_unit(631128774, -544473135, -676865556),
                  raw_unit(851634827, 222914557, 614775346),
                  raw_unit(-171219441, -898209113, 562872808)};
  const Shape a = raw_box(3011594, 164781, 164781), b = raw_box(99808970, 370374494, 375577794);
  const Vec3<Length> from = raw(-161200245, -69716884, 208782995);
  const Vec3<Length> way = raw(-155546626, -192970452, -172050384);
  const ShapeCastHit hit = cast_shape({a, turn}, {b, turn}, from, way);
  ASSERT_TRUE(hit.hit);
  const RealVec there = real(from) + real(way) * real(hit.fraction);
  EXPECT_LT(norm(real(hit.point_b) + there - real(hit.point_a)), 2e-5L);
}

// Of two faces in nearly one plane EPA ended with the one that does not hold the foot, and took its
// deepest points 4.7 mm aside.
TEST(FuzzedPairs, DeepestPointsAreOppositeEachOther) {
  const Mat3 turn_a{raw_unit(-905253371, 0, 577440768), raw_unit(0, 1073741824, 0),
                    raw_unit(-577440768, 0, -905253371)};
  const Mat3 turn_b{raw_unit(1073741824, -1648, -218), raw_unit(1648, 1073741824, -1524),
                    raw_unit(218, 1524, 1073741824)};
  Convex a =
      convex({raw(18779, -27012, 812), raw(61498, -87385, 952), raw(-4694, 6336, 459)}, turn_a);
  Convex b = convex({raw(-4463064, -18958, -1457211), raw(-4463064, 18958, -1457211),
                     raw(-2596705, -18958, 3911461), raw(-2596705, 18958, 3911461),
                     raw(2596705, -18958, -3911461), raw(2596705, 18958, -3911461),
                     raw(4463064, -18958, 1457211), raw(4463064, 18958, 1457211)},
                    turn_b);
  const Vec3<Length> offset = raw(2, 3, -2);
  const Penetration deep = penetration(a.posed(), b.posed(), offset);
  ASSERT_TRUE(deep.overlapping);
  const RealVec gap = real(deep.point_b) + real(offset) - real(deep.point_a);
  EXPECT_LT(norm(gap + real(deep.normal) * real(deep.depth)), 5e-6L);
}

// Beside a rim of the box two of its faces are as near as 15 µm; the one that was taken leans back
// from the triangle's front, and the contact was lost.
TEST(FuzzedPairs, ATriangleAtARimIsMet) {
  const Mat3 turn_a{raw_unit(558476064, -735565596, 547694482),
                    raw_unit(-128374916, 572240963, 899434081),
                    raw_unit(-908045082, -533296389, 209691664)};
  const Mat3 turn_b{raw_unit(558475956, -735565693, 547694462),
                    raw_unit(-128374904, 572240915, 899434113),
                    raw_unit(-908045150, -533296306, 209691578)};
  geometry::TrianglePolytope triangle;
  const geometry::Polytope& view =
      triangle.set({raw(183, -78, 263), raw(29, -90, 17), raw(57, -559, -84)});
  const Shape box = raw_box(277290399, 61926280, 207235257);
  const Shape flat{ShapeKind::hull, {}, {}};
  const Manifold m = collide({box, turn_a}, {flat, turn_b, &view},
                             raw(-33138340, -283490466, 196677855), Length::from_raw(949));
  EXPECT_GT(m.count, 0);
}

// A corner of a small box on the face of a large one. Another face of the expanding polytope was as
// near, held the foot, and supported nothing: the way out led through 240 m.
TEST(FuzzedPairs, TheWayOutLeadsOut) {
  const Mat3 turn{raw_unit(1073741822, -22737, 64976), raw_unit(22739, 1073741824, -21213),
                  raw_unit(-64976, 21215, 1073741822)};
  const Shape a = raw_box(38191, 10651, 10651), b = raw_box(301596964, 125637077, 239719122);
  const Penetration deep =
      penetration({a, turn}, {b, Mat3{}}, raw(301635155, -125647729, -120142668));
  ASSERT_TRUE(deep.overlapping);
  EXPECT_LT(real(deep.depth), 1e-6L);
  EXPECT_LT(deep.normal.y.raw, -1'000'000'000);
}

// The axis of 30 bits is not of norm 1, and left the nearest point 0.2 µm along it: between cores
// 2 µm apart the normal leaned on the axes by 5°.
TEST(FuzzedPairs, TheNormalOfCapsulesThatAlmostCoincideIsSquareToThem) {
  const Mat3 turn_a{raw_unit(-1045488595, -103334942, -221803955),
                    raw_unit(-102844379, -697590425, 809760544),
                    raw_unit(-222031841, 809698089, 669337263)};
  const Mat3 turn_b{raw_unit(-1045488596, -103334942, -221803952),
                    raw_unit(-102844377, -697590425, 809760544),
                    raw_unit(-222031839, 809698089, 669337263)};
  const Shape a = Shape::capsule(Length::from_raw(227101125), Length::from_raw(55583587));
  const Shape b = Shape::capsule(Length::from_raw(163029852), Length::from_raw(67107178));
  const Manifold m = collide({a, turn_a}, {b, turn_b}, raw(2, -3, 2), {});
  ASSERT_GT(m.count, 0);
  EXPECT_LT(std::abs(dot(real(m.normal), real(turn_a.y))), 1e-3L);
}

// The least separation of the triangle and the rimmed shape, as far as there are points.
long double least_separation(const Shape& shape, const Mat3& turn, const Mat3& turn_triangle,
                             const geometry::TriangleVertices& vertices, const Vec3<Length>& offset,
                             Length margin) {
  geometry::TrianglePolytope triangle;
  const geometry::Polytope& view = triangle.set(vertices);
  const Manifold m = collide({Shape{ShapeKind::hull, {}, {}}, turn_triangle, &view}, {shape, turn},
                             offset, margin);
  long double least = 1e30L;
  for (std::size_t i = 0; i < static_cast<std::size_t>(m.count); ++i)
    least = std::min(least, real(m.points[i].separation));
  return least;
}

// The side of a cylinder touches an edge of a triangle by 0.6 µm. The direction of so short a way
// is rounding: it leaned back, and the front pushed by 62 m.
TEST(FuzzedPairs, ATriangleThatTouchesACylinderBesideItsFrontPushesByNoMore) {
  const Mat3 turn_triangle{raw_unit(458395134, 207121355, -948628563),
                           raw_unit(-15147264, 1050426361, 222028207),
                           raw_unit(970858366, -81404599, 451363301)};
  const Mat3 turn{raw_unit(1073741824, 0, 0), raw_unit(0, 0, -1073741824),
                  raw_unit(0, 1073741824, 0)};
  const Shape cylinder = Shape::cylinder(Length::from_raw(249372339), Length::from_raw(112159506));
  const long double least =
      least_separation(cylinder, turn, turn_triangle,
                       {raw(14189661, 42798568, -41112272), raw(11365001, 34054624, -86384495),
                        raw(11128959, 33473906, -54420837)},
                       raw(-35844669, -72771488, 223585259), {});
  EXPECT_NEAR(static_cast<double>(least), 0, 6e-6);
}

// The same where a cylinder stands 3 µm before the edge: there was no contact.
TEST(FuzzedPairs, ATriangleMeetsACylinderThatAlmostTouchesIt) {
  const Mat3 turn{raw_unit(-664487534, 744767233, -395852993),
                  raw_unit(-195611648, 354122682, 994612847),
                  raw_unit(820435193, 687633914, -83469751)};
  const Mat3 turn_triangle{raw_unit(-664333703, 744933904, -395797570),
                           raw_unit(-195511715, 354111518, 994636471),
                           raw_unit(820583577, 687459101, -83451077)};
  const Shape cylinder = Shape::cylinder(Length::from_raw(180996), Length::from_raw(172545));
  const long double least =
      least_separation(cylinder, turn, turn_triangle,
                       {raw(-1785719, -1524255, -23581), raw(-1409435, -1368232, -319063),
                        raw(-1292743, -1319756, -411571)},
                       raw(536524, -1481968, -596269), Length::from_raw(114667));
  EXPECT_NEAR(static_cast<double>(least), 3e-6, 6e-6);
}

// A cone 8 µm behind the front's edge is not met: axes turned to the front would push by 0.8 mm.
TEST(FuzzedPairs, ATriangleDoesNotMeetAConeBehindItsEdge) {
  const Mat3 turn{raw_unit(10697855, -1073430936, 23517772),
                  raw_unit(-773375785, -24018053, -744469296),
                  raw_unit(744779804, -9521703, -773391159)};
  const Mat3 turn_triangle{raw_unit(339373246, 873889172, -523512197),
                           raw_unit(-985499478, 421366601, 64517222),
                           raw_unit(257949770, 460097172, 935250775)};
  const Shape cone{ShapeKind::cone, {Length::from_raw(573732), Length::from_raw(231892), {}}, {}};
  EXPECT_GT(least_separation(cone, turn, turn_triangle,
                             {raw(-563789, 499216, 102909), raw(966501, -953843, -231887),
                              raw(-634195, 283378, -41630)},
                             raw(1141116, 876191, -848233), {}),
            1.0L);
}

}  // namespace
}  // namespace lockstone::test
