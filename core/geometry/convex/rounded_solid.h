// Mass distribution of polyhedra with a radius.
#pragma once

#include <optional>

#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/solid.h"

namespace lockstone::geometry {

/// Of all points within `polytope.radius` of the polytope, which is no flat one; nothing when its
/// radius exceeds k_max_hull_radius. `inner_radius` is left at zero.
///
/// J. Steiner's parts: the polytope, prisms on its faces, wedges of cylinders along its edges,
/// sectors of balls at its vertices. Their integrals are closed forms of lengths, normals and
/// angles. Integrals over a vertex's part of the sphere are sums over its arcs: ∫u = −½ Σ θ ê, and
/// from the Laplacian of u uᵀ, ∫u uᵀ = ω/3 I − ⅙ Σ (ê dᵀ + d êᵀ) with d = ∫u along the arc. Angles
/// have 32 bits and normals 30: the volume errs by at most 1e-8 of itself, moments by 1e-6; where
/// faces were merged, by the share of the unevenness besides.
[[nodiscard]] std::optional<Solid> rounded_solid_of(const Polytope& polytope);

}  // namespace lockstone::geometry
