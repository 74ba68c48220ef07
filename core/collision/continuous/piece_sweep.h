// The way of a convex piece of a body in motion.
#pragma once

#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/distance/motion/time_of_impact.h"
#include "core/math/rotation_log.h"

namespace lockstone {

/// The motion of the body as one of the piece's axes about the body's centre of mass.
struct PieceSweep {
  Sweep sweep;
  Vec3<Length> origin;

  PieceSweep(const Piece& piece, const Sweep& motion)
      : sweep{{motion.start.position, orientation_of(piece.rotation)},
              motion.translation,
              motion.rotation} {
    const Vec3<Position> apart = piece.origin - motion.start.position;
    if (is_near(apart)) {
      origin = rotate_inverse(piece.rotation, saturated<Length>(apart));
    } else if (motion.rotation == RotationVector{}) {
      sweep.start.position = piece.origin;
    } else {
      origin = saturated<Length>(rotate_inverse(piece.rotation, apart));
    }
  }

 private:
  // Whether it fits a Length however it is turned. A half-space, which is a box wherever something
  // comes near it, may begin anywhere.
  static bool is_near(const Vec3<Position>& apart) {
    constexpr Position k_near = Position::from_integer(1000);
    return max(max(abs(apart.x), abs(apart.y)), abs(apart.z)) <= k_near;
  }
};

}  // namespace lockstone
