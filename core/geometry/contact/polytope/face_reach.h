// Whether the incident face comes down to the reference face anywhere within its sides.
#pragma once

#include "core/geometry/contact/polytope/polytope_face.h"

namespace lockstone::geometry {

/// False only where no point of the incident face's manifold is at most `height` above the
/// reference face. One side shows that: the one that the deepest vertex is farthest beyond.
/// Where two edges are nearest, the manifolds of both faces would be clipped in vain.
[[nodiscard]] bool may_come_down(const PolytopeFaceMeeting& meeting, int incident, Fine height);

}  // namespace lockstone::geometry
