// A segment against a box, in the box's axes: distance when apart, least overlap when not.
#pragma once

#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// A segment in the axes of a box that is centred on the origin.
struct LocalSegment {
  RawVec centre;  ///< fine
  Vec3<Unit> axis;
  Fine half = 0;
  RawVec box_half;  ///< fine
};

[[nodiscard]] RawVec point_at(const LocalSegment& segment, Fine s);

/// How far `point` lies beyond the box, axis by axis; zero inside.
[[nodiscard]] RawVec excess_of(const RawVec& point, const RawVec& box_half);

/// The parameter of the point of the segment nearest to the box; where several are equally near,
/// the middle of those between breakpoints.
[[nodiscard]] Fine nearest_to_box(const LocalSegment& segment);

/// Parameters of the part of the segment beside the face of `face_axis`, between its side planes.
/// Empty when low > high.
struct Interval {
  Fine low = 0;
  Fine high = 0;
};
[[nodiscard]] Interval beside_face(const LocalSegment& segment, int face_axis);

/// The axis of least overlap of a segment that meets the box: a face normal, or the cross product
/// of a box axis with the segment.
struct OverlapAxis {
  bool is_edge = false;
  int axis = 0;         ///< of the box
  Vec3<Unit> normal;    ///< in the box's axes, from the box to the segment's centre
  Fine separation = 0;  ///< of the segment itself; negative
};
[[nodiscard]] OverlapAxis least_overlap(const LocalSegment& segment);

}  // namespace lockstone::geometry
