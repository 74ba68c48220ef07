// Sums of kinetic energies, and velocities between two others that have less.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include <lockstone/assert.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/dynamics/body/inertia.h"
#include "core/math/block_float.h"
#include "core/math/product_sum.h"
#include "core/math/roots.h"

namespace lockstone {

/// Shares have this many fraction bits.
inline constexpr int k_share_bits = 30;

/// u·v + s·t of velocities, and of a spin with a surface velocity: m²/s², Q32. Twice the kinetic
/// energy for each mass, where u is v and t is M·s.
[[nodiscard]] inline std::int64_t energy_product(const Vec3<Velocity>& u, const Vec3<Velocity>& v,
                                                 const Vec3<Velocity>& s, const Vec3<Velocity>& t) {
  ProductSum sum;
  for (int i = 0; i < 3; ++i) {
    sum.add(u[i].raw, v[i].raw);
    sum.add(s[i].raw, t[i].raw);
  }
  return sum.rounded(32);
}

/// Twice the kinetic energy for each mass: m²/s², Q32.
[[nodiscard]] inline std::int64_t twice_energy(const Vec3<Velocity>& velocity,
                                               const Vec3<Velocity>& spin,
                                               const InverseInertia& inertia) {
  return energy_product(velocity, velocity, spin, surface_velocity(inertia, spin));
}

/// a / b
[[nodiscard]] inline BlockFloat quotient(BlockFloat a, BlockFloat b) {
  LKS_ASSERT(a.mantissa > 0 && b.mantissa > 0);
  const auto dividend = static_cast<std::uint64_t>(a.mantissa) << 31;
  return block_float(dividend / static_cast<std::uint64_t>(b.mantissa),
                     a.exponent - b.exponent - 31);
}

/// Adds the energy of a body for each mass, times its mass, within 64 bits.
inline void add_energy(std::int64_t& sum, std::int64_t each, BlockFloat mass) {
  const int right = -mass.exponent;
  const bool fits = magnitude(each) >> 60 == 0 && right >= 30 && right <= 60;  // times less than 2
  sum = raw::saturating_add(
      sum, fits ? product_rounded(each, mass.mantissa, right) : scale_saturating(each, mass, 0));
}

/// The energy s²·square + s·linear that a share s (Q30) of a change of velocity adds.
[[nodiscard]] inline std::int64_t energy_of_share(std::int64_t square, std::int64_t linear,
                                                  std::int32_t share) {
  LKS_ASSERT(share >= 0 && share <= 1 << k_share_bits);
  const std::int64_t inner =
      raw::saturating_add(product_rounded(square, share, k_share_bits), linear);
  return product_rounded(inner, share, k_share_bits);
}

/// The greatest share below one that adds no more than `allowed`, to 2^-20; zero if none does.
[[nodiscard]] inline std::int32_t greatest_share(std::int64_t square, std::int64_t linear,
                                                 std::int64_t allowed) {
  constexpr int k_shares_tried = 20;
  std::int32_t share = 0;
  for (int bit = k_share_bits - 1; bit >= k_share_bits - k_shares_tried; --bit) {
    const std::int32_t tried = share | std::int32_t{1} << bit;
    if (energy_of_share(square, linear, tried) <= allowed) share = tried;
  }
  return share;
}

/// part / whole, Q32, within 2^-30: zero … one.
[[nodiscard]] inline std::uint64_t share_q32(std::int64_t part, std::int64_t whole) {
  if (part <= 0) return 0;
  if (part >= whole) return std::uint64_t{1} << 32;
  const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(whole)));
  const int excess = std::max(0, width - 31);
  return (static_cast<std::uint64_t>(part >> excess) << 32) /
         static_cast<std::uint64_t>(whole >> excess);
}

/// The same as a share.
[[nodiscard]] inline std::int32_t share_of(std::int64_t part, std::int64_t whole) {
  return static_cast<std::int32_t>(share_q32(part, whole) >> (32 - k_share_bits));
}

/// Its square root.
[[nodiscard]] inline std::int32_t root_of_share(std::int64_t part, std::int64_t whole) {
  return static_cast<std::int32_t>(isqrt(share_q32(part, whole) << (2 * k_share_bits - 32)));
}

}  // namespace lockstone
