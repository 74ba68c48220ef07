// Facets of convex shapes that are drawn neither as balls nor as boxes.
#pragma once

#include <memory>

#include <lockstone/hull.h>

#include "core/geometry/convex/polytope.h"

namespace lockstone::render {

/// A hull inside the shape that looks like it, of points where its core reaches farthest in many
/// directions. Null of shapes that are drawn by themselves: spheres, capsules, boxes.
[[nodiscard]] std::shared_ptr<const Hull> hull_within(const Shape& shape);

/// The same of a polytope with a radius; null of others.
[[nodiscard]] std::shared_ptr<const Hull> hull_within(const geometry::Polytope& polytope);

}  // namespace lockstone::render
