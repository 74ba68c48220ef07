// Queries on one placed shape, over all its parts.
#pragma once

#include <cstdint>

#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/dispatch/raycast.h"

namespace lockstone {

struct PlacedRayHit {
  bool hit = false;
  std::uint32_t part = 0;
  Unit fraction{};
  Vec3<Unit> normal{};
};

/// The first part along the ray, the lowest of equals. Nothing beyond `limit` is looked for.
[[nodiscard]] PlacedRayHit cast_ray(const PlacedShape& placed, const Vec3<Position>& origin,
                                    const Vec3<Length>& translation, Unit limit);

struct PlacedShapeHit {
  bool hit = false;
  std::uint32_t part = 0;
  Unit fraction{};
  Vec3<Unit> normal{};  ///< from the placed shape to the one cast
  Vec3<Position> point{};
};

/// The first part of `placed` that a convex shape meets on its way by `translation` up to `limit`,
/// the lowest of equals; triangles from the front only.
[[nodiscard]] PlacedShapeHit cast_shape(const PlacedShape& placed, const PlacedShape& convex,
                                        const Vec3<Length>& translation, Unit limit);

struct PlacedClosest {
  bool found = false;
  std::uint32_t part = 0;
  Length distance{};
  Vec3<Position> point{};
};

/// The nearest point within `reach`, of the lowest part of equals.
[[nodiscard]] PlacedClosest closest_point(const PlacedShape& placed, const Vec3<Position>& point,
                                          Length reach);

}  // namespace lockstone
