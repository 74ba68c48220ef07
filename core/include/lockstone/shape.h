// Shapes: plain values, centred on the body's centre of mass, axes along the body's axes.
#pragma once

#include <cstdint>

#include <lockstone/status.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

enum class ShapeKind : std::uint8_t { sphere = 0, capsule = 1, box = 2 };

/// Bounds on every shape dimension (radius, half height, half extent).
inline constexpr Length k_min_shape_size = Length::from_raw(1 << 10);  // 0.98 mm
inline constexpr Length k_max_shape_size = Length::from_integer(512);

/// A convex shape. `size` means, by kind:
///   sphere:  x = radius
///   capsule: x = radius, y = half the length of the core segment, which lies on the body's y axis
///   box:     half extents along the body's axes
struct Shape {
  ShapeKind kind = ShapeKind::sphere;
  Vec3<Length> size{};

  friend constexpr bool operator==(const Shape&, const Shape&) = default;

  [[nodiscard]] static constexpr Shape sphere(Length radius) {
    return {ShapeKind::sphere, {radius, {}, {}}};
  }
  [[nodiscard]] static constexpr Shape capsule(Length half_height, Length radius) {
    return {ShapeKind::capsule, {radius, half_height, {}}};
  }
  [[nodiscard]] static constexpr Shape box(Length half_x, Length half_y, Length half_z) {
    return {ShapeKind::box, {half_x, half_y, half_z}};
  }
};

/// ok, or invalid_argument when a dimension lies outside [k_min_shape_size, k_max_shape_size].
[[nodiscard]] Status validate(const Shape& shape);

}  // namespace lockstone
