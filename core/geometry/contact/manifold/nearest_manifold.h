// A contact of one point from distance or depth: for pairs whose features settle nothing.
#pragma once

#include "core/geometry/distance/manifold.h"

namespace lockstone::geometry {

/// Where the shapes are nearest, or the least way out of an overlap: one point, as `distance` and
/// `penetration` find it, on both surfaces (A is not round). None when they are apart by the margin
/// or more. Its feature is always the same.
[[nodiscard]] Manifold nearest_manifold(const PosedShape& a, const PosedShape& b,
                                        const Vec3<Length>& offset, Length margin);

}  // namespace lockstone::geometry
