// The part of a convex solid below a plane, and the area of a solid's shadow: forces of fluids
// follow from them.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/convex/polytope.h"
#include "core/math/block_float.h"
#include "core/math/int128.h"

namespace lockstone::geometry {

/// Fraction bits of volumes, moments and areas in units of the solid's scale 2^k m.
inline constexpr int k_submerged_bits = 48;

/// π, 60 fraction bits.
inline constexpr std::int64_t k_pi_q60 = 3622009729038561421;

/// a · b of 30 fraction bits, to nearest.
[[nodiscard]] constexpr std::int64_t product_q30(std::int64_t a, std::int64_t b) {
  return saturated_product(a, b, 30);
}

/// A solid that is complete in itself, or a polyhedron.
struct ConvexSolid {
  const Shape& shape;
  const Polytope* polytope;  ///< of a hull
};

/// n · x ≤ offset, in the frame of the solid.
struct BelowPlane {
  Vec3<Unit> normal{};  ///< a unit vector
  Position offset{};
};

/// The part of a solid that lies below a plane. Lengths are in units of 2^scale m.
struct SubmergedPart {
  int scale = 0;
  std::int64_t volume = 0;
  std::array<std::int64_t, 3> moment{};  ///< ∫x dV about `reference`
  std::int64_t plane_area = 0;           ///< of the section with the plane, within 1 %
  Vec3<Length> reference{};              ///< in the frame of the solid
};

/// Spheres in closed form. Polyhedra are clipped: exact for the vertices and the section's vertices
/// rounded to 2^-28 of the scale. Solids of revolution by slices across their axis, in each
/// interval between the breaks of the section Gauss–Legendre quadrature of 16 points in φ,
/// y = m − w·cos φ, which takes the roots at the ends of the interval away: volumes and moments
/// err by less than 2^-27 of the cube, or fourth power, of the scale. Rounded boxes and hulls by
/// `RoundedFacets`.
[[nodiscard]] SubmergedPart part_below(const ConvexSolid& solid, const BelowPlane& plane);

/// Of a rounded hull, about its interior point, which must be its centre of mass.
[[nodiscard]] FacetCorrection facet_correction(const Polytope& polytope, BlockFloat volume);

/// The whole solid, as `part_below` of a plane above it.
[[nodiscard]] SubmergedPart whole(const ConvexSolid& solid);

/// The area of the shadow along a unit vector in the solid's frame, in units of 2^(2·scale) m².
struct Shadow {
  int scale = 0;
  std::int64_t area = 0;
};
[[nodiscard]] Shadow shadow_of(const ConvexSolid& solid, const Vec3<Unit>& direction);

}  // namespace lockstone::geometry
