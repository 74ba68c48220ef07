// Questions to a world: read-only, safe from several threads at once, answers in canonical order.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/body.h>
#include <lockstone/shape.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Rays and casts reach at most this far along each axis.
inline constexpr Length k_max_cast = Length::from_integer(512);

/// Which bodies a query sees: those whose category is in `mask`, except `ignore`, that pass the tag
/// and the list, and for which `accept` (when given) returns true.
struct QueryFilter {
  std::uint32_t mask = 0xffffffff;
  BodyHandle ignore{};
  bool triggers = false;  ///< whether triggers are seen too

  /// Asked in no promised order, of some bodies not at all. Its result must depend on the body
  /// alone.
  bool (*accept)(void* context, BodyHandle body) = nullptr;
  void* context = nullptr;  ///< handed to `accept`

  /// Only bodies whose own tag (BodyDef::material, not that of an asset's surface) is equal to
  /// `tag` in the bits of `tag_mask`; of any tag where that is 0.
  std::uint32_t tag_mask = 0;
  std::uint32_t tag = 0;

  /// At most k_max_filter_bodies, in any order: the bodies to leave out, or, with `only_listed`,
  /// the only ones to look at. Read while the query runs. It is searched once for each body that
  /// the query comes near: for long lists a tag or a category is faster.
  std::span<const BodyHandle> bodies{};
  bool only_listed = false;
};

/// Bodies that a QueryFilter may list.
inline constexpr std::size_t k_max_filter_bodies = 64;

struct Ray {
  Vec3<Position> origin{};
  Vec3<Length> translation{};  ///< each component within ±k_max_cast
};

/// Where a ray first meets a body.
struct RayHit {
  BodyHandle body{};       ///< null when nothing was hit
  Unit fraction{};         ///< of the ray, 0 … 1
  Vec3<Unit> normal{};     ///< outward; zero when the ray starts inside
  Vec3<Position> point{};  ///< on the ray
  std::uint32_t part = 0;  ///< of its asset: triangle, cell or child; see Compound::find_part
};

/// A convex shape (a primitive or a hull) on its way. The orientation stays.
struct ShapeCast {
  Shape shape{};
  Transform start{};
  Vec3<Length> translation{};  ///< each component within ±k_max_cast
};

/// Where a cast shape first meets a body.
struct ShapeHit {
  BodyHandle body{};       ///< null when nothing was hit
  Unit fraction{};         ///< of the translation, 0 … 1; 0 when they overlap at the start
  Vec3<Unit> normal{};     ///< from the body to the shape
  Vec3<Position> point{};  ///< where they meet
  std::uint32_t part = 0;  ///< of the body's asset
};

/// One manifold between a shape and a body.
struct ShapeContact {
  BodyHandle body{};
  Vec3<Unit> normal{};        ///< from the body to the shape
  Displacement separation{};  ///< of the deepest point; negative when overlapping
  Vec3<Position> point{};     ///< the deepest, on the body
  std::uint32_t part = 0;     ///< of the body's asset; a group of triangles is named by its key
  Surface surface{};          ///< of the body, where they meet

  friend constexpr bool operator==(const ShapeContact&, const ShapeContact&) = default;
};

/// The point of a body that is nearest to another point.
struct ClosestHit {
  BodyHandle body{};       ///< null when nothing is near enough
  Length distance{};       ///< 0 inside
  Vec3<Position> point{};  ///< on the surface; inside a body the point asked about
  std::uint32_t part = 0;
};

}  // namespace lockstone
