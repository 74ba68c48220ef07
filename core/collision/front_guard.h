// Holds the centres of what is thin before the fronts of triangles, which meet nothing whose centre
// is behind them: what sinks farther than it is thick would fall through.
#pragma once

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/collision/placed_shape.h"

namespace lockstone {

/// Pieces whose inner radius is at most this are held. Others do not sink as far: what goes farther
/// than half its inner radius in a tick is followed, and contacts push out what went less.
inline constexpr Length k_thin_radius = Length::from_ratio(1, 50);

/// A shape where it was when a tick began, and where it is now.
struct PlacedWay {
  PlacedShape start;
  PlacedShape end;
};

/// What brings A back before a front.
struct FrontPush {
  bool found = false;
  Unit fraction{};        ///< of the tick, when the front was crossed
  Vec3<Position> by{};    ///< the least that brings it before this front
  Vec3<Position> back{};  ///< what takes the piece's centre to where it was at the beginning
};

/// The first front of the mesh, which stands still, that the centre of a thin piece of A passed on
/// its straight way; of equals that of the lowest parts.
[[nodiscard]] FrontPush find_front_push(const PlacedWay& a, const PlacedShape& mesh);

}  // namespace lockstone
