// Clipping of a box's face to slabs, against exact quotients and against areas in floating point.
#include "core/geometry/contact/box/box_clip.h"

#include <cmath>
#include <set>

#include "core/geometry/contact/box/box_face.h"
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/math/int128.h"
#include "tests/geometry/scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

using geometry::ClipPolygon;
using geometry::ClipVertex;
using geometry::Fine;
using geometry::Slab;

constexpr Fine k_metre = Fine{1} << geometry::k_fine_bits;

Fine fine_of(double x) {
  return static_cast<Fine>(std::ldexp(x, geometry::k_fine_bits));
}

ClipPolygon quadrilateral(Dice& dice, double size) {
  const auto length = [&] { return fine_of(dice.uniform(-size, size)); };
  const std::array<Fine, 3> middle{length(), length(), length()};
  const std::array<Fine, 3> u{length(), length(), length()};
  const std::array<Fine, 3> v{length(), length(), length()};
  ClipPolygon polygon;
  polygon.count = 0;
  for (std::uint32_t i = 0; i < 4; ++i) {
    ClipVertex vertex;
    for (std::size_t k = 0; k < 3; ++k)
      vertex.at[k] = middle[k] + (i == 1 || i == 2 ? -u[k] : u[k]) + (i >= 2 ? -v[k] : v[k]);
    vertex.edge = i;
    polygon.add(vertex);
  }
  return polygon;
}

long double area(const ClipPolygon& polygon) {
  long double sum = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& a = polygon[i];
    const ClipVertex& b = polygon[(i + 1) % polygon.count];
    sum += static_cast<long double>(a.at[0]) * static_cast<long double>(b.at[1]) -
           static_cast<long double>(b.at[0]) * static_cast<long double>(a.at[1]);
  }
  return std::fabs(std::ldexp(sum, -2 * geometry::k_fine_bits)) / 2;
}

ClipPolygon clipped(const ClipPolygon& polygon, Fine half_x, Fine half_y) {
  ClipPolygon by_x, result;
  Slab<0>{half_x, 0}.clip(polygon, by_x);
  result.count = 0;
  if (by_x.count > 0) Slab<1>{half_y, 0}.clip(by_x, result);
  return result;
}

TEST(BoxClip, SharesErrByLessThanTwoToMinus30) {
  Dice dice;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const Fine depth = dice.between(1, Fine{1} << dice.between(0, 61));
    const Fine excess = dice.between(1, Fine{1} << dice.between(0, 61));
    const long double exact =
        static_cast<long double>(depth) / (static_cast<long double>(depth) + excess);
    const std::uint64_t share = geometry::cut_share(depth, excess);
    EXPECT_LE(share, std::uint64_t{1} << 32);
    EXPECT_LT(std::fabs(std::ldexp(static_cast<long double>(share), -32) - exact), 0x1p-30L);
  }
}

TEST(BoxClip, PartsAreTheNearestAndOdd) {
  Dice dice;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const Fine rise = dice.between(0, Fine{1} << dice.between(0, 62));
    const auto share = static_cast<std::uint64_t>(dice.between(0, Fine{1} << 32));
    const UInt128 exact = round_shift(multiply_wide(static_cast<std::uint64_t>(rise), share), 32);
    EXPECT_EQ(static_cast<std::uint64_t>(geometry::part_of(rise, share)), exact.low);
    EXPECT_EQ(geometry::part_of(-rise, share), -geometry::part_of(rise, share));
  }
}

TEST(BoxClip, ThePartsOfACutMakeUpTheWhole) {
  Dice dice;
  for (int i = 0; i < test::share_of(5000); ++i) {
    const ClipPolygon polygon = quadrilateral(dice, 1);
    const Fine half_x = fine_of(dice.uniform(0.1, 1)), half_y = fine_of(dice.uniform(0.1, 1));
    // The strip within |x| ≤ half is the intersection of the two half-planes: areas add up in y.
    ClipPolygon strip;
    Slab<0>{half_x, 0}.clip(polygon, strip);
    long double sum = 0;
    for (const int part : {-1, 0, 1}) {  // below, within and above |y| ≤ half, moved to the middle
      ClipPolygon moved = strip;
      const Fine far = 8 * k_metre;
      const Fine shift = part * (half_y + far);
      for (int k = 0; k < moved.count; ++k)
        moved.vertices[static_cast<std::size_t>(k)].at[1] -= shift;
      ClipPolygon cut;
      cut.count = 0;
      if (moved.count > 0) Slab<1>{part == 0 ? half_y : far, 0}.clip(moved, cut);
      sum += area(cut);
    }
    EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(area(strip)), 1e-8);
  }
}

