// The hull of two balls: where its centre of mass is, and how its mass is spread.
#pragma once

#include <cstdint>

#include "core/geometry/convex/shape_traits.h"

namespace lockstone::geometry {

/// Two balls on the y axis; the centre of mass of their hull is the origin. Of balls of which one
/// holds the other, both are the greater.
struct TaperedEnds {
  Fine low = 0;  ///< centres
  Fine high = 0;
  Length low_radius{};
  Length high_radius{};

  /// The sine of the angle between the side and the axis: of the side's normals, the part along y.
  [[nodiscard]] Unit slope() const;
  /// The cosine.
  [[nodiscard]] Unit rise() const;
};

/// size.x = radius of the lower ball, y = distance of the centres, z = radius of the upper ball.
/// The centre of mass is exact to 2^-50 of that distance.
[[nodiscard]] TaperedEnds tapered_ends(const Sizes& size);

/// Fraction bits of the shares below.
inline constexpr int k_tapered_bits = 54;

/// The integrals over the hull, as shares of products of its sizes.
struct TaperedMass {
  std::uint64_t radius = 0;  ///< R, the greater, in the unit of the sizes
  std::uint64_t length = 0;  ///< M, the greater of R and the distance of the centres
  std::int64_t volume = 0;   ///< of π/3 R² M
  std::int64_t axial = 0;    ///< moment about the axis, of R² and the mass
  std::int64_t across = 0;   ///< likewise across the axis through the centre of mass, of M²
};

/// Of sizes in any unit, below 2^31.
[[nodiscard]] TaperedMass tapered_mass(std::uint64_t low_radius, std::uint64_t distance,
                                       std::uint64_t high_radius);

}  // namespace lockstone::geometry
