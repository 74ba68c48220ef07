// Axis-aligned bounds for the broad phase.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// One coordinate of a bounding box: ±2^21 m, resolution 1 mm. Always rounded outward.
using BoundsCoordinate = Fixed<Metre, std::int32_t, 10>;

/// A closed box. Touching boxes overlap.
struct Bounds {
  Vec3<BoundsCoordinate> lower{};
  Vec3<BoundsCoordinate> upper{};

  friend constexpr bool operator==(const Bounds&, const Bounds&) = default;
};

[[nodiscard]] constexpr BoundsCoordinate round_down(Position x) {
  return BoundsCoordinate::from_raw(raw::saturate<std::int32_t>(x.raw >> 22));
}

[[nodiscard]] constexpr BoundsCoordinate round_up(Position x) {
  return BoundsCoordinate::from_raw(raw::saturate<std::int32_t>(-((-x.raw) >> 22)));
}

// Without a branch: which comparison fails cannot be foretold.
[[nodiscard]] constexpr bool overlap(const Bounds& a, const Bounds& b) {
  int all = 1;
  for (int i = 0; i < 3; ++i) {
    all &= static_cast<int>(a.lower[i] <= b.upper[i]) & static_cast<int>(b.lower[i] <= a.upper[i]);
  }
  return all != 0;
}

[[nodiscard]] constexpr bool contains(const Bounds& outer, const Bounds& inner) {
  return outer.lower.x <= inner.lower.x && outer.lower.y <= inner.lower.y &&
         outer.lower.z <= inner.lower.z && inner.upper.x <= outer.upper.x &&
         inner.upper.y <= outer.upper.y && inner.upper.z <= outer.upper.z;
}

[[nodiscard]] constexpr Bounds united(const Bounds& a, const Bounds& b) {
  return {{min(a.lower.x, b.lower.x), min(a.lower.y, b.lower.y), min(a.lower.z, b.lower.z)},
          {max(a.upper.x, b.upper.x), max(a.upper.y, b.upper.y), max(a.upper.z, b.upper.z)}};
}

/// The bounds of a ball on a straight path.
[[nodiscard]] constexpr Bounds bounds_of_way(const Vec3<Position>& from, const Vec3<Position>& to,
                                             Length radius) {
  const Position reach = rounded<Position>(radius);
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    bounds.lower[i] = round_down(min(from[i], to[i]) - reach);
    bounds.upper[i] = round_up(max(from[i], to[i]) + reach);
  }
  return bounds;
}

/// Grown by `margin` on every side, saturating.
[[nodiscard]] constexpr Bounds inflated(const Bounds& b, BoundsCoordinate margin) {
  const auto shift = [](BoundsCoordinate x, std::int64_t by) {
    return BoundsCoordinate::from_raw(raw::saturate<std::int32_t>(std::int64_t{x.raw} + by));
  };
  const std::int64_t m = margin.raw;
  return {{shift(b.lower.x, -m), shift(b.lower.y, -m), shift(b.lower.z, -m)},
          {shift(b.upper.x, m), shift(b.upper.y, m), shift(b.upper.z, m)}};
}

/// Half the surface area in units of 2^-12 m², a cost for tree building. Each side is at most 2^28
/// units, so that three products fit.
[[nodiscard]] constexpr std::int64_t surface_cost(const Bounds& b) {
  const auto side = [](BoundsCoordinate low, BoundsCoordinate high) {
    return ((std::int64_t{high.raw} - low.raw) >> 4) + 1;  // flat boxes have a cost too
  };
  const std::int64_t x = side(b.lower.x, b.upper.x);
  const std::int64_t y = side(b.lower.y, b.upper.y);
  const std::int64_t z = side(b.lower.z, b.upper.z);
  return x * y + y * z + z * x;
}

}  // namespace lockstone
