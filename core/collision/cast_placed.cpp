#include "core/collision/cast_placed.h"

#include <algorithm>

#include "core/geometry/gjk.h"
#include "core/geometry/shape_cast.h"
#include "core/math/int128.h"

namespace lockstone {
namespace {

class RayPieces final : public geometry::RayPartVisitor {
 public:
  RayPieces(const PlacedShape& placed, const Vec3<Position>& origin,
            const Vec3<Length>& translation, Unit limit)
      : placed_(placed), origin_(origin), translation_(translation), limit_(limit) {}

  Unit visit(const geometry::Part& part) override {
    visit(piece_of(placed_, part));
    return limit_;
  }

  void visit(const Piece& piece) {
    const ShapeRayHit hit =
        cast_ray(piece.posed(), saturated<Length>(origin_ - piece.origin), translation_);
    if (!hit.hit || hit.fraction > limit_) return;
    if (best_.hit && hit.fraction == best_.fraction && piece.part > best_.part) return;
    best_ = {true, piece.part, hit.fraction, hit.normal};
    limit_ = hit.fraction;
  }

  [[nodiscard]] const PlacedRayHit& best() const { return best_; }

 private:
  const PlacedShape& placed_;
  const Vec3<Position>& origin_;
  const Vec3<Length>& translation_;
  Unit limit_;
  PlacedRayHit best_;
};

// Against a half-space the distance falls evenly.
ShapeCastHit cast_at_half_space(const PosedShape& plane, const PosedShape& shape,
                                const Vec3<Length>& offset, const Vec3<Length>& translation) {
  const ClosestPoints start = distance(plane, shape, offset);
  ShapeCastHit hit{false, start.overlapping, {}, plane.rotation.y, start.point_a, start.point_b};
  const std::int64_t way = -dot(plane.rotation.y, translation).raw;  // 50 fraction bits
  const std::int64_t gap = start.distance.raw;                       // 32
  const bool closes = way > 0 && gap <= raw::round_shift(way, 18);
  hit.hit = start.overlapping || closes;
  if (start.overlapping || !closes) return hit;
  const UInt128 numerator = UInt128{0, static_cast<std::uint64_t>(gap)} << 48;
  const std::uint64_t quotient = divide(numerator, static_cast<std::uint64_t>(way)).quotient;
  hit.fraction = {static_cast<std::int32_t>(std::min(quotient, std::uint64_t{1} << 30))};
  return hit;
}

class CastPieces final : public PieceVisitor {
 public:
  CastPieces(const Piece& shape, const Vec3<Length>& translation)
      : shape_(shape), translation_(translation) {}

  void visit(const Piece& piece) override {
    if (is_behind(shape_.origin, piece)) return;
    const Vec3<Length> offset = saturated<Length>(shape_.origin - piece.origin);
    const ShapeCastHit hit =
        piece.shape.kind == ShapeKind::half_space
            ? cast_at_half_space(piece.posed(), shape_.posed(), offset, translation_)
            : lockstone::cast_shape(piece.posed(), shape_.posed(), offset, translation_);
    if (!hit.hit || (best_.hit && hit.fraction >= best_.fraction)) return;
    best_ = {true, piece.part, hit.fraction, hit.normal,
             piece.origin + rounded<Position>(hit.point_a)};
  }

  [[nodiscard]] const PlacedShapeHit& best() const { return best_; }

 private:
  const Piece& shape_;
  const Vec3<Length>& translation_;
  PlacedShapeHit best_;
};

// Everything that the shape passes, in world axes.
OrientedBox way_of(const PlacedShape& convex, const Vec3<Length>& translation) {
  const WorldBox box = world_box(convex);
  OrientedBox way;
  for (int i = 0; i < 3; ++i) {
    const Position half_way = rounded<Position>(translation[i]) / 2;
    way.centre[i] = Position::from_raw((box.lower[i].raw + box.upper[i].raw) / 2) + half_way;
    const Position half = Position::from_raw((box.upper[i].raw - box.lower[i].raw) / 2);
    way.half_extents[i] = saturated<Length>(half + abs(half_way) + Position::from_raw(1 << 13));
  }
  return way;
}

class NearestPiece final : public PieceVisitor {
 public:
  NearestPiece(const Vec3<Position>& point, Length reach) : point_(point), reach_(reach) {}

  void visit(const Piece& piece) override {
    const Shape dot = Shape::sphere({});
    const Mat3 identity;
    const ClosestPoints found = lockstone::distance(piece.posed(), {dot, identity},
                                                    saturated<Length>(point_ - piece.origin));
    const Length distance = saturated<Length>(found.distance);
    if (distance > reach_ || (best_.found && distance >= best_.distance)) return;
    best_ = {true, piece.part, distance,
             found.overlapping ? point_ : piece.origin + rounded<Position>(found.point_a)};
  }

  [[nodiscard]] const PlacedClosest& best() const { return best_; }

 private:
  const Vec3<Position>& point_;
  Length reach_;
  PlacedClosest best_;
};

}  // namespace

PlacedShapeHit cast_shape(const PlacedShape& placed, const PlacedShape& convex,
                          const Vec3<Length>& translation) {
  const Piece shape = single_piece(convex);
  CastPieces pieces(shape, translation);
  visit_pieces(brought_near(placed, convex.origin), way_of(convex, translation), {}, pieces);
  return pieces.best();
}

PlacedClosest closest_point(const PlacedShape& placed, const Vec3<Position>& point, Length reach) {
  NearestPiece nearest(point, reach);
  visit_pieces(brought_near(placed, point), {point, Mat3{}, {}}, reach, nearest);
  return nearest.best();
}

PlacedRayHit cast_ray(const PlacedShape& placed, const Vec3<Position>& origin,
                      const Vec3<Length>& translation, Unit limit) {
  RayPieces pieces(placed, origin, translation, limit);
  if (is_single(placed)) {
    pieces.visit(single_piece(brought_near(placed, origin)));
    return pieces.best();
  }
  const Vec3<Length> local_origin =
      saturated<Length>(rotate_inverse(placed.rotation, origin - placed.origin));
  placed.asset->visit_parts_on_ray(local_origin, rotate_inverse(placed.rotation, translation),
                                   pieces);
  return pieces.best();
}

}  // namespace lockstone
