// Contacts of any two convex shapes by the features that face each other: for kinds without
// functions of their own for each pair.
#pragma once

#include <cstdint>

#include "core/geometry/distance/manifold.h"

namespace lockstone::geometry {

/// The feature of a point that is the deepest of two shapes, on none of their faces or edges.
inline constexpr std::uint32_t k_single_point = 1U << 30;

/// As `lockstone::collide`, of convex shapes and polytopes in any order. Features: see
/// `find_feature`, `clip`, and `nearest_manifold` for single points.
[[nodiscard]] Manifold collide_convex(const PosedShape& a, const PosedShape& b,
                                      const Vec3<Length>& offset, Length margin);

}  // namespace lockstone::geometry
