// Rays against boxes.
#pragma once

#include <lockstone/quat.h>
#include <lockstone/shape.h>

#include "core/geometry/query/ray_hit.h"

namespace lockstone::geometry {

/// Hit and miss are exact in the box's frame, whose axes are the matrix' columns as they are; the
/// fraction is correctly rounded.
/// Kay and Kajiya, Ray tracing complex scenes, slabs; the fractions are compared by cross products.
[[nodiscard]] ShapeRayHit cast_ray_at_box(const Shape& box, const Mat3& rotation,
                                          const Vec3<Length>& origin,
                                          const Vec3<Length>& translation);

}  // namespace lockstone::geometry
