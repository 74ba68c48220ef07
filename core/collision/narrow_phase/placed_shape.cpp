#include "core/collision/narrow_phase/placed_shape.h"

#include <lockstone/assert.h>

#include "core/geometry/contact/polytope/polytope_pair.h"
#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/solid.h"
#include "core/geometry/distance/gjk/gjk.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

const geometry::Solid* solid_of(const geometry::AssetGeometry* asset) {
  return asset == nullptr ? nullptr : asset->solid();
}

// Beyond any coordinate of a world, within the range of bounds.
constexpr Position k_everywhere = Position::from_integer((1 << 21) - 1);

// A half-space with an upright normal ends at its plane; a tilted one is everywhere.
WorldBox half_space_box(const PlacedShape& placed) {
  LKS_ASSERT(placed.shape.kind == ShapeKind::half_space);
  WorldBox box{{-k_everywhere, -k_everywhere, -k_everywhere},
               {k_everywhere, k_everywhere, k_everywhere}};
  if (placed.rotation.y == Mat3{}.y) box.upper.y = placed.origin.y;
  return box;
}

// The least and the greatest of the vertices along each axis, and their rounding error.
WorldBox vertex_box(const PlacedShape& placed, const geometry::Polytope& polytope) {
  constexpr int k_bits = geometry::k_fine_bits - Position::frac_bits;
  constexpr Position k_rounding = Position::from_raw(1 << 13);
  const geometry::Fine radius = geometry::fine(polytope.radius);
  WorldBox box;
  for (int i = 0; i < 3; ++i) {
    const Vec3<Unit> axis{placed.rotation.x[i], placed.rotation.y[i], placed.rotation.z[i]};
    const lanes::Extent extent = geometry::extent_along(polytope, axis);
    LKS_ASSERT(extent.least <= extent.greatest);
    const geometry::Fine below = radius - extent.least, above = radius + extent.greatest;
    box.lower[i] = placed.origin[i] - Position::from_raw(below >> k_bits) - k_rounding;
    box.upper[i] = placed.origin[i] + Position::from_raw(above >> k_bits) + k_rounding;
  }
  return box;
}

}  // namespace

ShapeFrame shape_frame(const geometry::AssetGeometry* asset, const Mat3& rotation) {
  const geometry::Solid* solid = solid_of(asset);
  if (solid == nullptr) return {rotation, {}};
  LKS_ASSERT(solid->radius > Length{});
  const bool turned = solid->axes != Quat{};
  const Mat3 frame = turned ? multiply(rotation, solid->to_axes) : rotation;
  LKS_ASSERT(max(abs(solid->centre.x), max(abs(solid->centre.y), abs(solid->centre.z))) <
             Length::from_integer(2000));
  const geometry::RawVec centre = geometry::turned(frame, solid->centre);
  using geometry::to_position;
  return {frame, {to_position(centre.x), to_position(centre.y), to_position(centre.z)}};
}

PlacedShape place(const Shape& shape, const geometry::AssetGeometry* asset,
                  const Vec3<Position>& centre, const Mat3& rotation) {
  return place(shape, asset, centre, shape_frame(asset, rotation));
}

PlacedShape place(const Shape& shape, const geometry::AssetGeometry* asset,
                  const Vec3<Position>& centre, const ShapeFrame& frame) {
  return {shape, asset, centre - frame.centre, frame.rotation, centre};
}

Transform body_pose(const geometry::AssetGeometry* asset, const Transform& shape_pose) {
  const Quat orientation = normalized(shape_pose.orientation);
  const geometry::Solid* solid = solid_of(asset);
  if (solid == nullptr) return {shape_pose.position, orientation};
  return {apply({shape_pose.position, orientation}, solid->centre),
          normalized(multiply(orientation, solid->axes))};
}

Transform shape_pose(const geometry::AssetGeometry* asset, const Transform& body_pose) {
  const geometry::Solid* solid = solid_of(asset);
  if (solid == nullptr) return body_pose;
  const Quat orientation = normalized(multiply(body_pose.orientation, conjugate(solid->axes)));
  return {apply({body_pose.position, orientation}, -solid->centre), orientation};
}

// The bounds of a turned box: the middle turned, the half extents by the magnitudes of the axes.
WorldBox world_box(const PlacedShape& placed, const geometry::LocalBounds& local) {
  const auto middle = [](Length low, Length high) {
    return Position::from_raw((std::int64_t{low.raw} + high.raw) << 11);
  };
  const Vec3<Position> centre{middle(local.lower.x, local.upper.x),
                              middle(local.lower.y, local.upper.y),
                              middle(local.lower.z, local.upper.z)};
  const Vec3<Length> half{(local.upper.x - local.lower.x + Length::from_raw(1)) / 2,
                          (local.upper.y - local.lower.y + Length::from_raw(1)) / 2,
                          (local.upper.z - local.lower.z + Length::from_raw(1)) / 2};
  const Vec3<Position> at = placed.origin + rotate(placed.rotation, centre);
  LKS_ASSERT(half.x >= Length{} && half.y >= Length{} && half.z >= Length{});
  const Vec3<Position> reach =
      rounded<Position>(world_half_extents({ShapeKind::box, half, {}}, placed.rotation));
  return {at - reach, at + reach};
}

WorldBox world_box(const PlacedShape& placed) {
  if (placed.shape.kind == ShapeKind::half_space) return half_space_box(placed);
  if (placed.asset != nullptr) {
    const geometry::Polytope* polytope = placed.asset->polytope();
    return polytope != nullptr ? vertex_box(placed, *polytope)
                               : world_box(placed, placed.asset->bounds());
  }
  const Vec3<Position> reach = rounded<Position>(world_half_extents(placed.shape, placed.rotation));
  LKS_ASSERT(reach.x >= Position{} && reach.y >= Position{} && reach.z >= Position{});
  return {placed.origin - reach, placed.origin + reach};
}

Length bounding_radius(const Shape& shape, const geometry::AssetGeometry* asset) {
  if (is_primitive(shape.kind)) return bounding_radius(shape);
  if (asset == nullptr) return {};
  if (asset->solid() != nullptr) return asset->solid()->radius;
  const geometry::LocalBounds& bounds = asset->bounds();
  const auto farthest = [&](int i) { return max(abs(bounds.lower[i]), abs(bounds.upper[i])).raw; };
  return Length::from_raw(raw::saturate<std::int32_t>(
      static_cast<std::int64_t>(norm(farthest(0), farthest(1), farthest(2))) + 1));
}

Length inner_radius(const Shape& shape, const geometry::AssetGeometry* asset) {
  if (is_primitive(shape.kind)) return inner_radius(shape);
  const geometry::Solid* solid = solid_of(asset);
  return solid == nullptr ? Length{} : solid->inner_radius;
}

}  // namespace lockstone
