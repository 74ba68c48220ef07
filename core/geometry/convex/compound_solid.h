// Mass distribution of several solids taken together.
#pragma once

#include <span>

#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/convex/solid.h"

namespace lockstone::geometry {

/// A solid placed in a common frame.
struct PlacedSolid {
  Solid solid;
  Vec3<Length> position{};  ///< of the solid's own frame
  Quat orientation{};       ///< of the solid's own frame
  BlockFloat weight{};      ///< relative density · volume
};

/// Centre, axes, moments and radii of all together; `volume` is the sum of the weights. The common
/// part of two solids counts twice. `inner_radius` is that of the best single solid. At least one
/// solid.
[[nodiscard]] Solid combined(std::span<const PlacedSolid> solids);

/// The solid of a primitive.
[[nodiscard]] Solid solid_of(const Shape& primitive);

}  // namespace lockstone::geometry
