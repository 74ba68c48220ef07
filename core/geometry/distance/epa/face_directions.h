// The directions that leave the flat faces of a core, and both along the axis of a cone or
// a capsule.
#pragma once

#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {

[[nodiscard]] inline RawVec axis_of(const Rims& rims) {
  return rims.centres[1] - rims.centres[0];
}

template <class Take>
void for_each_face_direction(const ConvexCore& core, Take&& take) {
  const bool round = core.rims.count != 0;
  for (int i = 0; i < (round ? 1 : core.generator_count); ++i) {
    const RawVec g = round ? axis_of(core.rims) : core.generators[static_cast<std::size_t>(i)];
    const Vec3<Unit> side = direction_of(g.x, g.y, g.z);
    take(side);
    take(-side);
  }
  if (core.polytope == nullptr) return;
  for (const PolytopeFace& face : core.polytope->faces)
    take(unit_axis(lockstone::rotate(core.rotation, face.normal)));
}

}  // namespace lockstone::geometry
