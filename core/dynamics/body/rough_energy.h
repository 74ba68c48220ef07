// Kinetic energies to a few digits: enough to see that an island has not gained any.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <lockstone/assert.h>

#include "core/dynamics/body/inertia.h"
#include "core/kernels/contact/contact_rows.h"
#include "core/math/block_float.h"

namespace lockstone {

/// A rough energy or sum of such that is at least as great may be any greater number: 2^28 m²/s².
inline constexpr std::uint64_t k_most_rough_energy = std::uint64_t{1} << 60;

/// value · 2^shift, rounded down, at most k_most_rough_energy.
[[nodiscard]] constexpr std::uint64_t rough_shift(std::uint64_t value, int shift) {
  if (value == 0 || shift <= -64) return 0;
  if (shift < 0) return std::min(value >> -shift, k_most_rough_energy);
  const int width = static_cast<int>(std::bit_width(value)) + shift;
  return width > 60 ? k_most_rough_energy : value << shift;
}

/// Twice the energy of a row, m²/s², Q32, times a mass: as from `twice_energy` and `add_energy`
/// within 2^-9 of itself and sixteen units of the mass. k_most_rough_energy also where that is
/// greater without the mass, and for a body that is 2^16 times as easy to turn about one axis as
/// about others may be.
[[nodiscard]] inline std::uint64_t rough_twice_energy(const lanes::BodyVelocity& row,
                                                      const InverseInertia& m, BlockFloat mass) {
  constexpr int k_component_bits = 28, k_inertia_bits = 30, k_most_exponent = 16;
  constexpr int k_unit_shift = 2 * lanes::k_velocity_bits - 32;
  if (m.exponent > k_most_exponent) return k_most_rough_energy;
  std::uint64_t sizes = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sizes |= magnitude(row.velocity[i]) | magnitude(row.spin[i]);
  if (sizes == 0) return 0;
  const int drop = std::max(0, static_cast<int>(std::bit_width(sizes)) - k_component_bits);
  std::array<std::int64_t, 3> spin{};
  std::int64_t moving = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t v = row.velocity[i] >> drop;
    moving += v * v;
    spin[i] = row.spin[i] >> drop;
  }
  const auto turned = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    return (x * spin[0] + y * spin[1] + z * spin[2]) >> k_inertia_bits;
  };
  const std::int64_t turning = std::max<std::int64_t>(spin[0] * turned(m.xx, m.xy, m.xz) +
                                                          spin[1] * turned(m.xy, m.yy, m.yz) +
                                                          spin[2] * turned(m.xz, m.yz, m.zz),
                                                      0);
  LKS_ASSERT(turning < std::int64_t{1} << 61 && m.exponent >= 0);
  const int coarser = std::max(0, m.exponent - 2);
  const std::uint64_t total = (static_cast<std::uint64_t>(moving) >> coarser) +
                              (static_cast<std::uint64_t>(turning) << (m.exponent - coarser));
  const int shift = coarser + 2 * drop - k_unit_shift;
  if (rough_shift(total, shift) == k_most_rough_energy) return k_most_rough_energy;
  const int excess = std::max(0, static_cast<int>(std::bit_width(total)) - 32);
  return rough_shift((total >> excess) * static_cast<std::uint64_t>(mass.mantissa),
                     shift + excess + mass.exponent);
}

}  // namespace lockstone
