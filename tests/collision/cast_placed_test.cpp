// Casts against many pieces and points near them: the same as asking every piece by itself.
#include "core/collision/query/cast_placed.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>

#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/distance/motion/shape_cast.h"
#include "tests/geometry/assets/asset_parts.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

constexpr Unit k_whole = Unit::from_integer(1);

AssetPtr random_mesh(Dice& dice) {
  return Mesh::build(random_triangles(dice, 300, 10, 2).def()).mesh;
}

AssetPtr random_field(Dice& dice) {
  std::vector<Length> heights;
  for (int i = 0; i < 20 * 17; ++i)
    heights.push_back(metres(dice.uniform(-2, 2)));
  HeightFieldDef def;
  def.columns = 20;
  def.rows = 17;
  def.heights = heights;
  def.cell_x = metres(0.75);
  def.cell_z = metres(1.25);
  def.origin = metres(-7, 0, -9);
  return HeightField::build(def).height_field;
}

AssetPtr random_compound(Dice& dice) {
  std::vector<CompoundChild> children(12);
  for (CompoundChild& child : children) {
    child.shape = dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.2, 3);
    child.position = metres(dice.uniform(-8, 8), dice.uniform(-8, 8), dice.uniform(-8, 8));
    child.orientation = dice.orientation();
  }
  return Compound::build(children).compound;
}

Vec3<Position> random_place(Dice& dice, double reach) {
  Vec3<Position> place;
  for (int i = 0; i < 3; ++i)
    place[i] = rounded<Position>(metres(dice.uniform(-reach, reach)));
  return place;
}

PlacedShape placed(Dice& dice, const Shape& shape, const Asset* asset, double reach) {
  const Vec3<Position> place = random_place(dice, reach);
  return {shape, geometry::geometry_of(asset), place, to_matrix(dice.orientation()), place};
}

// Asks every piece for the whole way, in the order of parts.
class CastAll final : public PieceVisitor {
 public:
  CastAll(const PlacedShape& convex, const Vec3<Length>& way) : convex_(convex), way_(way) {}

  void visit(const Piece& piece) override {
    const Piece shape = single_piece(convex_);
    if (is_behind(oriented_box(convex_).centre, piece)) return;
    const ShapeCastHit hit = cast_shape(piece.posed(), shape.posed(),
                                        saturated<Length>(shape.origin - piece.origin), way_);
    if (!hit.hit || (best.hit && hit.fraction >= best.fraction)) return;
    best = {true, piece.part, hit.fraction, hit.normal,
            piece.origin + rounded<Position>(hit.point_a)};
  }

  PlacedShapeHit best;

 private:
  const PlacedShape& convex_;
  const Vec3<Length>& way_;
};

class NearestOfAll final : public PieceVisitor {
 public:
  explicit NearestOfAll(const Vec3<Position>& point) : point_(point) {}

  void visit(const Piece& piece) override {
    const ClosestPoints found = distance(piece.posed(), {Shape::sphere({}), Mat3{}},
                                         saturated<Length>(point_ - piece.origin));
    const Length away = saturated<Length>(found.distance);
    if (best.found && away >= best.distance) return;
    best = {true, piece.part, away, {}};
  }

  PlacedClosest best;

 private:
  const Vec3<Position>& point_;
};

const OrientedBox k_everything{{}, {}, {metres(500), metres(500), metres(500)}};

using AssetMaker = AssetPtr (*)(Dice& dice);

class ManyPieces : public ::testing::TestWithParam<AssetMaker> {};

TEST_P(ManyPieces, AreCastAtAsEachOfThemAlone) {
  Dice dice;
  int hits = 0, misses = 0;
  for (int i = 0; i < 40; ++i) {
    const AssetPtr asset = GetParam()(dice);
    const PlacedShape target = placed(dice, asset->shape(), asset.get(), 2);
    for (int k = 0; k < 10; ++k) {
      const Shape shape = dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.05, 1);
      const PlacedShape convex = placed(dice, shape, nullptr, 15);
      const Vec3<Position> towards = random_place(dice, 8);
      const Vec3<Length> way = saturated<Length>(towards + towards - convex.origin - convex.origin);
      CastAll all(convex, way);
      visit_pieces(target, k_everything, {}, all);
      const PlacedShapeHit hit = cast_shape(target, convex, way, k_whole);
      ++(hit.hit ? hits : misses);
      ASSERT_EQ(hit.hit, all.best.hit);
      ASSERT_EQ(hit.part, all.best.part);
      ASSERT_EQ(hit.fraction, all.best.fraction);
      ASSERT_EQ(hit.normal, all.best.normal);
      ASSERT_EQ(hit.point, all.best.point);
      if (!hit.hit) continue;
      EXPECT_TRUE(cast_shape(target, convex, way, hit.fraction).hit);
      if (hit.fraction == Unit{}) continue;
      const Unit before = Unit::from_raw(hit.fraction.raw - 1);
      EXPECT_FALSE(cast_shape(target, convex, way, before).hit);
    }
  }
  EXPECT_GT(hits, 50);
  EXPECT_GT(misses, 20);
}

