#include "core/collision/query/cast_placed.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/distance/motion/shape_cast.h"
#include "core/geometry/distance/separation.h"
#include "core/math/int128.h"

namespace lockstone {
namespace {

// Boxes grow by this much, for the rounding of the frames of shape, path and asset. 8 µm
constexpr Length k_frame_margin = Length::from_raw(8);

class RayPieces final : public geometry::WayPartVisitor {
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
  LKS_ASSERT(gap >= 0 && way > 0);
  const std::uint64_t quotient = divide(numerator, static_cast<std::uint64_t>(way)).quotient;
  hit.fraction.raw = static_cast<std::int32_t>(std::min(quotient, std::uint64_t{1} << 30));
  return hit;
}

// Normal of the side of a box that the offset is farthest beyond, or of a triangle's front; zero of
// other pieces.
Vec3<Unit> side_towards(const Piece& piece, const Vec3<Length>& offset) {
  if (piece.triangle.is_triangle)
    return rotate(piece.rotation, piece.polytope->faces.front().normal);
  if (piece.shape.kind != ShapeKind::box) return {};
  const Vec3<Length> local = rotate_inverse(piece.rotation, offset);
  int best = 0;
  for (int i = 1; i < 3; ++i)
    if (abs(local[i]) - piece.shape.size[i] > abs(local[best]) - piece.shape.size[best]) best = i;
  const Vec3<Unit> side = piece.rotation.column(best);
  LKS_ASSERT(geometry::is_unit(side));
  return local[best] < Length{} ? -side : side;
}

// Whether a side of the piece keeps the shape off on its whole way, by so much that a cast would
// find nothing: it is nowhere within reach of rounding, and takes less than 64 of its steps, each
// at least the distance less rounding over the way's length.
bool is_kept_off(const Piece& piece, const Piece& shape, const Vec3<Length>& offset,
                 const Vec3<Length>& way) {
  constexpr Length k_least_gap = Length::from_ratio(1, 2000);
  const Vec3<Unit> side = side_towards(piece, offset);
  if (side == Vec3<Unit>{}) return false;
  const Length closing = max(-rounded<Length>(dot(side, way)), Length{});
  const Length gap = max(k_least_gap, (abs(way.x) + abs(way.y) + abs(way.z)) / 64);
  LKS_ASSERT(closing >= Length{} && gap > Length{});
  return separated_along(piece.posed(), shape.posed(), offset, closing + gap, side);
}

class CastPieces final : public geometry::WayPartVisitor {
 public:
  CastPieces(const PlacedShape& placed, const PlacedShape& convex, const Vec3<Length>& translation,
             Unit limit)
      : placed_(placed),
        shape_(single_piece(convex)),
        middle_(middle_of(shape_)),
        translation_(translation),
        limit_(limit) {}

  Unit visit(const geometry::Part& part) override {
    visit(piece_of(placed_, part));
    return limit_;
  }

  void visit(const Piece& piece) {
    if (is_behind(middle_, piece)) return;
    const Vec3<Length> offset = saturated<Length>(shape_.origin - piece.origin);
    if (is_kept_off(piece, shape_, offset, translation_)) return;
    const ShapeCastHit hit =
        piece.shape.kind == ShapeKind::half_space
            ? cast_at_half_space(piece.posed(), shape_.posed(), offset, translation_)
            : lockstone::cast_shape(piece.posed(), shape_.posed(), offset, translation_, limit_);
    if (!hit.hit || hit.fraction > limit_) return;
    if (best_.hit && hit.fraction == best_.fraction && piece.part > best_.part) return;
    LKS_ASSERT(hit.fraction.raw >= 0 && (hit.overlapping || geometry::is_unit(hit.normal)));
    best_ = {true, piece.part, hit.fraction, hit.normal,
             piece.origin + rounded<Position>(hit.point_a)};
    limit_ = hit.fraction;
  }

  [[nodiscard]] const PlacedShapeHit& best() const { return best_; }

