// A segment against a polytope, in the polytope's frame.
#pragma once

#include <array>

#include "core/geometry/contact/polytope/polytope_edges.h"
#include "core/geometry/contact/polytope/polytope_point.h"

namespace lockstone::geometry {

struct PolytopeSegment {
  const Polytope& polytope;
  RawVec centre;  ///< fine
  Vec3<Unit> axis;
  Fine half = 0;
  Facing backward;  ///< of a one-sided polytope: allows −n of the axes n that may push

  [[nodiscard]] RawVec at(Fine s) const { return centre + along(axis, s); }
};

/// The heights of a segment's ends above the faces. Only the entries of faces that exist are set.
struct SegmentHeights {
  std::array<std::int64_t, k_max_polytope_faces> lean;  ///< n · axis, 60 fraction bits
  std::array<Fine, k_max_polytope_faces> low;           ///< of the lower end above the plane
  std::array<Fine, k_max_polytope_faces> first;         ///< of the end at −half
  std::array<Fine, k_max_polytope_faces> last;          ///< of the end at +half
};
void measure(const PolytopeSegment& segment, SegmentHeights& heights);

/// The face whose plane the whole segment is farthest above, or least below.
struct SegmentFace {
  int face = 0;
  Fine separation = 0;
};
[[nodiscard]] SegmentFace best_face(const PolytopeSegment& segment, const SegmentHeights& heights);

/// The axis square to an edge and to the segment that separates most: above `threshold`, or none.
/// Edges whose arc crosses the great circle square to the segment take part.
struct SegmentEdge {
  bool found = false;
  int edge = 0;
  Vec3<Unit> normal;  ///< the polytope's frame, from the polytope to the segment
  Fine separation = 0;
};
[[nodiscard]] SegmentEdge best_edge(const PolytopeSegment& segment, const SegmentHeights& heights,
                                    Fine threshold);

/// Parameters of the part of the segment beside a face. Empty when low > high.
struct BesideFace {
  Fine low = 0;
  Fine high = 0;
};
[[nodiscard]] BesideFace beside_face(const PolytopeSegment& segment, int face);

/// The nearest points of a segment and a polytope that are apart.
struct SegmentNearest {
  bool found = false;
  Fine s = 0;
  RawVec point;  ///< on the polytope
  RawVec gap;    ///< from there to the segment
  Fine distance = 0;
};
[[nodiscard]] SegmentNearest nearest_to_segment(const PolytopeSegment& segment,
                                                const SegmentHeights& heights, Fine limit);

}  // namespace lockstone::geometry
