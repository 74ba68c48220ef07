// Where a point on its way passes through the front of a triangle of a mesh or height field.
#pragma once

#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// Nearer than this to a front a point counts as through it: far above the error of a height by
/// rounded frames of bodies and pieces. 7.6 µm
inline constexpr Length k_front_margin = Length::from_raw(8);

/// Straight, in the asset's frame, to 2^-21 m.
struct PointWay {
  Vec3<Length> from{};
  Vec3<Length> to{};
};

struct FrontCrossing {
  bool found = false;
  Unit fraction{};  ///< of the way: where it meets the front; 1 where it ends barely before it
  std::uint32_t part = 0;
  Vec3<Unit> normal{};  ///< of the front, asset frame
  Fine height{};        ///< of the way's end over the front, below k_front_margin
};

}  // namespace lockstone::geometry