TEST(BoxClip, NeitherTheBeginningNorTheDirectionOfThePolygonMatters) {
  Dice dice;
  for (int i = 0; i < test::share_of(2000); ++i) {
    const ClipPolygon polygon = quadrilateral(dice, 1);
    const Fine half_x = fine_of(dice.uniform(0.05, 1)), half_y = fine_of(dice.uniform(0.05, 1));
    ClipPolygon turned_back;
    turned_back.count = 0;
    for (int k = 5; k > 1; --k)
      turned_back.add(polygon[k % 4]);
    const ClipPolygon one = clipped(polygon, half_x, half_y);
    const ClipPolygon other = clipped(turned_back, half_x, half_y);
    ASSERT_EQ(one.count, other.count);
    std::multiset<std::array<Fine, 3>> points;
    for (int k = 0; k < one.count; ++k)
      points.insert(one[k].at);
    for (int k = 0; k < other.count; ++k)
      EXPECT_EQ(points.erase(other[k].at), 1U);
  }
}

TEST(BoxClip, AVertexBarelyBeyondASideStaysWithItsName) {
  ClipPolygon square;
  square.count = 0;
  const Fine half = k_metre;
  const Fine over = half + geometry::k_snap;
  square.add({{over, half, 0}, 0});
  square.add({{-half, half, 0}, 1});
  square.add({{-half, -half, 0}, 2});
  square.add({{over, -half, 0}, 3});
  EXPECT_TRUE((Slab<0>{half, geometry::k_snap}.holds(-half, over)));
  EXPECT_FALSE((Slab<0>{half, geometry::k_snap - 1}.holds(-half, over)));
  ClipPolygon cut;
  Slab<0>{half, geometry::k_snap - 1}.clip(square, cut);
  ASSERT_EQ(cut.count, 4);
  EXPECT_EQ(cut[0].at[0], half);
  ClipPolygon outside;
  Slab<0>{half, geometry::k_snap}.clip(square, outside);
  EXPECT_EQ(outside[0].at[0], over);
}

// Boxes that lie on each other, more or less.
TEST(BoxClip, WhereABallIsSharedNoEdgeOverlapsLess) {
  Dice dice;
  int shared = 0, open = 0;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const Shape a = dice.shape(ShapeKind::box, 0.02, 1), b = dice.shape(ShapeKind::box, 0.02, 1);
    const double tilt = std::exp(dice.uniform(std::log(1e-6), std::log(0.3)));
    const double x = dice.uniform(-1, 1) * tilt,
                 y = dice.uniform(-3, 3) * (dice.chance(2) ? tilt : 1);
    const Mat3 ra{}, rb = turned(x, 1, dice.uniform(-1, 1) * tilt, y);
    const double reach = std::ldexp(a.size.x.raw + b.size.x.raw, -Length::frac_bits);
    const double depth = std::exp(dice.uniform(std::log(1e-6), std::log(0.02)));
    const Vec3<Length> offset{metres(dice.uniform(-reach, reach)),
                              a.size.y + b.size.y - metres(depth), metres(dice.uniform(-0.5, 0.5))};
    const PosedShape posed_a{a, ra}, posed_b{b, rb};
    const geometry::BoxPair pair = geometry::make_box_pair(posed_a, posed_b, offset, metres(0.05));
    const bool of_b = dice.chance(2);
    const geometry::FaceAxis face = of_b ? best_face_of_b(pair) : best_face_of_a(pair);
    if (face.separation > 0 || -face.separation > pair.half_a[face.axis] / 8) continue;
    const Fine wanted = dice.between(0, 2 * -face.separation);
    Manifold manifold;
    const bool is_shared = geometry::face_manifold(pair, face, of_b, false, wanted, {}, manifold);
    shared += is_shared ? 1 : 0;
    open += is_shared ? 0 : 1;
    if (is_shared) {
      EXPECT_FALSE(best_edge(pair, -wanted + geometry::k_agreement).found) << wanted;
    }
  }
  EXPECT_GT(shared, 100);
  EXPECT_GT(open, 100);
}

}  // namespace
}  // namespace lockstone::test
