// The hit of a ray on a single shape.
#pragma once

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Where a ray first meets a shape. `fraction` of the ray's length, 0 … 1.
struct ShapeRayHit {
  bool hit = false;
  Unit fraction{};
  Vec3<Unit> normal{};  ///< outward, world axes; zero when the ray starts inside (fraction 0)
};

}  // namespace lockstone
