// The distance of a convex shape from a half-space, by its deepest vertex.
#pragma once

#include "core/geometry/distance/cores/convex_core.h"

namespace lockstone::geometry {

struct HalfSpaceGap {
  Vec3<Unit> normal{};  ///< out of the half-space
  Fine distance = 0;    ///< of the surfaces, negative when they overlap
  RawVec on_plane{};    ///< from the half-space's centre
  RawVec on_shape{};    ///< from the shape's centre
  int vertex = 0;
};

/// `offset` is that of the shape's centre from the half-space's, fine. Any depth.
[[nodiscard]] HalfSpaceGap half_space_gap(const PosedShape& half_space, const PosedShape& shape,
                                          const RawVec& offset);

}  // namespace lockstone::geometry
