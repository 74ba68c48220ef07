// Coulomb's limit of a contact's three rows of friction, in units of a phase.
#pragma once

#include <algorithm>
#include <cstdint>

#include <lockstone/fixed.h>

#include "core/math/roots.h"
#include "core/math/wide/proximal_block.h"

namespace lockstone::lanes {

/// μ·Σλ of the points in units of the tangents, at most k_most_unit.
[[nodiscard]] inline std::int64_t friction_limit(const ProximalBlock& block,
                                                 const BlockWord& impulses) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < block.points; ++i)
    sum += raw::round_shift(impulses[i] * block.limits[i], k_friction_point);
  return std::min(sum, k_most_unit);
}

/// The size of friction, squared, < 2^63.
[[nodiscard]] inline std::uint64_t friction_size(const ProximalBlock& block,
                                                 const BlockWord& impulses) {
  std::uint64_t square = 0;
  for (std::size_t i = block.points; i < block.rows; ++i) {
    std::int64_t x = impulses[i];
    if (i == block.points + 2)
      x = std::clamp(raw::round_shift(x * block.twist_ratio, k_friction_point), -k_most_unit,
                     k_most_unit);
    square += static_cast<std::uint64_t>(x * x);
  }
  return square;
}

/// Shortens friction to its limit. Returns how much it was longer.
inline std::int64_t shorten_friction(const ProximalBlock& block, BlockWord& impulses) {
  const std::int64_t limit = friction_limit(block, impulses);
  const std::uint64_t square = friction_size(block, impulses);
  if (square <= static_cast<std::uint64_t>(limit * limit)) return 0;
  const auto size = static_cast<std::int64_t>(isqrt_rounded(square));
  const std::int64_t part = (limit << 31) / std::max<std::int64_t>(size, 1);
  for (std::size_t i = block.points; i < block.rows; ++i)
    impulses[i] = raw::round_shift(impulses[i] * part, 31);
  return std::max<std::int64_t>(size - limit, 1);
}

}  // namespace lockstone::lanes
