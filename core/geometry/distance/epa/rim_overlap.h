// The depth of overlapping cores of which one or both have rims.
#pragma once

#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/epa/expanding_polytope.h"

namespace lockstone::geometry {

/// Where a surface is curved, no polytope of few vertices ends on it. So `polytope`, inside B − A
/// with the origin within, grows to 24 vertices only: its valleys, the faces that are nearer to the
/// origin than those around them, show where a way out may be the shortest. From each that could
/// still be shorter than the best so far the descent begins: B is put just outside along the
/// direction at hand, and the normal of the closest points there is the next direction. The depth
/// along it is never greater, because B's way to that place is no shorter along any direction than
/// the distance that is left. Faces and edges end that in a step or two; on curves the steps shrink
/// evenly, and their limit is taken.
///
/// The result is a local minimum of the depth, which separates; `exact` says that no direction is
/// better, by the planes of the polytope.
[[nodiscard]] CoreOverlap rim_overlap(GapQuery& query, ExpandingPolytope& polytope);

}  // namespace lockstone::geometry
