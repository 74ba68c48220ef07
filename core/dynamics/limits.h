// Ranges that commands, world definitions and snapshots are all held to.
#pragma once

#include <lockstone/asset.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/asset_frame.h"

namespace lockstone {

/// 2^10 m holds every asset: the scale of bodies that never move.
inline constexpr int k_largest_scale_exponent = 10;

inline constexpr Number k_gravity_scale_limit = Number::from_integer(100);

/// At most 1000 m/s² an axis: far above any game, and g·dt stays a small part of the speed limit.
[[nodiscard]] constexpr bool is_valid_gravity(const Vec3<Acceleration>& g) {
  constexpr Acceleration limit = Acceleration::from_integer(1000);
  return abs(g.x) <= limit && abs(g.y) <= limit && abs(g.z) <= limit;
}

[[nodiscard]] constexpr bool is_valid_surface(Coefficient friction, Coefficient restitution) {
  return geometry::is_valid(Surface{friction, restitution});
}

}  // namespace lockstone
