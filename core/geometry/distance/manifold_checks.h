// For assertions: directions and manifolds as all collision functions return them.
#pragma once

#include <cstddef>
#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/distance/manifold.h"

namespace lockstone::geometry {

/// Whether the length is 1 within 2^-20; rounding alone stays far below that.
[[nodiscard]] constexpr bool is_unit(const Vec3<Unit>& n) {
  constexpr std::int64_t k_one = std::int64_t{1} << (2 * Unit::frac_bits);
  constexpr std::int64_t k_most = k_one >> 19;  // twice the error of the length
  const std::int64_t square = std::int64_t{n.x.raw} * n.x.raw + std::int64_t{n.y.raw} * n.y.raw +
                              std::int64_t{n.z.raw} * n.z.raw;
  return square > k_one - k_most && square < k_one + k_most;
}

/// Whether a manifold has at most four points, each with another feature, and a unit normal if any.
[[nodiscard]] constexpr bool is_manifold(const Manifold& manifold) {
  if (manifold.count < 0 || manifold.count > k_max_manifold_points) return false;
  for (int i = 0; i < manifold.count; ++i) {
    for (int j = 0; j < i; ++j) {
      if (manifold.points[static_cast<std::size_t>(i)].feature ==
          manifold.points[static_cast<std::size_t>(j)].feature)
        return false;
    }
  }
  return manifold.count == 0 || is_unit(manifold.normal);
}

}  // namespace lockstone::geometry
