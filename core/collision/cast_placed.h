// Queries on one placed shape, over all its parts.
#pragma once

#include <cstdint>

#include "core/collision/pieces.h"
#include "core/geometry/raycast.h"

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

}  // namespace lockstone
