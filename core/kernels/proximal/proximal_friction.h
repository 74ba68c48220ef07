// Coulomb's limit of a contact's three rows of friction, in units of a phase.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lockstone/fixed.h>

#include "core/kernels/proximal/proximal_block.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::lanes {

/// μ·Σλ of the points in units of the tangents, at most k_most_unit.
[[nodiscard]] inline std::int64_t friction_limit(const ProximalBlock& block,
                                                 const BlockWord& impulses) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < block.points; ++i)
    sum += raw::round_shift(impulses[i] * block.limits[i], k_friction_point);
  return std::min(sum, k_most_unit);
}

/// The twist's impulse in units of the tangents.
[[nodiscard]] inline std::int64_t twist_in_tangents(const ProximalBlock& block,
                                                    const BlockWord& impulses) {
  if (block.rows < block.points + 3) return 0;
  return raw::round_shift(impulses[block.points + 2] * block.twist_ratio, k_friction_point);
}

/// The size of friction, squared, < 2^63; where the twist alone is beyond every limit, only that
/// much of it counts.
[[nodiscard]] inline std::uint64_t friction_size(const ProximalBlock& block,
                                                 const BlockWord& impulses) {
  const std::int64_t twist =
      std::clamp(twist_in_tangents(block, impulses), -k_most_unit - 1, k_most_unit + 1);
  const std::int64_t t = impulses[block.points], b = impulses[block.points + 1];
  return static_cast<std::uint64_t>(t * t) + static_cast<std::uint64_t>(b * b) +
         static_cast<std::uint64_t>(twist * twist);
}

/// The size of friction, however great: < 2^42.
[[nodiscard]] inline std::int64_t friction_length(const ProximalBlock& block,
                                                  const BlockWord& impulses) {
  const std::int64_t twist = twist_in_tangents(block, impulses);
  if (magnitude(twist) <= magnitude(k_most_unit))
    return static_cast<std::int64_t>(isqrt_rounded(friction_size(block, impulses)));
  UInt128 sum = multiply_wide(magnitude(twist), magnitude(twist));
  for (const std::size_t i : {block.points, block.points + 1})
    sum = sum + multiply_wide(magnitude(impulses[i]), magnitude(impulses[i]));
  return static_cast<std::int64_t>(isqrt128_rounded(sum));
}

/// Shortens friction to its limit. Returns how much it was longer.
inline std::int64_t shorten_friction(const ProximalBlock& block, BlockWord& impulses) {
  const std::int64_t limit = friction_limit(block, impulses);
  const std::uint64_t square = friction_size(block, impulses);
  if (square <= static_cast<std::uint64_t>(limit * limit)) return 0;
  const std::int64_t size = friction_length(block, impulses);
  const std::int64_t part = (limit << 31) / std::max<std::int64_t>(size, 1);
  for (std::size_t i = block.points; i < block.rows; ++i)
    impulses[i] = raw::round_shift(impulses[i] * part, 31);
  return std::max<std::int64_t>(size - limit, 1);
}

}  // namespace lockstone::lanes
