// The point of a polytope nearest to a given point.
#pragma once

#include "core/geometry/contact/polytope/polytope_pair.h"

namespace lockstone::geometry {

struct NearestPoint {
  bool found = false;   ///< false when farther than the limit
  bool inside = false;  ///< in the solid: then the nearest point of the face of least depth
  int face = -1;        ///< that the nearest point lies within, or −1
  RawVec point;         ///< fine, the polytope's frame
  RawVec gap;           ///< from the nearest point to the given one; zero is possible
  Fine distance = 0;    ///< the length of the gap, negative inside
};

/// Error of a distance < 2 µm and 2e-9 of the coordinates. The height above the highest plane
/// decides between inside, a face and the edges of the faces that see the point.
/// A flat polytope has no inside. |point| < 5200 m a lane.
[[nodiscard]] NearestPoint nearest_point(const Polytope& polytope, const RawVec& point, Fine limit);

/// Height of a point above each face's plane.
[[nodiscard]] Fine height_above(const PolytopeFace& face, const SplitVec& point);

/// Whether a point above or below the face is beside it: within its side planes. Exact.
[[nodiscard]] bool is_beside(const Polytope& polytope, int face, const RawVec& point);

}  // namespace lockstone::geometry
