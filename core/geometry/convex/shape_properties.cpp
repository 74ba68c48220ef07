#include "core/geometry/convex/shape_properties.h"

#include <bit>

#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/math/roots.h"

namespace lockstone {
namespace geometry {

Length root_up(std::uint64_t squares) {
  const std::uint64_t root = isqrt(squares);
  return Length::from_raw(static_cast<std::int32_t>(root + (root * root < squares ? 1 : 0)));
}

}  // namespace geometry

Length bounding_radius(const Shape& shape) {
  return geometry::traits_of(shape).bounding_radius(shape);
}

Length inner_radius(const Shape& shape) {
  return geometry::traits_of(shape).inner_radius(shape);
}

Vec3<Length> world_half_extents(const Shape& shape, const Mat3& rotation) {
  return geometry::traits_of(shape).half_extents(shape, rotation);
}

Mass mass_of(const Shape& shape, Density density) {
  LKS_ASSERT(density.raw >= 0);
  return geometry::traits_of(shape).mass(shape, density);
}

int scale_exponent_of(Length radius) {
  LKS_ASSERT(radius.raw > 0);
  return static_cast<int>(std::bit_width(static_cast<std::uint32_t>(radius.raw) - 1)) -
         Length::frac_bits;
}

int scale_exponent(const Shape& shape) {
  return scale_exponent_of(bounding_radius(shape));
}

Vec3<Unit> normalized_inertia(const Shape& shape) {
  // Fractions of the scale 2^k with 30 bits: exact, since the scale is at most 2^10 m.
  const int shift = 10 - scale_exponent(shape);
  geometry::ScaledSizes sizes;
  for (int i = 0; i < 3; ++i)
    sizes[static_cast<std::size_t>(i)] = geometry::raw_of(shape.size[i]) << shift;
  sizes[3] = geometry::raw_of(shape.fourth_size()) << shift;
  return geometry::traits_of(shape).inertia(sizes);
}

}  // namespace lockstone
