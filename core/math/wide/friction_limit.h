// The cone of friction, one contact at a time.
#pragma once

#include <cstdint>

#include <lockstone/fixed.h>

#include "core/math/roots.h"

namespace lockstone::lanes {

/// Shortens the vector of three to `limit` when it is longer. |each| ≤ 2^30, 0 ≤ limit ≤ 2^30; of
/// all words only the lower half counts.
inline void shorten_friction(std::int64_t limit_word, std::int64_t& t, std::int64_t& b,
                             std::int64_t& twist) {
  const auto limit = static_cast<std::int32_t>(limit_word);
  std::int64_t* const parts[] = {&t, &b, &twist};
  std::uint64_t size = 0;
  for (std::int64_t* part : parts) {
    *part = static_cast<std::int32_t>(*part);
    size += static_cast<std::uint64_t>(*part * *part);
  }
  const auto most = static_cast<std::uint64_t>(std::int64_t{limit} * limit);
  if (size <= most) return;
  const auto length = static_cast<std::int64_t>(isqrt(size));  // ≥ 1
  for (std::int64_t* part : parts)
    *part = limit == 0 ? 0 : raw::round_divide(*part * limit, length);
}

}  // namespace lockstone::lanes
