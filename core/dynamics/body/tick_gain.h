// The velocity and spin that forces give a body in a tick. Few bodies have any, so they are packed
// into the body's union: mantissas times 2^exponent in units of Velocity.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

#include <lockstone/assert.h>

#include "core/dynamics/state/body_record.h"

namespace lockstone {

/// Of velocity and of spin.
struct TickGain {
  Vec3<Velocity> velocity{};
  Vec3<Velocity> spin{};
};

/// Of each component: enough to turn the greatest velocity round.
inline constexpr Velocity k_most_gain = Velocity::from_raw(2 * k_speed_limit.raw);

inline constexpr int k_most_gain_exponent = 15;
inline constexpr int k_gain_exponent_bits = 4;

[[nodiscard]] constexpr Vec3<Velocity> read_gain(const Vec3<Unit>& mantissa, int exponent) {
  const auto value = [&](Unit x) {
    return Velocity::from_raw(std::int64_t{x.raw} * (std::int64_t{1} << exponent));
  };
  return {value(mantissa.x), value(mantissa.y), value(mantissa.z)};
}

[[nodiscard]] inline TickGain tick_gain_of(const BodyRecord& body) {
  if (!body.is_pushed()) return {};
  const std::int32_t exponents = body.union_c.raw;
  return {read_gain(body.union_a, exponents & k_most_gain_exponent),
          read_gain(body.union_b, exponents >> k_gain_exponent_bits & k_most_gain_exponent)};
}

/// Returns the exponent. The largest mantissa has up to 30 bits.
inline int write_gain(const Vec3<Velocity>& gain, Vec3<Unit>& mantissa) {
  std::uint64_t largest = 0;
  for (int i = 0; i < 3; ++i)
    largest = std::max(largest, static_cast<std::uint64_t>(abs(gain[i]).raw));
  const int exponent = std::max(0, static_cast<int>(std::bit_width(largest)) - 30);
  LKS_ASSERT(exponent <= k_most_gain_exponent);
  for (int i = 0; i < 3; ++i)
    mantissa[i].raw = static_cast<std::int32_t>(raw::round_shift(gain[i].raw, exponent));
  return exponent;
}

/// Adds, each component clamped to ±k_most_gain, to a relative error of 2^-30.
inline void add_gain(BodyRecord& body, const TickGain& gain) {
  TickGain sum = tick_gain_of(body);
  const auto add = [&](Velocity& to, Velocity x) {
    to = clamp(to + clamp(x, -k_most_gain, k_most_gain), -k_most_gain, k_most_gain);
  };
  for (int i = 0; i < 3; ++i) {
    add(sum.velocity[i], gain.velocity[i]);
    add(sum.spin[i], gain.spin[i]);
  }
  const int exponent = write_gain(sum.velocity, body.union_a);
  LKS_ASSERT(exponent >= 0 && exponent <= k_most_gain_exponent);
  body.union_c.raw = exponent | write_gain(sum.spin, body.union_b) << k_gain_exponent_bits;
  body.flags = static_cast<std::uint8_t>(body.flags | k_body_pushed);
  body.rest_ticks = body.still_ticks = 0;
}

}  // namespace lockstone
