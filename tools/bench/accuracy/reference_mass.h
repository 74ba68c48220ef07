// Mass distributions in long double, found without the core's integrals.
#pragma once

#include <array>
#include <span>

#include <lockstone/compound.h>
#include <lockstone/hull.h>

#include "tools/bench/accuracy/long_vectors.h"

namespace lockstone::bench {

using Long33 = std::array<Long3, 3>;

/// Volume (or weight), centre, and ∫ xy / volume about the centre.
struct MassReference {
  Long volume = 0;
  Long3 centre{};
  Long33 second{};
};

/// Of the convex hull of points, which is built again from exact predicates.
[[nodiscard]] MassReference mass_of_hull(std::span<const Vec3<Length>> points);

/// In closed form.
[[nodiscard]] MassReference mass_of_primitive(const Shape& shape);

/// Every child by its density, overlaps twice.
[[nodiscard]] MassReference mass_of_compound(std::span<const CompoundChild> children);

}  // namespace lockstone::bench
