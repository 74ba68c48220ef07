// Where the two frames of a joint are, and how far one has moved against the other.
#pragma once

#include <lockstone/quat.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// From the centre of mass to an anchor within 1024 m along each axis, in world axes.
[[nodiscard]] inline Vec3<Position> arm_of(const Mat3& rotation, const Vec3<Length>& anchor) {
  constexpr int k_shift = Unit::frac_bits + Length::frac_bits - Position::frac_bits;
  const std::int64_t x = anchor.x.raw, y = anchor.y.raw, z = anchor.z.raw;
  const auto row = [&](Unit a, Unit b, Unit c) {
    return Position::from_raw(raw::round_shift(a.raw * x + b.raw * y + c.raw * z, k_shift));
  };
  const auto& [cx, cy, cz] = rotation;
  return {row(cx.x, cy.x, cz.x), row(cx.y, cy.y, cz.y), row(cx.z, cy.z, cz.z)};
}

/// The frame of a joint on a body, in world axes; `frame` is in the body's.
[[nodiscard]] inline Mat3 frame_of(const Mat3& rotation, const Mat3& frame) {
  if (frame == Mat3{}) return rotation;
  return multiply(rotation, frame);
}
[[nodiscard]] inline Mat3 frame_of(const Mat3& rotation, const Quat& orientation) {
  return frame_of(rotation, to_matrix(orientation));
}

/// The twist of frame b against frame a, as below.
[[nodiscard]] Angle twist_of(const Mat3& a, const Mat3& b);

/// Twist and swing of frame b against frame a, each in (−π, π]: the turn about the x axes by which
/// b differs from a carried over along the shortest arc, and the tilts of b's x axis about y and z.
[[nodiscard]] Vec3<Angle> swing_twist(const Mat3& a, const Mat3& b);

}  // namespace lockstone
