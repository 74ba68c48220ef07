#include "core/collision/cast_placed.h"

#include "core/geometry/gjk.h"

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
             found.overlapping ? point_ : piece.origin + widened(found.point_a)};
  }

  [[nodiscard]] const PlacedClosest& best() const { return best_; }

 private:
  static Vec3<Position> widened(const Vec3<Length>& v) {
    return {rounded<Position>(v.x), rounded<Position>(v.y), rounded<Position>(v.z)};
  }

  const Vec3<Position>& point_;
  Length reach_;
  PlacedClosest best_;
};

}  // namespace

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
