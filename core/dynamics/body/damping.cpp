#include "core/dynamics/body/damping.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/math/exponential.h"

namespace lockstone {
namespace {

constexpr std::int64_t k_full = std::int64_t{1} << 30;  // 1

std::int64_t times_q30(std::int64_t x, std::int64_t y) {
  return raw::round_shift(x * y, 30);
}

// ½ − z/6 + z²/24 − …, for z below ¼; the series is cut off with an error below z⁷/9!.
std::int64_t mean_of_small(std::int64_t z) {
  std::int64_t sum = 0;
  for (std::int64_t n = 8; n >= 2; --n)
    sum = raw::round_divide(k_full - times_q30(z, sum), n);
  return sum;
}

}  // namespace

Damping Damping::of(Rate rate, const TimeStep& step) {
  if (rate.raw <= 0) return {};
  // Q40, below 2^48
  const std::int64_t wide = raw::round_divide(std::int64_t{rate.raw} << 20, step.tick_rate);
  const std::int64_t z = raw::round_shift(wide, 10);
  LKS_ASSERT(z >= 0);
  if (z < k_full / 4) {
    const std::int64_t mean = mean_of_small(z), ease = k_full - times_q30(z, mean);
    return {static_cast<std::int32_t>(k_full - times_q30(z, ease)), static_cast<std::int32_t>(ease),
            static_cast<std::int32_t>(mean)};
  }
  // e^-z = 2^(-z/ln 2); 1/ln 2 in Q30. Beyond 31 nothing is left.
  constexpr std::int64_t k_per_ln_2 = 1549082005;
  const std::int64_t bounded = std::min(z, 22 * k_full);
  const std::int64_t power = raw::round_shift(bounded, 4) * k_per_ln_2;           // Q56
  const auto exponent = static_cast<std::int32_t>(-raw::round_shift(power, 30));  // Q26
  const auto keep = static_cast<std::int64_t>(exp2_raw(exponent, 26, 30));
  const std::int64_t ease = raw::round_divide((k_full - keep) << 30, z);
  LKS_ASSERT(keep >= 0 && keep <= k_full);
  const std::int64_t mean = raw::round_divide((k_full - ease) << 30, z);
  return {static_cast<std::int32_t>(keep), static_cast<std::int32_t>(ease),
          static_cast<std::int32_t>(mean)};
}

}  // namespace lockstone
