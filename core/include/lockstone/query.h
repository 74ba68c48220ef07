// Questions to a world: read-only, safe from several threads at once, answers in canonical order.
#pragma once

#include <cstdint>

#include <lockstone/body.h>
#include <lockstone/shape.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Rays and casts reach at most this far along each axis.
inline constexpr Length k_max_cast = Length::from_integer(512);

/// Which bodies a query sees: those whose category is in `mask`, except `ignore`, for which
/// `accept` (when given) returns true.
struct QueryFilter {
  std::uint32_t mask = 0xffffffff;
  BodyHandle ignore{};
  bool triggers = false;  ///< whether triggers are seen too

  /// Asked in no promised order, of some bodies not at all. Its result must depend on the body
  /// alone.
  bool (*accept)(void* context, BodyHandle body) = nullptr;
  void* context = nullptr;  ///< handed to `accept`
};

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
  std::uint32_t part = 0;  ///< of its asset: triangle, cell or child
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
