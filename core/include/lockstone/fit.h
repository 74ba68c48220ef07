// Primitives about points: the collision shape of a model, computed alike on every machine. A hull
// of points is Hull::build.
#pragma once

#include <span>

#include <lockstone/shape.h>
#include <lockstone/status.h>
#include <lockstone/transform.h>

namespace lockstone {

/// At most this many points are fitted.
inline constexpr std::size_t k_max_fit_points = 65536;

/// A shape, and its frame in that of the points.
struct FittedShape {
  Shape shape{};
  Vec3<Length> position{};
  Quat orientation{};  ///< a unit
};

/// All points lie inside, or outside by at most 8 µm. Sizes below k_min_shape_size are raised to
/// it. invalid_argument: no points, more than k_max_fit_points, a coordinate beyond
/// k_max_asset_coordinate, or a size above k_max_shape_size.

/// A sphere; its radius is at most 2 % above that of the least one.
[[nodiscard]] Result<FittedShape> fit_sphere(std::span<const Vec3<Length>> points);

/// A box along the principal axes of the points, or along the axes of their frame where that has
/// less volume.
[[nodiscard]] Result<FittedShape> fit_box(std::span<const Vec3<Length>> points);

/// A capsule along the longest axis of the fitted box.
[[nodiscard]] Result<FittedShape> fit_capsule(std::span<const Vec3<Length>> points);

}  // namespace lockstone
