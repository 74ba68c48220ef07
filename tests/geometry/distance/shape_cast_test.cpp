// Shapes cast along lines.
#include "core/geometry/distance/motion/shape_cast.h"

#include "core/geometry/distance/epa/epa.h"
#include "tests/geometry/pairs/convex_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

/// B starts beyond reach of A and flies towards a point near A, for as far again or less.
struct Cast {
  ConvexPair pair;
  Vec3<Length> way;

  [[nodiscard]] ShapeCastHit run() {
    return cast_shape(pair.a.posed(), pair.b.posed(), pair.offset, way);
  }
  /// Distance at a fraction of the way, or the depth with a minus sign, by GJK and EPA, which have
  /// their own tests. The place is rounded to 0.5 µm an axis.
  [[nodiscard]] Real at(Real fraction) {
    const Vec3<Length> there = pair.offset + metres(real(way) * fraction);
    const ClosestPoints points = distance(pair.a.posed(), pair.b.posed(), there);
    if (!points.overlapping) return real(points.distance);
    return -real(penetration(pair.a.posed(), pair.b.posed(), there).depth);
  }
};

Cast random_cast(Dice& dice, const ConvexPair& pair) {
  const RealPair reals(pair);
  const Real far = std::min<Real>(reals.size * static_cast<Real>(dice.uniform(0.5, 1.5)), 1000);
  const RealVec aside = dice.direction() * (reals.size * static_cast<Real>(dice.uniform(0, 0.5)));
  Cast cast{pair, {}};
  cast.pair.offset = metres(dice.direction() * far);
  const RealVec target = norm(aside) > 300 ? RealVec{} : aside;
  cast.way = metres((target - real(cast.pair.offset)) *
                    std::min<Real>(static_cast<Real>(dice.uniform(0.5, 2.5)), 1400 / far));
  return cast;
}

Real tolerance(const Cast& cast) {
  return 2 * k_micrometre + 8e-9L * (RealPair(cast.pair).size + norm(real(cast.way)));
}

TEST(ShapeCast, ReachesContactAndNothingBeforeIt) {
  int hits = 0;
  for_convex_pairs(60, [&hits](Dice& dice, ConvexPair& pair) {
    Cast cast = random_cast(dice, pair);
    const ShapeCastHit hit = cast.run();
    const Real slack = tolerance(cast);
    if (hit.overlapping) {
      EXPECT_LE(cast.at(0), 0);
      EXPECT_EQ(hit.fraction, Unit{});
      return;
    }
    const Real end = hit.hit ? real(hit.fraction) : 1;
    for (int i = 0; i < 24; ++i) {
      EXPECT_GT(static_cast<double>(cast.at(end * i / 24)), -static_cast<double>(slack));
    }
    if (!hit.hit) return;
    ++hits;
    EXPECT_NEAR(static_cast<double>(cast.at(end)), 0, static_cast<double>(slack));
    EXPECT_NEAR(static_cast<double>(norm(real(hit.normal))), 1.0, 1e-8);
    EXPECT_LT(dot(real(hit.normal), real(cast.way)), slack);
    const RealVec on_b =
        real(hit.point_b) + real(cast.pair.offset) + real(cast.way) * real(hit.fraction);
    EXPECT_LE(norm(on_b - real(hit.point_a)), slack + 2 * k_micrometre);  // points are rounded
  });
  EXPECT_GT(hits, 400);
}

TEST(ShapeCast, SwappingTheShapesMirrorsTheHitBitForBit) {
  for_convex_pairs(40, [](Dice& dice, ConvexPair& pair) {
    Cast cast = random_cast(dice, pair);
    const ShapeCastHit one = cast.run();
    const ShapeCastHit two =
        cast_shape(cast.pair.b.posed(), cast.pair.a.posed(), -cast.pair.offset, -cast.way);
    EXPECT_EQ(one.hit, two.hit);
    EXPECT_EQ(one.fraction, two.fraction);
    EXPECT_EQ(one.normal, -two.normal);
    EXPECT_EQ(one.point_a, two.point_b);
  });
}

