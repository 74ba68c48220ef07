// The closest points of two cores by their exact vertices, from features that a coarse lattice
// found.
#pragma once

#include "core/geometry/distance/gjk/closest_features.h"

namespace lockstone::geometry {

/// A plane that separates the cores, and points that are as far apart.
struct FineClosest {
  CoreGap gap{};
  Simplex features{};  ///< whose hull holds the closest point; the vertices' points are not set
  bool apart = false;  ///< the plane separates, or is within k_proof of the points
};

/// The error bound of a proven distance: 0.12 µm.
inline constexpr Fine k_proof = Fine{1} << (k_fine_bits - 23);

/// GJK in fine lanes from a simplex of one to four vertices: the vertex of B − A least along the
/// direction to the closest point is taken in, and of the simplex that vertex, edge or triangle is
/// kept whose plane separates most, until the plane is proven. Products of 128 bits, each direction
/// cut to 61. Not apart: the cores overlap, or are nearer than the lanes resolve.
[[nodiscard]] FineClosest fine_closest(const FinePair& pair, const Simplex& start);

}  // namespace lockstone::geometry
