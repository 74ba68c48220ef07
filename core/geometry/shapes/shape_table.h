// The rows of the table of shapes.
#pragma once

#include "core/geometry/convex/shape_traits.h"

// Kinds after those with a number of their own, in the order of their numbers. Each has a row
// k_<kind>, which is linked only by programs that name the kind's function in `Shape`, and a name.
#define LKS_LATER_SHAPES(X)             \
  X(cylinder, "cylinder")               \
  X(cone, "cone")                       \
  X(tapered_capsule, "tapered capsule") \
  X(rounded_box, "rounded box")

// The address of a row that is not linked is null. Where the linker has no such symbols, every row
// is linked.
#if (defined(__ELF__) || defined(__wasm__)) && !defined(LKS_LINKS_ALL_ROWS)
#define LKS_LATER_ROW __attribute__((weak))
#else
#define LKS_LATER_ROW
#endif

namespace lockstone::geometry {

extern const ShapeTraits k_sphere;
extern const ShapeTraits k_capsule;
extern const ShapeTraits k_box;

#define LKS_DECLARE_ROW(kind, name) extern const ShapeTraits k_##kind LKS_LATER_ROW;
LKS_LATER_SHAPES(LKS_DECLARE_ROW)
#undef LKS_DECLARE_ROW

}  // namespace lockstone::geometry
