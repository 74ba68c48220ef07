// The rows of the table of shapes.
#pragma once

#include "core/geometry/convex/shape_traits.h"

namespace lockstone::geometry {

extern const ShapeTraits k_sphere;
extern const ShapeTraits k_capsule;
extern const ShapeTraits k_box;

}  // namespace lockstone::geometry