TEST_P(ManyPieces, AreAsNearAsTheNearestOfThem) {
  Dice dice;
  for (int i = 0; i < 40; ++i) {
    const AssetPtr asset = GetParam()(dice);
    const PlacedShape target = placed(dice, asset->shape(), asset.get(), 2);
    for (int k = 0; k < 10; ++k) {
      const Vec3<Position> point = random_place(dice, k < 5 ? 10 : 40);
      NearestOfAll all(point);
      visit_pieces(target, k_everything, {}, all);
      const PlacedClosest found = closest_point(target, point, metres(200));
      ASSERT_TRUE(found.found);
      ASSERT_EQ(found.distance, all.best.distance);
      ASSERT_EQ(found.part, all.best.part);
      EXPECT_TRUE(closest_point(target, point, found.distance).found);
      if (found.distance > Length{}) {
        EXPECT_FALSE(closest_point(target, point, found.distance - Length::from_raw(1)).found);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Assets, ManyPieces,
                         ::testing::Values(random_mesh, random_field, random_compound));

// Along a side of a long box, closer and closer, also with ways that barely meet it or miss it.
TEST(CastPlaced, FindsThePathsBesideABoxThatACastOfThePiecesFinds) {
  Dice dice;
  int hits = 0, misses = 0;
  for (int i = 0; i < test::share_of(8000); ++i) {
    const double width = std::exp2(dice.uniform(-3, 8)), height = std::exp2(dice.uniform(-3, 8));
    const PlacedShape target =
        placed(dice, Shape::box(metres(width), metres(height), metres(width)), nullptr, 2);
    const Shape shape = dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.05, 1);
    PlacedShape convex = placed(dice, shape, nullptr, 1);
    const double along = dice.uniform(-1.2, 1.2), across = dice.uniform(-1.2, 1.2);
    const Vec3<Length> up =
        world_half_extents(shape, multiply(transposed(target.rotation), convex.rotation));
    const double gap = std::exp2(dice.uniform(-16, 1)), dip = dice.uniform(-1.5, 1.5) * gap;
    const double length = std::exp2(dice.uniform(-8, 7));
    const double x = dice.uniform(-length, length), z = dice.uniform(-length, length);
    const Vec3<Length> local = metres(along * width, height + gap, across * width);
    convex.origin = convex.centre =
        target.origin +
        rotate(target.rotation, rounded<Position>(local + Vec3<Length>{{}, up.y, {}}));
    const Vec3<Length> way =
        saturated<Length>(rotate(target.rotation, rounded<Position>(metres(x, dip, z))));
    CastAll all(convex, way);
    all.visit(single_piece(target));
    const PlacedShapeHit hit = cast_shape(target, convex, way, k_whole);
    ++(hit.hit ? hits : misses);
    ASSERT_EQ(hit.hit, all.best.hit) << i;
    ASSERT_EQ(hit.fraction, all.best.fraction) << i;
    ASSERT_EQ(hit.normal, all.best.normal) << i;
    ASSERT_EQ(hit.point, all.best.point) << i;
  }
  EXPECT_GT(hits, test::share_of(500));
  EXPECT_GT(misses, test::share_of(1500));
}

// The middle of the corner's bounds lies half a metre beyond its slanted face, and behind a
// triangle in front of that face.
TEST(CastPlaced, AHullMeetsTheTriangleThatTheMiddleOfItsBoundsIsBehind) {
  const std::vector<Vec3<Length>> corner{metres(0, 0, 0), metres(1, 0, 0), metres(0, 1, 0),
                                         metres(0, 0, 1)};
  const auto hull = Hull::build(corner).hull;
  ASSERT_NE(hull, nullptr);
  const std::vector<Vec3<Length>> vertices{metres(3.6, -1.2, -1.2), metres(-1.2, -1.2, 3.6),
                                           metres(-1.2, 3.6, -1.2)};
  const std::vector<TriangleIndices> triangles{{0, 1, 2}};
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  const auto mesh = Mesh::build(def).mesh;
  ASSERT_NE(mesh, nullptr);
  const PlacedShape target{mesh->shape(), &mesh->geometry(), {}, {}, {}};
  const PlacedShape convex{hull->shape(), &hull->geometry(), {}, {}, {}};
  const PlacedShapeHit hit = cast_shape(target, convex, metres(0.5, 0.5, 0.5), k_whole);
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(static_cast<double>(real(hit.fraction)), 0.2 / 1.5, 1e-5);
}

}  // namespace
}  // namespace lockstone::test
