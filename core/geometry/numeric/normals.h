// Directions that degenerate cases fall back on.
#pragma once

#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// A core distance below this (half the input's resolution) has no meaningful direction: 2^-21 m.
inline constexpr Fine k_no_distance = Fine{1} << (k_fine_bits - 21);

/// Whether every component of `v` is below k_no_distance.
[[nodiscard]] constexpr bool is_negligible(const RawVec& v) {
  return magnitude_of(v.x) < k_no_distance && magnitude_of(v.y) < k_no_distance &&
         magnitude_of(v.z) < k_no_distance;
}

/// The normal of two concentric spheres: up.
inline constexpr Vec3<Unit> k_concentric_normal{{}, Unit::from_integer(1), {}};

/// A unit vector square to `axis`: its cross product with the world axis it is least aligned with,
/// the first of equals.
[[nodiscard]] Vec3<Unit> perpendicular_to(const Vec3<Unit>& axis);

/// `axis`, brought to norm 1 within 2^-30 when the rotation it came from was less exact.
[[nodiscard]] Vec3<Unit> unit_axis(const Vec3<Unit>& axis);

}  // namespace lockstone::geometry
