// Sizes and mass distribution of primitives; assets carry their own.
#pragma once

#include <lockstone/quat.h>
#include <lockstone/shape.h>

namespace lockstone {

/// Radius of the smallest sphere about the centre that holds the shape, rounded up; < 1024 m.
[[nodiscard]] Length bounding_radius(const Shape& shape);

/// Radius of the largest sphere about the centre that the shape holds.
[[nodiscard]] Length inner_radius(const Shape& shape);

/// Half extents of the shape's axis-aligned bounds in world axes, rounded outward.
[[nodiscard]] Vec3<Length> world_half_extents(const Shape& shape, const Mat3& rotation);

/// Mass of the shape at uniform `density`, correctly rounded up to 1e-9 relative, saturating.
[[nodiscard]] Mass mass_of(const Shape& shape, Density density);

/// The smallest k with 2^k m ≥ radius > 0.
[[nodiscard]] int scale_exponent_of(Length radius);

/// That of bounding_radius(shape); −10 … 10.
[[nodiscard]] int scale_exponent(const Shape& shape);

/// Principal moments of inertia of the solid, divided by mass and by the square of the scale 2^k:
/// each in (0, 1]. Error ≤ 2^-29 absolute.
[[nodiscard]] Vec3<Unit> normalized_inertia(const Shape& shape);

}  // namespace lockstone
