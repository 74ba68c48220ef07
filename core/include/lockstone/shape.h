// Shapes: plain values. Sphere, capsule, box, cylinder, cone, tapered capsule, rounded box and
// half-space are complete in themselves; the others name an asset.
#pragma once

#include <cstdint>
#include <string_view>

#include <lockstone/status.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

enum class ShapeKind : std::uint8_t {
  sphere = 0,
  capsule = 1,
  box = 2,
  hull = 3,          ///< convex polyhedron (asset)
  half_space = 4,    ///< everything below a plane; never on a dynamic body
  mesh = 5,          ///< triangles (asset); never on a dynamic body
  height_field = 6,  ///< a terrain (asset); never on a dynamic body
  compound = 7,      ///< several shapes (asset); never on a moving body where one is a mesh
  cylinder = 8,
  cone = 9,
  tapered_capsule = 10,
  rounded_box = 11,
  path = 255,  ///< a curve for joints (asset); no body has it
};
inline constexpr ShapeKind k_last_shape_kind = ShapeKind::rounded_box;
[[nodiscard]] std::string_view to_string(ShapeKind kind);

/// Whether shapes of this kind name an asset.
[[nodiscard]] constexpr bool is_asset(ShapeKind kind) {
  return kind == ShapeKind::hull || (kind > ShapeKind::half_space && kind <= ShapeKind::compound);
}

/// Whether shapes of this kind have four sizes: the asset's place holds the fourth.
[[nodiscard]] constexpr bool has_fourth_size(ShapeKind kind) {
  return kind == ShapeKind::rounded_box;
}

/// Whether shapes of this kind are complete in themselves, solid and bounded.
[[nodiscard]] constexpr bool is_primitive(ShapeKind kind) {
  return kind <= ShapeKind::box || kind > ShapeKind::compound;
}

/// Names an asset by its content: the hash of its canonical bytes. 0: no asset.
struct AssetId {
  std::uint64_t value = 0;  ///< 64 bits of XXH3; 0: none

  friend constexpr auto operator<=>(AssetId, AssetId) = default;
  [[nodiscard]] constexpr bool is_null() const { return value == 0; }
};

/// Bounds on every shape dimension (radius, half height, half extent).
inline constexpr Length k_min_shape_size = Length::from_raw(1 << 10);  // 0.98 mm
inline constexpr Length k_max_shape_size = Length::from_integer(512);
/// Half extents of a thin box: one whose largest half extent is at least k_min_shape_size.
inline constexpr Length k_min_box_extent = Length::from_raw(105);  // 0.1 mm

/// The shape of a body. `size` means, by kind:
///   sphere:  x = radius
///   capsule: x = radius, y = half the length of the core segment, which lies on the body's y axis
///   box:     half extents along the body's axes
///   cylinder: x = radius, y = half the height, along the body's y axis
///   cone:    x = radius of the base, y = height, along the body's y axis: the apex is up
///   tapered capsule: the hull of two balls on the body's y axis: x = radius of the lower one,
///            y = distance of their centres, z = radius of the upper one. Where one ball holds
///            the other, the shape is that ball
///   rounded box: all points within a radius of a box: half extents of that box, which is the flat
///            part of the faces; `asset` holds the radius. Radius and half extent are together at
///            most k_max_shape_size along each axis
///   others:  zero; a half-space lies below the plane y = 0 of its body
/// All but assets have their centre of mass at the body's origin (a cone's base is a quarter of its
/// height below it, a tapered capsule's larger ball is the nearer one); an asset keeps its own
/// frame.
struct Shape {
  ShapeKind kind = ShapeKind::sphere;  ///< says how to read the others
  Vec3<Length> size{};                 ///< m, within the bounds above
  /// Of a hull, mesh, height field, compound. Of a rounded box, which names none, the fourth size:
  /// see `fourth_size`.
  AssetId asset{};

  friend constexpr bool operator==(const Shape&, const Shape&) = default;

  [[nodiscard]] static constexpr Shape sphere(Length radius) {
    return {ShapeKind::sphere, {radius, {}, {}}, {}};
  }
  [[nodiscard]] static constexpr Shape capsule(Length half_height, Length radius) {
    return {ShapeKind::capsule, {radius, half_height, {}}, {}};
  }
  [[nodiscard]] static constexpr Shape box(Length half_x, Length half_y, Length half_z) {
    return {ShapeKind::box, {half_x, half_y, half_z}, {}};
  }

  // A program links the code of these kinds when it names the function; one that does not refuses
  // them, in commands and snapshots too.
  [[nodiscard]] static Shape cylinder(Length half_height, Length radius);
  [[nodiscard]] static Shape cone(Length height, Length radius);
  /// `height` is the distance of the balls' centres.
  [[nodiscard]] static Shape tapered_capsule(Length height, Length bottom_radius,
                                             Length top_radius);

  /// A box of these half extents, and all points within `radius` of it: its faces reach half extent
  /// plus radius from the centre.
  [[nodiscard]] static Shape rounded_box(Length half_x, Length half_y, Length half_z,
                                         Length radius);

  /// The radius of a rounded box; 0 of every other kind, and where `asset` holds no length.
  [[nodiscard]] constexpr Length fourth_size() const {
    const bool has_length = has_fourth_size(kind) && asset.value < std::uint64_t{1} << 31;
    return Length::from_raw(has_length ? static_cast<std::int32_t>(asset.value) : 0);
  }
  /// The asset that the shape names; none of a kind with four sizes.
  [[nodiscard]] constexpr AssetId asset_id() const {
    return has_fourth_size(kind) ? AssetId{} : asset;
  }

  [[nodiscard]] static constexpr Shape half_space() { return {ShapeKind::half_space, {}, {}}; }
};

/// Links every kind: for programs that load shapes that others made. Returns true.
bool link_all_shapes();

/// The least dimension that such a shape may have: k_min_shape_size, or k_min_box_extent.
[[nodiscard]] constexpr Length least_size(const Shape& shape) {
  const Vec3<Length>& size = shape.size;
  const bool is_wide =
      size.x >= k_min_shape_size || size.y >= k_min_shape_size || size.z >= k_min_shape_size;
  return shape.kind == ShapeKind::box && is_wide ? k_min_box_extent : k_min_shape_size;
}

/// ok, or invalid_argument when a dimension lies outside [least_size(shape), k_max_shape_size], a
/// rounded box reaches farther than k_max_shape_size along an axis, or
/// an asset is named where none belongs or missing where one does, or the program does not link the
/// kind.
[[nodiscard]] Status validate(const Shape& shape);

}  // namespace lockstone