TEST(ShapeCast, OfASphereIsTheRootOfAQuadratic) {
  Dice dice;
  for (int i = 0; i < test::share_of(2000); ++i) {
    Convex a = convex(Shape::sphere(dice.size(0.01, 10)));
    Convex b = convex(Shape::sphere(dice.size(0.01, 10)));
    const Real reach = real(a.shape.size.x) + real(b.shape.size.x);
    const RealVec from = dice.direction() * (reach * 5);
    const RealVec to = dice.direction() * (reach * static_cast<Real>(dice.uniform(0, 1.2)));
    const Vec3<Length> offset = metres(from);
    const Vec3<Length> way = metres(to - from);
    const RealVec d = real(offset);
    const RealVec v = real(way);
    const Real half_b = dot(d, v);
    const Real discriminant = half_b * half_b - dot(v, v) * (dot(d, d) - reach * reach);
    const ShapeCastHit hit = cast_shape(a.posed(), b.posed(), offset, way);
    const Real nearest = norm(d - v * (half_b / dot(v, v)));
    if (std::fabs(nearest - reach) < 2 * k_micrometre) continue;
    const Real root = discriminant < 0 ? 2 : (-half_b - std::sqrt(discriminant)) / dot(v, v);
    if (std::fabs(root - 1) < 1e-4L) continue;
    ASSERT_EQ(hit.hit, root < 1);
    if (!hit.hit) continue;
    const RealVec there = d + v * real(hit.fraction);
    EXPECT_NEAR(static_cast<double>(norm(there)), static_cast<double>(reach), 2e-6);
  }
}

TEST(ShapeCast, GrazesWithoutEnd) {
  Convex a = convex(Shape::sphere(metres(1)));
  Convex b = convex(Shape::sphere(metres(1)));
  for (int raw = -8; raw <= 8; ++raw) {
    const Vec3<Length> offset{metres(-100), Length::from_raw(metres(2).raw + raw), {}};
    const ShapeCastHit hit = cast_shape(a.posed(), b.posed(), offset, metres(200, 0, 0));
    if (raw > 0 && raw < 4) continue;
    EXPECT_EQ(hit.hit, raw <= 0) << raw;
  }
}

TEST(ShapeCast, LeavesASurfaceThatItSlidesAlong) {
  Convex floor = convex(Shape::box(metres(10), metres(1), metres(10)));
  Convex box = convex(Shape::box(metres(1), metres(1), metres(1)));
  const Vec3<Length> resting{{}, Length::from_raw(metres(2).raw + 1), {}};
  EXPECT_FALSE(cast_shape(floor.posed(), box.posed(), resting, metres(0, 5, 0)).hit);
  const ShapeCastHit down = cast_shape(floor.posed(), box.posed(), resting, metres(0, -5, 0));
  EXPECT_TRUE(down.hit);
  EXPECT_EQ(down.fraction, Unit{});
  EXPECT_EQ(down.normal, (Vec3<Unit>{{}, unit(1), {}}));
}

TEST(ShapeCast, StartsOverlappingWithTheWayOut) {
  Convex floor = convex(Shape::box(metres(10), metres(1), metres(10)));
  Convex box = convex(Shape::box(metres(1), metres(1), metres(1)));
  const ShapeCastHit hit =
      cast_shape(floor.posed(), box.posed(), metres(0.5, 1.5, 0), metres(0, 5, 0));
  EXPECT_TRUE(hit.hit);
  EXPECT_TRUE(hit.overlapping);
  EXPECT_EQ(hit.fraction, Unit{});
  EXPECT_EQ(hit.normal, (Vec3<Unit>{{}, unit(1), {}}));
}

}  // namespace
}  // namespace lockstone::test
