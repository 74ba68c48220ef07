// From the clipped polygon to at most four points.
#pragma once

#include "core/geometry/box_face.h"

namespace lockstone::geometry {

/// Removes vertices whose separation `keeps` refuses. Keeps the order.
void drop_far_vertices(FacePolygon& polygon, Length margin);

/// Leaves at most four vertices, ascending by feature: the one farthest in a fixed direction, the
/// one farthest from it, the one that spans the largest triangle with both, and the one that adds
/// most area to that. Each later candidate must be better by a sixteenth, so that equals do not
/// alternate. A vertex more than k_deeper deeper than the four replaces the nearest of them.
void reduce_to_four(FacePolygon& polygon);

/// 7.6 µm.
inline constexpr Fine k_deeper = Fine{1} << (k_fine_bits - 17);

}  // namespace lockstone::geometry
