// The functions of hulls with a radius, behind an address: a program that names
// `HullOptions::rounded` or `load_asset` links them, and others refuse such hulls.
#pragma once

#include <optional>

#include "core/geometry/convex/solid.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/shapes/shape_table.h"
#include "core/geometry/submerged/submerged.h"

namespace lockstone::geometry {

struct HullRounding {
  PolytopeKernels kernels;
  std::optional<Solid> (*solid_of)(const Polytope& polytope);
  FacetCorrection (*facets_of)(const Polytope& polytope, BlockFloat volume);
};

extern const HullRounding k_hull_rounding LKS_LATER_ROW;

/// Null in a program that does not link it.
[[nodiscard]] inline const HullRounding* hull_rounding() {
  return &k_hull_rounding;
}

}  // namespace lockstone::geometry
