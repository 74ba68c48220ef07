// The depth of overlapping cores of which one or both have rims.
#pragma once

#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/epa/expanding_polytope.h"

namespace lockstone::geometry {

/// The shortest way out leaves B − A where a ball about the origin touches it from inside, so on
/// - a flat face of A or B against a vertex: the depths along all their normals are compared;
/// - a side against a vertex or an edge: along the ring of the side's normals `least_on_ring` finds
///   the least depth;
/// - a rim against an edge: the same along the ring across each edge of a box or the axis of
///   a capsule;
/// - a rim against a rim, or against an edge of a polytope: there a map is needed. `polytope`,
///   inside B − A with the origin within, grows to 24 vertices, because no polytope of few vertices
///   ends on a curved surface. Its valleys, the faces that are nearer to the origin than those
///   around them, show where a way out may be the shortest.
///
/// From each of these directions that could be shorter than the best so far a descent begins: B is
/// put just outside along the direction at hand, and the normal of the closest points there is the
/// next direction. The depth along it is never greater, because B's way to that place is no shorter
/// along any direction than the distance that is left. Faces and edges end that in a step or two;
/// on curves the steps shrink evenly, and their limit is taken.
///
/// The result is a local minimum of the depth, which separates. `exact` says that by the faces of
/// the polytope no direction is better by more than 8 steps of the lattice.
[[nodiscard]] CoreOverlap rim_overlap(GapQuery& query, ExpandingPolytope& polytope);

}  // namespace lockstone::geometry
