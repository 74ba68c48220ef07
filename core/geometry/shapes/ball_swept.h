// Spheres and capsules: a point or a segment along y, made round by a radius.
#pragma once

#include "core/geometry/convex/shape_traits.h"

namespace lockstone::geometry {

/// Mass and volume 2π/3 · r²(3h + 2r): two half balls and a cylinder; h = 0 is the ball.
[[nodiscard]] Mass ball_swept_mass(const Sizes& size, Density density);
[[nodiscard]] BlockFloat ball_swept_volume(const Sizes& size);

/// The radius, less the depth.
[[nodiscard]] Sizes ball_swept_shrunk(const Sizes& size, Length depth);

/// Every direction is that of a face.
[[nodiscard]] Vec3<Unit> round_face_along(const Sizes& size, const Vec3<Unit>& axis);

[[nodiscard]] bool is_in_ball(const Vec3<Length>& from_centre, Length radius);

}  // namespace lockstone::geometry
