#include "core/geometry/convex/shape_properties.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

constexpr std::uint64_t square(std::uint64_t x) {
  return x * x;
}

constexpr std::uint64_t raw_of(Length x) {
  return static_cast<std::uint64_t>(x.raw);
}

/// a · b for a < 2^96.
constexpr UInt128 multiply(UInt128 a, std::uint32_t b) {
  const UInt128 low = multiply_wide(a.low, std::uint64_t{b});
  return {low.high + a.high * b, low.low};
}

/// A length with 50 fraction bits, brought to 20 bits upwards.
Length rounded_up(std::int64_t x) {
  constexpr int shift = Unit::frac_bits;
  constexpr std::int64_t below_one = (std::int64_t{1} << shift) - 1;
  return Length::from_raw(static_cast<std::int32_t>((x + below_one) >> shift));
}

Mass saturated_mass(UInt128 x) {
  constexpr auto most = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());
  if (x.high != 0 || x.low > most) return Mass::max();
  return Mass::from_raw(static_cast<std::int64_t>(x.low));
}

/// volume = 2hx · 2hy · 2hz; 60 + 8 fraction bits with the density, below 2^122.
Mass mass_of_box(const Vec3<Length>& half, Density density) {
  const UInt128 volume = multiply_wide(raw_of(half.x) * raw_of(half.y), 8 * raw_of(half.z));
  const UInt128 mass = multiply(volume, static_cast<std::uint32_t>(density.raw));
  return saturated_mass(round_shift(mass, 60 + Density::frac_bits - Mass::frac_bits));
}

/// volume = 2π/3 · r²(3h + 2r): two half balls and a cylinder; h = 0 is the ball.
Mass mass_of_round(Length radius, Length half_height, Density density) {
  constexpr std::uint64_t two_thirds_pi = 4829346305384748562U;  // 61 fraction bits
  const std::uint64_t heights = 3 * raw_of(half_height) + 2 * raw_of(radius);
  const UInt128 product = multiply(multiply_wide(square(raw_of(radius)), heights),
                                   static_cast<std::uint32_t>(density.raw));
  const int dropped = std::max(0, 64 - countl_zero(product));
  const UInt128 mass = multiply_wide((product >> dropped).low, two_thirds_pi);
  return saturated_mass(
      round_shift(mass, 60 + Density::frac_bits + 61 - Mass::frac_bits - dropped));
}

/// At least one step: a needle's moment about its own axis must not vanish.
Unit to_moment(std::uint64_t x) {
  return Unit::from_raw(static_cast<std::int32_t>(std::max(x, std::uint64_t{1})));
}

/// x / (divisor · 2^30), rounded, for x with 60 fraction bits.
Unit share(std::uint64_t x, std::uint64_t divisor) {
  return to_moment(round_divide(UInt128{0, x}, divisor << 30));
}

/// r and h are fractions of the scale, 30 bits. With cylinder and ball weighed 3h : 2r,
///   about the axis   r²(15h + 8r) / (10(3h + 2r))
///   across it        (20h³ + 40h²r + 45hr² + 16r³) / (20(3h + 2r)).
Vec3<Unit> capsule_inertia(std::uint64_t r, std::uint64_t h) {
  const UInt128 axial = multiply_wide(square(r), 2 * (15 * h + 8 * r));
  const UInt128 across =
      multiply_wide(square(h), 20 * h + 40 * r) + multiply_wide(square(r), 45 * h + 16 * r);
  const std::uint64_t divisor = 20 * (3 * h + 2 * r);
  const auto moment = [divisor](UInt128 numerator) {
    return to_moment(round_shift(UInt128{0, round_divide(numerator, divisor)}, 30).low);
  };
  return {moment(across), moment(axial), moment(across)};
}

}  // namespace

Length bounding_radius(const Shape& shape) {
  if (shape.kind == ShapeKind::sphere) return shape.size.x;
  if (shape.kind == ShapeKind::capsule) return shape.size.x + shape.size.y;
  const std::uint64_t squares = norm_squared(shape.size);
  const std::uint64_t root = isqrt(squares);
  return Length::from_raw(static_cast<std::int32_t>(root + (root * root < squares ? 1 : 0)));
}

Length inner_radius(const Shape& shape) {
  if (shape.kind != ShapeKind::box) return shape.size.x;
  return min(min(shape.size.x, shape.size.y), shape.size.z);
}

Vec3<Length> world_half_extents(const Shape& shape, const Mat3& rotation) {
  const auto& [x, y, z] = shape.size;
  if (shape.kind == ShapeKind::sphere) return {x, x, x};
  const bool is_capsule = shape.kind == ShapeKind::capsule;
  Vec3<Length> result;
  for (int axis = 0; axis < 3; ++axis) {
    std::int64_t extent = (abs(rotation.y[axis]) * y).raw;
    extent += is_capsule ? (Unit::from_integer(1) * x).raw
                         : (abs(rotation.x[axis]) * x + abs(rotation.z[axis]) * z).raw;
    result[axis] = rounded_up(extent);
  }
  return result;
}

Mass mass_of(const Shape& shape, Density density) {
  LKS_ASSERT(density.raw >= 0);
  LKS_ASSERT(is_primitive(shape.kind));
  if (shape.kind == ShapeKind::sphere) return mass_of_round(shape.size.x, {}, density);
  if (shape.kind == ShapeKind::capsule) {
    return mass_of_round(shape.size.x, shape.size.y, density);
  }
  return mass_of_box(shape.size, density);
}

int scale_exponent(const Shape& shape) {
  const auto radius = static_cast<std::uint32_t>(bounding_radius(shape).raw);
  return static_cast<int>(std::bit_width(radius - 1)) - Length::frac_bits;
}

Vec3<Unit> normalized_inertia(const Shape& shape) {
  // Fractions of the scale 2^k with 30 bits: exact, since the scale is at most 2^10 m.
  const int shift = 10 - scale_exponent(shape);
  const std::uint64_t x = raw_of(shape.size.x) << shift;
  const std::uint64_t y = raw_of(shape.size.y) << shift;
  const std::uint64_t z = raw_of(shape.size.z) << shift;
  if (shape.kind == ShapeKind::capsule) return capsule_inertia(x, y);
  if (shape.kind == ShapeKind::sphere) {
    const Unit moment = share(2 * square(x), 5);
    return {moment, moment, moment};
  }
  return {share(square(y) + square(z), 3), share(square(z) + square(x), 3),
          share(square(x) + square(y), 3)};
}

}  // namespace lockstone
