// The cone of friction, one contact at a time.
#pragma once

#include <cstdint>

#include <lockstone/fixed.h>

#include "core/math/roots.h"

namespace lockstone::lanes {

/// x / y, the quotient's size rounded up from where its fraction exceeds ½ − dither, Q30. |x| ≤
/// 2^60, 0 < y < 2^32, |dither| ≤ 2^29.
inline std::int64_t divide_dithered(std::int64_t x, std::int64_t y, std::int32_t dither) {
  const auto divisor = static_cast<std::uint64_t>(y);
  const auto threshold = static_cast<std::uint64_t>((std::int64_t{1} << 29) + dither);
  const auto size =
      static_cast<std::int64_t>((magnitude(x) + (divisor * threshold >> 30)) / divisor);
  return x < 0 ? -size : size;
}

/// Shortens the vector of three to `limit` when it is longer. |each| ≤ 2^30, 0 ≤ limit ≤ 2^30; of
/// all words only the lower half counts. `dither`: as for `divide_dithered`.
inline void shorten_friction(std::int64_t limit_word, std::int32_t dither, std::int64_t& t,
                             std::int64_t& b, std::int64_t& twist) {
  const auto limit = static_cast<std::int32_t>(limit_word);
  std::int64_t* const parts[] = {&t, &b, &twist};
  std::uint64_t size = 0;
  for (std::int64_t* part : parts) {
    *part = static_cast<std::int32_t>(*part);
    size += static_cast<std::uint64_t>(*part * *part);
  }
  const auto most = static_cast<std::uint64_t>(std::int64_t{limit} * limit);
  if (size <= most) return;
  const auto length = static_cast<std::int64_t>(isqrt_rounded(size));  // ≥ 1
  for (std::int64_t* part : parts)
    *part = limit == 0 ? 0 : divide_dithered(*part * limit, length, dither);
}

}  // namespace lockstone::lanes
