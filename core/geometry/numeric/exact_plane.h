// Planes through points of the lattice of lengths, with exact sides.
#pragma once

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/numeric/q50.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {

/// a − b, raw; at most 2^30 within the bounds of assets.
[[nodiscard]] constexpr RawVec difference(const Vec3<Length>& a, const Vec3<Length>& b) {
  return {std::int64_t{a.x.raw} - b.x.raw, std::int64_t{a.y.raw} - b.y.raw,
          std::int64_t{a.z.raw} - b.z.raw};
}

/// Exact for components of at most 2^30; the result is at most 2^61.
[[nodiscard]] constexpr RawVec cross(const RawVec& u, const RawVec& v) {
  return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

/// The exact dot product; below 2^127 for |u| < 2^63 and |v| < 2^62.
[[nodiscard]] constexpr Int128 dot_wide(const RawVec& u, const RawVec& v) {
  return multiply_wide(u.x, v.x) + multiply_wide(u.y, v.y) + multiply_wide(u.z, v.z);
}

struct ExactPlane {
  Vec3<Length> point{};
  RawVec normal{};    ///< exact, not of norm 1
  Vec3<Unit> unit{};  ///< its direction, each component within 0.51 · 2^-30
};

/// Through a counter-clockwise triangle.
[[nodiscard]] inline ExactPlane plane_through(const Vec3<Length>& a, const Vec3<Length>& b,
                                              const Vec3<Length>& c) {
  const RawVec normal = cross(difference(b, a), difference(c, a));
  return {a, normal, direction_of(normal.x, normal.y, normal.z)};
}

/// v · n, exact: |v| below 2^32 raw.
[[nodiscard]] constexpr Fine dot_fine(const RawVec& v, const Vec3<Unit>& n) {
  return v.x * n.x.raw + v.y * n.y.raw + v.z * n.z.raw;
}

/// Distance above the plane, in error by less than 2^-30 of the distance from the plane's point.
[[nodiscard]] constexpr Fine height(const ExactPlane& plane, const Vec3<Length>& p) {
  return dot_fine(difference(p, plane.point), plane.unit);
}

/// +1 above the plane, 0 on it, −1 below: exact. The rounded normal decides wherever it can.
[[nodiscard]] constexpr int side(const ExactPlane& plane, const Vec3<Length>& p) {
  const RawVec d = difference(p, plane.point);
  const Fine estimate = dot_fine(d, plane.unit);
  const std::int64_t error = sum_of_magnitudes(d);
  if (estimate > error) return 1;
  if (estimate < -error) return -1;
  const Int128 exact = dot_wide(plane.normal, d);
  return exact.negative() ? -1 : exact == Int128{} ? 0 : 1;
}

}  // namespace lockstone::geometry
