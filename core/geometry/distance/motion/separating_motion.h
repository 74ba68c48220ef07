// How far two moving and turning cores may go before a plane between them stops separating: lower
// bounds in one dimension.
//
// The plane may stand still or turn with either body. A rod that turns about its middle sweeps its
// ends through every plane that stands still, and none that turns with it.
#pragma once

#include <lockstone/transform.h>

#include "core/base/unset_array.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/math/trig.h"

namespace lockstone {

/// A motion over one interval: the centre moves evenly along a line, and the body turns evenly
/// about it. Components of the translation within ±1024 m, of the rotation within ±2^13 rad.
struct Sweep {
  Transform start{};  ///< of the centre of rotation
  Vec3<Position> translation{};
  RotationVector rotation{};  ///< world axes
};

namespace geometry {

/// Lengths and lengths a sweep, 32 fraction bits.
using Metres = std::int64_t;
inline constexpr int k_metre_bits = 32;
inline constexpr int k_fine_per_metre = k_fine_bits - k_metre_bits;

/// x · fraction, rounded.
[[nodiscard]] constexpr std::int64_t part(std::int64_t x, Unit fraction) {
  return raw::multiply_shift(x, fraction.raw, Unit::frac_bits);
}

[[nodiscard]] constexpr Metres to_metres(Fine x) {
  return raw::round_shift(x, k_fine_per_metre);
}

/// A core on its way. Both vectors fine, world axes, at the present moment.
struct MovingCore {
  const ConvexCore& core;
  const Sweep& sweep;
  RawVec centre;  ///< of rotation, from A's shape centre
  RawVec shape;   ///< the shape's centre, from A's
};

/// A vertex along the normal: where it is and how fast it moves.
struct Line {
  Metres at = 0;
  Metres rate = 0;
};

/// A body's vertices along a normal that moves and turns with a frame.
struct Projection {
  int count = 0;
  Metres rate = 0;          ///< of the centre of rotation, in a frame at rest
  Metres turning_rate = 0;  ///< ≥ |speed by turning| of every vertex, likewise
  Metres acceleration = 0;  ///< ≥ |acceleration| of every vertex in the frame
  UnsetArray<Line, k_max_polytope_vertices> lines;

  /// The greatest of the vertices after a step, without acceleration.
  [[nodiscard]] Metres greatest(Unit step) const;
};

/// Two cores and the unit normal of a plane between them, from A to B.
struct SeparatedPair {
  MovingCore a;
  MovingCore b;
  Vec3<Unit> normal;
  Metres reserve = 0;  ///< the distance that the cores keep: radii and target
};

/// Room for the two bodies' vertices.
struct Projections {
  Projection a;
  Projection b;  ///< along −normal
};

/// A step in (0, rest], or 0, within which the cores stay `reserve` apart. The longest of: by the
/// greatest speed of any vertex along the normal at rest, |n × ω|·r and the centres' approach; and
/// by each vertex' own speed and the greatest acceleration, along the normal at rest and turning
/// with A or B.
[[nodiscard]] Unit safe_step(const SeparatedPair& pair, Unit rest, Projections& scratch);

/// Whether the plane parts the cores by `reserve` over the whole interval while it turns with
/// `body`, one of the two.
[[nodiscard]] bool stays_parted(const SeparatedPair& pair, const MovingCore& body,
                                Projections& scratch);

}  // namespace geometry
}  // namespace lockstone
