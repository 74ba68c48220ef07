// Positions with orientations.
#pragma once

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// A placement: the body point p is at position + orientation · p in the world. Coordinates stay
/// within ±2^30 m, far beyond the world limit; leaving that is a programmer's error.
struct Transform {
  Vec3<Position> position;
  Quat orientation;

  friend constexpr bool operator==(const Transform&, const Transform&) = default;
};

/// m·v and mᵀ·v for a rotation matrix and 64-bit vectors: exact sums, each component rounded once.
[[nodiscard]] Vec3<Position> rotate(const Mat3& m, const Vec3<Position>& v);
[[nodiscard]] Vec3<Position> rotate_inverse(const Mat3& m, const Vec3<Position>& v);

/// The world position of a body point. Rounded once: within 0.5 · 2^-32 m of the value that the
/// rounded rotation matrix gives; that matrix is within 2^-30 of the quaternion's, a nanometre per
/// metre.
[[nodiscard]] Vec3<Position> apply(const Transform& t, const Vec3<Position>& point);
/// @cond  the same for a nearer point; Doxygen takes the two for one
[[nodiscard]] Vec3<Position> apply(const Transform& t, const Vec3<Length>& point);
/// @endcond

/// The body point that is at `point` in the world; bounds as for `apply`.
[[nodiscard]] Vec3<Position> apply_inverse(const Transform& t, const Vec3<Position>& point);

/// First `b`, then `a`: apply(compose(a, b), p) = apply(a, apply(b, p)) but for rounding. The
/// orientation is normalised.
[[nodiscard]] Transform compose(const Transform& a, const Transform& b);

/// apply(inverse(t), p) = apply_inverse(t, p) but for rounding.
[[nodiscard]] Transform inverse(const Transform& t);

}  // namespace lockstone
