// Where the two frames of a joint are, and how far one has moved against the other.
#pragma once

#include <lockstone/quat.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// From the centre of mass to an anchor, in world axes.
[[nodiscard]] inline Vec3<Position> arm_of(const Mat3& rotation, const Vec3<Length>& anchor) {
  return rotate(rotation, rounded<Position>(anchor));
}

/// The frame of a joint on a body, in world axes.
[[nodiscard]] inline Mat3 frame_of(const Mat3& rotation, const Quat& orientation) {
  if (orientation == Quat{}) return rotation;
  return multiply(rotation, to_matrix(orientation));
}

/// Twist and swing of frame b against frame a, each in (−π, π]: the turn about the x axes by which
/// b differs from a carried over along the shortest arc, and the tilts of b's x axis about y and z.
[[nodiscard]] Vec3<Angle> swing_twist(const Mat3& a, const Mat3& b);

}  // namespace lockstone
