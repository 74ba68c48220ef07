// Spheres and capsules: a point or a segment along y, made round by a radius.
#pragma once

#include "core/geometry/convex/shape_traits.h"

namespace lockstone::geometry {

[[nodiscard]] Length ball_swept_radius(const Shape& shape);

/// Mass and volume 2π/3 · r²(3h + 2r): two half balls and a cylinder; h = 0 is the ball.
[[nodiscard]] Mass ball_swept_mass(const Shape& shape, Density density);
[[nodiscard]] BlockFloat ball_swept_volume(const Shape& shape);

/// The radius, less the depth.
[[nodiscard]] Shape ball_swept_shrunk(const Shape& shape, Length depth);

/// Every direction is that of a face.
[[nodiscard]] Vec3<Unit> round_face_along(const Shape& shape, const Vec3<Unit>& axis);

[[nodiscard]] bool is_in_ball(const Vec3<Length>& from_centre, Length radius);

}  // namespace lockstone::geometry
