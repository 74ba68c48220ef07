// The table of shapes: one row for each kind that is complete in itself, solid and bounded. A new
// kind is a new row; no other code of the core asks for it by name.
//
// The functions take the shape, in its own axes. A row links the functions that it names: see
// `shape_table.h`.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/numeric/q50.h"
#include "core/math/block_float.h"

namespace lockstone {

struct Manifold;
struct PosedShape;
struct ShapeRayHit;

namespace geometry {

struct ContactFeature;
struct ConvexCore;
struct PlaneMeeting;

/// Three lengths of a shape.
using Sizes = Vec3<Length>;

/// The sizes, the fourth too, as fractions of the scale, 30 bits each.
using ScaledSizes = std::array<std::uint64_t, 4>;

/// The same kind of shape with other sizes.
[[nodiscard]] constexpr Shape resized(const Shape& shape, const Sizes& size) {
  return {shape.kind, size, shape.asset};
}

[[nodiscard]] constexpr Sizes scaled_sizes(const Sizes& size, Unit share) {
  return {rounded<Length>(size.x * share), rounded<Length>(size.y * share),
          rounded<Length>(size.z * share)};
}

/// A row of the table. Functions are null only where it is said.
struct ShapeTraits {
  /// Of the sizes that the kind uses, the first of the four.
  std::array<std::string_view, 4> size_names;
  int size_count = 0;
  /// The radius that makes the core round; null of kinds without one.
  Length (*core_radius)(const Shape& shape) = nullptr;

  // Sizes and mass: see shape_properties.h.
  Length (*bounding_radius)(const Shape& shape);
  Length (*inner_radius)(const Shape& shape);
  Sizes (*half_extents)(const Shape& shape, const Mat3& rotation);
  Mass (*mass)(const Shape& shape, Density density);
  BlockFloat (*volume)(const Shape& shape);
  Vec3<Unit> (*inertia)(const ScaledSizes& size);

  /// The greatest n · p over the points p of the shape.
  Fine (*reach)(const Shape& shape, const Vec3<Unit>& n);
  /// Whether the shape, grown by `slack`, holds the point.
  bool (*holds)(const Shape& shape, const Vec3<Length>& point, Length slack);
  /// The outward normal of the face that looks most along the axis; the axis where any does.
  Vec3<Unit> (*face_along)(const Shape& shape, const Vec3<Unit>& axis);

  /// Which vertex of the core a point of it is at, within 61 µm.
  std::optional<std::uint32_t> (*vertex_at)(const Shape& shape, const RawVec& point);
  /// The vertices of the core that contacts name by number, at most 8; returns their number.
  int (*vertices)(const Shape& shape, std::array<RawVec, 8>& out);

  /// The shape with its surface deeper by about `depth`, less than the inner radius.
  Shape (*shrunk)(const Shape& shape, Length depth);
  /// The shape shortened about its middle; a round shape keeps its radius.
  Shape (*shortened)(const Shape& shape, Unit share);

  /// Fills the core that GJK sees; it is empty before.
  void (*make_core)(const PosedShape& shape, ConvexCore& core);
  /// See `collide_half_space`.
  Manifold (*below_plane)(const PlaneMeeting& plane);
  /// See `lockstone::cast_ray`; null of spheres, capsules and boxes, so that programs without
  /// queries do not link theirs.
  ShapeRayHit (*cast_ray)(const Shape& shape, const Mat3& rotation, const Vec3<Length>& origin,
                          const Vec3<Length>& translation) = nullptr;

  /// See `lockstone::collide`; null of spheres, capsules and boxes, which have a function a pair.
  Manifold (*collide)(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                      Length margin) = nullptr;
  /// See `geometry::find_feature`; null of the same three.
  void (*find_feature)(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) = nullptr;
  /// The capsule that has the same side; null of shapes without one.
  Shape (*with_round_ends)(const Shape& shape) = nullptr;
};

/// The row of a kind, null of assets, half-spaces, and unknown kinds.
[[nodiscard]] const ShapeTraits* find_traits(ShapeKind kind);

/// The row of a primitive.
[[nodiscard]] inline const ShapeTraits& traits_of(const Shape& shape) {
  const ShapeTraits* traits = find_traits(shape.kind);
  LKS_ASSERT(traits != nullptr);
  return *traits;
}

/// A point this near to a vertex of a core is at it: 61 µm.
inline constexpr Fine k_at_vertex = Fine{1} << (k_fine_bits - 14);

[[nodiscard]] constexpr bool is_at(Fine x, Fine y) {
  return magnitude_of(x - y) <= k_at_vertex;
}

}  // namespace geometry
}  // namespace lockstone
