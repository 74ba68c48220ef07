// Ranges and units that the parts of the joint solver share.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lockstone/assert.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/kernels/contact/contact_rows.h"
#include "core/math/product_sum.h"

namespace lockstone {

inline constexpr std::int64_t k_one = std::int64_t{1} << 30;

/// Velocities of a substep stay within 2048 m/s, Q50: sums of products do.
inline constexpr std::int64_t k_row_bound = k_product_bound;

/// Openings are closed no faster than this, m/s, Q50; limits are pushed back at half of it.
inline constexpr std::int64_t k_close_speed = std::int64_t{8} << 50;

[[nodiscard]] constexpr std::int64_t bounded(std::int64_t x, std::int64_t bound) {
  LKS_ASSERT(bound >= 0);
  return std::clamp(x, -bound, bound);
}

/// The same as the way in a second, m, Q32.
inline constexpr std::int64_t k_close_way = std::int64_t{8} << 32;

/// Whether both bodies move alike; std::array's comparison calls memcmp.
[[nodiscard]] inline bool is_alike(const lanes::BodyVelocity& a, const lanes::BodyVelocity& b) {
  std::int64_t differs = 0;
  for (std::size_t i = 0; i < 3; ++i)
    differs |= (a.velocity[i] ^ b.velocity[i]) | (a.spin[i] ^ b.spin[i]);
  return differs == 0;
}

/// |x| + |y| + |z|, Q20
[[nodiscard]] constexpr std::int64_t size_of(const Vec3<Length>& v) {
  const auto size = [](Length x) { return std::int64_t{x.raw < 0 ? -std::int64_t{x.raw} : x.raw}; };
  return size(v.x) + size(v.y) + size(v.z);
}

/// The speed that closes an error (m, Q32) in a substep, or in 2^shift of them: m/s, Q50, within
/// ±k_row_bound.
[[nodiscard]] constexpr std::int64_t closing_speed(std::int64_t error, std::int64_t rate,
                                                   int shift = 0) {
  LKS_ASSERT(rate > 0 && shift >= 0);
  return product_rounded(error, rate << 21, 3 + shift);  // shifts from 3 on are faster
}

}  // namespace lockstone
