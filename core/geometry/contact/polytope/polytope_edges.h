// Edges of polytopes that separate: pairs of edges whose arcs cross on the Gauss map.
#pragma once

#include "core/geometry/contact/polytope/polytope_pair.h"
#include "core/geometry/numeric/segment.h"

namespace lockstone::geometry {

/// Half edges, and the unit axis square to both.
struct EdgeSupport {
  bool found = false;
  int edge_a = 0;
  int edge_b = 0;
  Vec3<Unit> normal;  ///< A's frame, from A to B
  Fine separation = 0;
};

/// The best pair of edges with a separation above `threshold`, the first of equals.
///
/// Two edges span a face of the Minkowski difference when the arcs between their faces' normals
/// cross on the unit sphere (Dirk Gregorius, The Separating Axis Test between Convex Polyhedra);
/// signs of exact products decide. The axes of an edge lie between the normals of its two faces, so
/// that a witness which is low enough over both leaves it out. The separation of the remaining edges
/// is that of the supporting vertices, whatever the edges were.
///
/// Axes that point to the back of `front` (A's frame) count only when they separate.
[[nodiscard]] EdgeSupport best_edge(const PolytopePair& pair, Fine threshold, const Facing& front,
                                    const Witness& of_a, const Witness& of_b);

/// The feature of a point of two edges.
[[nodiscard]] std::uint32_t feature_of_edges(int edge_a, int edge_b);

/// Whether this feature of a point is that of two edges of polytopes.
[[nodiscard]] bool is_of_hull_edges(std::uint32_t feature);

/// The two edges of such a feature, where their arcs cross.
[[nodiscard]] EdgeSupport held_edge(const PolytopePair& pair, std::uint32_t feature,
                                    const Facing& front);

/// The edge as a segment, `rotation` taking it to other axes and `origin` (fine) moving it.
[[nodiscard]] Segment edge_segment(const Polytope& polytope, int edge, const Mat3& rotation,
                                   const RawVec& origin);

/// Three lanes brought below 2^bits in size by a common right shift.
[[nodiscard]] RawVec narrowed(const RawVec& v, int bits);

/// The cross product of lanes of which one vector fits 31 bits and the other 30.
[[nodiscard]] constexpr RawVec cross_narrow(const RawVec& a, const RawVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// The product of narrow lanes with a unit vector: only its sign means something.
[[nodiscard]] constexpr std::int64_t lean_of(const RawVec& narrow, const Vec3<Unit>& n) {
  return narrow.x * n.x.raw + narrow.y * n.y.raw + narrow.z * n.z.raw;
}

}  // namespace lockstone::geometry
