// What forces give a body in a tick: a velocity in less room, for few bodies have any.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// Mantissas times 2^exponent in units of Velocity; the largest has up to 31 bits.
struct TickGain {
  Vec3<Unit>& mantissa;
  std::int8_t& exponent;
};

inline constexpr int k_most_gain_exponent = 15;

[[nodiscard]] constexpr Vec3<Velocity> read_gain(const Vec3<Unit>& mantissa, int exponent) {
  const auto value = [&](Unit x) {
    return Velocity::from_raw(std::int64_t{x.raw} * (std::int64_t{1} << exponent));
  };
  return {value(mantissa.x), value(mantissa.y), value(mantissa.z)};
}

/// Adds, each component held within ±2^12 m/s, to a relative error of 2^-31.
inline void add_gain(TickGain to, const Vec3<Velocity>& gain) {
  constexpr Velocity k_bound = Velocity::from_integer(1 << 12);
  Vec3<Velocity> sum = read_gain(to.mantissa, to.exponent);
  std::uint64_t largest = 0;
  for (int i = 0; i < 3; ++i) {
    sum[i] = clamp(sum[i] + clamp(gain[i], -k_bound, k_bound), -k_bound, k_bound);
    largest = std::max(largest, static_cast<std::uint64_t>(abs(sum[i]).raw));
  }
  const int exponent = std::max(0, static_cast<int>(std::bit_width(largest)) - 30);
  to.exponent = static_cast<std::int8_t>(exponent);
  for (int i = 0; i < 3; ++i)
    to.mantissa[i].raw = static_cast<std::int32_t>(raw::round_shift(sum[i].raw, exponent));
}

}  // namespace lockstone
