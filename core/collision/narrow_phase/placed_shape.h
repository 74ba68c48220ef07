// A body's shape at its pose, for pairs, bounds and queries.
#pragma once

#include <lockstone/asset.h>
#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/convex/asset_geometry.h"

namespace lockstone {

/// The shape's frame in the world, and the centre of mass that contact anchors are relative to.
struct PlacedShape {
  Shape shape{};
  /// Null for shapes that are complete in themselves.
  const geometry::AssetGeometry* asset = nullptr;
  Vec3<Position> origin{};  ///< of the shape's frame
  Mat3 rotation{};          ///< of the shape's frame
  Vec3<Position> centre{};  ///< of mass; of a shape without mass its origin
};

/// The part of an asset's frame that follows from its body's rotation alone.
struct ShapeFrame {
  Mat3 rotation{};
  Vec3<Position> centre{};  ///< of mass, as seen from the frame's origin, in world axes
};
[[nodiscard]] ShapeFrame shape_frame(const geometry::AssetGeometry* asset, const Mat3& rotation);

/// Places a shape on a body whose centre of mass is at `centre` and whose principal axes are the
/// columns of `rotation`. Within 2^-32 m and 2^-29 of the exact pose.
[[nodiscard]] PlacedShape place(const Shape& shape, const geometry::AssetGeometry* asset,
                                const Vec3<Position>& centre, const Mat3& rotation);
[[nodiscard]] PlacedShape place(const Shape& shape, const geometry::AssetGeometry* asset,
                                const Vec3<Position>& centre, const ShapeFrame& frame);

/// Between the pose of a shape's frame and that of its body: centre of mass and principal axes. The
/// two are the same but for assets with mass. Orientations are normalised.
[[nodiscard]] Transform body_pose(const geometry::AssetGeometry* asset,
                                  const Transform& shape_pose);
[[nodiscard]] Transform shape_pose(const geometry::AssetGeometry* asset,
                                   const Transform& body_pose);

/// World-axis bounds, rounded outward; a half-space's reach to the limits of the type.
struct WorldBox {
  Vec3<Position> lower{};
  Vec3<Position> upper{};
};
[[nodiscard]] WorldBox world_box(const PlacedShape& placed);

/// The same of a box in the shape's frame.
[[nodiscard]] WorldBox world_box(const PlacedShape& placed, const geometry::LocalBounds& box);

/// Radius about the centre of mass of a sphere that holds the shape (0 for shapes without mass
/// distribution), and of one that the shape holds.
[[nodiscard]] Length bounding_radius(const Shape& shape, const geometry::AssetGeometry* asset);
[[nodiscard]] Length inner_radius(const Shape& shape, const geometry::AssetGeometry* asset);

}  // namespace lockstone
