#include "core/collision/narrow_phase/pieces.h"

#include <lockstone/assert.h>

#include "core/geometry/convex/shape_properties.h"

namespace lockstone {
namespace {

OrientedBox box_of(const geometry::LocalBounds& bounds, const Vec3<Position>& origin,
                   const Mat3& rotation) {
  OrientedBox box{{}, rotation, {}};
  Vec3<Position> middle;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t low = bounds.lower[i].raw, high = bounds.upper[i].raw;
    LKS_ASSERT(low <= high);
    middle[i] = Position::from_raw((low + high) << 11);
    box.half_extents[i].raw = raw::saturate<std::int32_t>((high - low + 1) >> 1);
  }
  box.centre = origin + rotate(rotation, middle);
  return box;
}

// A half-space is tested by its plane: its box is not read.
Vec3<Length> primitive_extents(const Shape& shape) {
  if (!is_primitive(shape.kind)) return {};
  return world_half_extents(shape, Mat3{});
}

// Places parts of an asset in the world.
class Placer final : public geometry::PartVisitor {
 public:
  Placer(const PlacedShape& placed, PieceVisitor& visitor) : placed_(placed), visitor_(visitor) {}

  void visit(const geometry::Part& part) override { visitor_.visit(piece_of(placed_, part)); }

 private:
  const PlacedShape& placed_;
  PieceVisitor& visitor_;
};

}  // namespace

// Rounding of the frames between box and asset, at most 2^-28 of a size: 8 µm.
constexpr Length k_frame_error = Length::from_raw(8);

// The region in the asset's frame, rounded outward.
geometry::LocalBounds local_region(const PlacedShape& placed, const OrientedBox& region,
                                   Length margin) {
  const Mat3 to_asset = transposed(placed.rotation);
  const Vec3<Length> centre =
      saturated<Length>(rotate_inverse(placed.rotation, region.centre - placed.origin));
  const Shape box{ShapeKind::box, region.half_extents, {}};
  const Vec3<Length> half = world_half_extents(box, multiply(to_asset, region.rotation));
  geometry::LocalBounds bounds;
  for (int i = 0; i < 3; ++i) {
    const std::int64_t reach = std::int64_t{half[i].raw} + margin.raw + k_frame_error.raw;
    LKS_ASSERT(reach > 0);
    bounds.lower[i].raw = raw::saturate<std::int32_t>(centre[i].raw - reach);
    bounds.upper[i].raw = raw::saturate<std::int32_t>(centre[i].raw + reach);
  }
  return bounds;
}

Piece piece_of(const PlacedShape& placed, const geometry::Part& part) {
  const bool moved = part.position != Vec3<Length>{};
  const bool turned = part.rotation != Mat3{};
  return {part.shape,
          part.polytope,
          moved ? placed.origin + rotate(placed.rotation, rounded<Position>(part.position))
                : placed.origin,
          turned ? multiply(placed.rotation, part.rotation) : placed.rotation,
          part.index,
          part.surface,
          part.triangle};
}

Piece single_piece(const PlacedShape& placed) {
  LKS_ASSERT(is_single(placed));
  const geometry::Polytope* polytope = placed.asset == nullptr ? nullptr : placed.asset->polytope();
  return {placed.shape, polytope, placed.origin, placed.rotation, 0, nullptr, {}};
}

Vec3<Position> middle_of(const Piece& piece) {
  if (piece.polytope == nullptr) return piece.origin;
  return piece.origin + rounded<Position>(rotate(piece.rotation, piece.polytope->interior));
}

geometry::Fine height_above_front(const Vec3<Position>& point, const Piece& triangle) {
  LKS_ASSERT(triangle.triangle.is_triangle);
  const geometry::PolytopeFace& front = triangle.polytope->faces.front();
  const Vec3<Length> local =
      rotate_inverse(triangle.rotation, saturated<Length>(point - triangle.origin));
  return dot(front.normal, local).raw - front.offset;
}

bool is_behind(const Vec3<Position>& point, const Piece& piece) {
  return piece.triangle.is_triangle && height_above_front(point, piece) < 0;
}

PlacedShape brought_near(const PlacedShape& placed, const Vec3<Position>& point) {
  if (placed.shape.kind != ShapeKind::half_space) return placed;
  PlacedShape near = placed;
  Vec3<Position> local = rotate_inverse(placed.rotation, point - placed.origin);
  local.y = {};
  near.origin = placed.origin + rotate(placed.rotation, local);
  near.centre = near.origin;
  return near;
}

OrientedBox oriented_box(const Piece& piece) {
  if (piece.polytope == nullptr) {
    return {piece.origin, piece.rotation, primitive_extents(piece.shape)};
  }
  return box_of(geometry::bounds_of(*piece.polytope), piece.origin, piece.rotation);
}

OrientedBox oriented_box(const PlacedShape& placed) {
  if (placed.asset == nullptr) {
    return {placed.origin, placed.rotation, primitive_extents(placed.shape)};
  }
  return box_of(placed.asset->bounds(), placed.origin, placed.rotation);
}

void visit_pieces(const PlacedShape& placed, const OrientedBox& region, Length margin,
                  PieceVisitor& visitor) {
  if (is_single(placed)) return visitor.visit(single_piece(placed));
  LKS_ASSERT(placed.asset != nullptr && margin >= Length{});
  Placer placer(placed, visitor);
  placed.asset->visit_parts(local_region(placed, region, margin), placer);
}

}  // namespace lockstone
