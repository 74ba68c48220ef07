#include "core/geometry/distance/epa/difference_frame.h"

#include "core/geometry/numeric/wide_vectors.h"

namespace lockstone::geometry {
namespace {

constexpr std::array<RawVec, 3> k_axes{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

/// Adds the extreme vertex along ±direction, if one is not at `direction`'s height of vertex 0.
bool add_off_plane(const LatticePair& pair, const RawVec& direction, DifferenceFrame& frame) {
  for (const RawVec& d : {direction, -direction}) {
    const DifferenceVertex vertex = greatest_along(pair, d);
    if (is_zero(wide_dot(d, vertex.point - frame.point(0)))) continue;
    frame.add(vertex);
    return true;
  }
  return false;
}

/// One more dimension: along directions that span the complement of the frame, some vertex lies off
/// it unless the difference is that flat.
bool add_dimension(const LatticePair& pair, DifferenceFrame& frame) {
  if (frame.count == 3) {
    return add_off_plane(pair, narrow_cross(frame.edge(1), frame.edge(2)), frame);
  }
  for (const RawVec& axis : k_axes) {
    const RawVec direction = frame.count == 1 ? axis : narrow_cross(frame.edge(1), axis);
    if (direction != RawVec{} && add_off_plane(pair, direction, frame)) return true;
  }
  return false;
}

}  // namespace

DifferenceFrame frame_of(const GapQuery& query) {
  DifferenceFrame frame{query.simplex().count, query.simplex().vertices};
  while (frame.count < 4) {
    if (!add_dimension(query.lattice(), frame)) break;
  }
  return frame;
}

}  // namespace lockstone::geometry
