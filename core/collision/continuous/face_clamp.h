// Keeps the centre of a thin body on the front side of one-sided triangles. Triangles do not
// collide with a body whose centre is behind them, so a body that sank farther than its thickness
// would fall through.
#pragma once

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/collision/narrow_phase/placed_shape.h"

namespace lockstone {

/// Pieces whose inner radius is at most this are clamped. Thicker pieces do not sink as far:
/// continuous collision stops those that move farther than half their inner radius in a tick, and
/// contacts push out the others.
inline constexpr Length k_thin_radius = Length::from_ratio(1, 50);

/// A shape where it was when a tick began, and where it is now.
struct PlacedWay {
  PlacedShape start;
  PlacedShape end;
};

/// Brings A back before a front.
struct FrontPush {
  bool found = false;
  Unit fraction{};        ///< of the tick, when the front was crossed
  Vec3<Position> by{};    ///< the least that brings it before this front
  Vec3<Position> back{};  ///< takes the piece's centre to where it was at the beginning
};

/// The first front of the mesh, which stands still, that the centre of a thin piece of A passed on
/// its straight way; of equals that of the lowest parts.
[[nodiscard]] FrontPush find_front_push(const PlacedWay& a, const PlacedShape& mesh);

}  // namespace lockstone