 private:
  const PlacedShape& placed_;
  Piece shape_;
  Vec3<Position> middle_;
  const Vec3<Length>& translation_;
  Unit limit_;
  PlacedShapeHit best_;
};

class NearestPiece final : public geometry::NearPartVisitor {
 public:
  NearestPiece(const PlacedShape& placed, const Vec3<Position>& point, Length reach)
      : placed_(placed), point_(point), reach_(reach) {}

  Length visit(const geometry::Part& part) override {
    visit(piece_of(placed_, part));
    return reach_ + k_frame_margin;
  }

  void visit(const Piece& piece) {
    const Shape dot = Shape::sphere({});
    const Mat3 identity;
    const ClosestPoints found = lockstone::distance(piece.posed(), {dot, identity},
                                                    saturated<Length>(point_ - piece.origin));
    const Length distance = saturated<Length>(found.distance);
    if (distance > reach_) return;
    if (best_.found && distance == best_.distance && piece.part > best_.part) return;
    LKS_ASSERT(distance >= Length{});
    best_ = {true, piece.part, distance,
             found.overlapping ? point_ : piece.origin + rounded<Position>(found.point_a)};
    reach_ = distance;
  }

  [[nodiscard]] const PlacedClosest& best() const { return best_; }

 private:
  const PlacedShape& placed_;
  const Vec3<Position>& point_;
  Length reach_;
  PlacedClosest best_;
};

// In the frame of a placed asset.
Vec3<Length> local_point(const PlacedShape& placed, const Vec3<Position>& point) {
  return saturated<Length>(rotate_inverse(placed.rotation, point - placed.origin));
}

// A box about the shape in the frame of a placed asset: its middle and its half extents.
struct LocalBox {
  Vec3<Length> middle{};
  Vec3<Length> reach{};
};

LocalBox local_box(const PlacedShape& placed, const PlacedShape& shape) {
  const geometry::LocalBounds bounds = local_region(placed, oriented_box(shape), k_frame_margin);
  LKS_ASSERT(placed.asset != nullptr);
  LocalBox box;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t low = bounds.lower[i].raw, high = bounds.upper[i].raw;
    box.middle[i].raw = static_cast<std::int32_t>((low + high) >> 1);
    box.reach[i].raw = raw::saturate<std::int32_t>(((high - low) >> 1) + 1);
  }
  return box;
}

}  // namespace

PlacedShapeHit cast_shape(const PlacedShape& placed, const PlacedShape& convex,
                          const Vec3<Length>& translation, Unit limit) {
  CastPieces pieces(placed, convex, translation, limit);
  LKS_ASSERT(is_single(convex) && limit >= Unit{});
  if (is_single(placed)) {
    pieces.visit(single_piece(brought_near(placed, convex.origin)));
    return pieces.best();
  }
  const LocalBox box = local_box(placed, convex);
  placed.asset->visit_parts_on_way(box.middle, rotate_inverse(placed.rotation, translation),
                                   box.reach, pieces);
  return pieces.best();
}

PlacedClosest closest_point(const PlacedShape& placed, const Vec3<Position>& point, Length reach) {
  LKS_ASSERT(reach >= Length{});
  NearestPiece nearest(placed, point, reach);
  if (is_single(placed)) {
    nearest.visit(single_piece(brought_near(placed, point)));
    return nearest.best();
  }
  placed.asset->visit_parts_near(local_point(placed, point), reach + k_frame_margin, nearest);
  return nearest.best();
}

PlacedRayHit cast_ray(const PlacedShape& placed, const Vec3<Position>& origin,
                      const Vec3<Length>& translation, Unit limit) {
  RayPieces pieces(placed, origin, translation, limit);
  LKS_ASSERT(limit >= Unit{});
  if (is_single(placed)) {
    pieces.visit(single_piece(brought_near(placed, origin)));
    return pieces.best();
  }
  placed.asset->visit_parts_on_way(local_point(placed, origin),
                                   rotate_inverse(placed.rotation, translation), {}, pieces);
  return pieces.best();
}

}  // namespace lockstone
