// How deep a tapered capsule overlaps a core that holds a point of its axis.
#pragma once

#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/gjk/gjk.h"

namespace lockstone::geometry {

/// Along a direction n the taper reaches as far as the farther of its balls. The least depth is
/// either a ball's own, whose way out leaves a face of the other core or its side where it is
/// nearest to the ball's centre, or, of a ball whose centre is outside that core, goes to the point
/// nearest there; or both balls reach equally far, along the ring of the side's normals, which
/// `least_on_ring` searches. All of these are tried, as exact depths of the whole taper; proven
/// beside polytopes and boxes, to half a micrometre. Then B is put just outside along the best, and
/// the normal of the closest points there taken if it is better: faces of hulls that were merged
/// are not quite those of their vertices.
[[nodiscard]] CoreOverlap taper_overlap(GapQuery& query);

}  // namespace lockstone::geometry
