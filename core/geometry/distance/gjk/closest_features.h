// From features found on the lattice to normal, distance and witnesses at full precision.
#pragma once

#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/distance/gjk/simplex.h"

namespace lockstone::geometry {

/// Two cores along one unit direction.
struct CoreGap {
  Vec3<Unit> normal{};
  Fine distance = 0;  ///< of the features' closest points, ≥ 0
  RawVec on_a{};      ///< closest points from A's centre, fine
  RawVec on_b{};
};

/// The pair as the refinement needs it: exact cores, their lattice, and the exact offset from A's
/// centre to B's.
struct FinePair {
  const ConvexCore& a;
  const ConvexCore& b;
  RawVec offset;
};

/// On which side of the features' plane the rest of B − A lies, seen from the origin.
enum class Side : std::uint8_t {
  beyond,  ///< GJK: the features are the nearest of it
  before,  ///< EPA: they are the farthest along their normal
};

/// The vector from the origin to the closest point of the simplex (of one to three vertices).
/// Recomputed in fine lanes where the finer normal supports the features as well as the lattice's
/// does, within a step; elsewhere (slivers, crumbs beside giants) the lattice's normal stays.
[[nodiscard]] CoreGap refine(const FinePair& fine_pair, const LatticePair& lattice,
                             const Simplex& simplex, Side rest);

}  // namespace lockstone::geometry
