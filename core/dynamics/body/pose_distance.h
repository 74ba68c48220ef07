// How far a body is from a pose that was noted.
#pragma once

#include <cstdint>

#include <lockstone/quat.h>

namespace lockstone {

/// Σ difference(i)² ≤ bound², i below `count`: of differences that may be anything, 0 ≤ bound ≤
/// 2^30.
template <class Difference>
[[nodiscard]] bool is_within(int count, std::int64_t bound, Difference&& difference) {
  std::int64_t sum = 0;
  for (int i = 0; i < count; ++i) {
    const std::int64_t x = difference(i);
    if (x > bound || x < -bound) return false;
    sum += x * x;
  }
  return sum <= bound * bound;
}

/// Whether the components of two orientations are within that of each other, Q30. Turning by a
/// small angle θ changes them by θ/2.
[[nodiscard]] inline bool is_turned_within(std::int64_t bound, const Quat& now, const Quat& then) {
  const std::int64_t differences[] = {
      std::int64_t{now.x.raw} - then.x.raw, std::int64_t{now.y.raw} - then.y.raw,
      std::int64_t{now.z.raw} - then.z.raw, std::int64_t{now.w.raw} - then.w.raw};
  return is_within(4, bound, [&](int i) { return differences[i]; });
}

}  // namespace lockstone
