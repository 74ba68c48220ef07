// Ranges that commands, world definitions and snapshots all keep to.
#pragma once

#include <cstddef>
#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/assets/asset_frame.h"

namespace lockstone {

/// 2^10 m holds every asset: the scale of bodies that never move.
inline constexpr int k_largest_scale_exponent = 10;

inline constexpr Number k_gravity_scale_limit = Number::from_integer(100);

/// EventSettings::hit_speed.
inline constexpr SolverVelocity k_most_hit_speed = SolverVelocity::from_integer(500);
[[nodiscard]] constexpr bool is_hit_speed(SolverVelocity speed) {
  return speed >= SolverVelocity{} && speed <= k_most_hit_speed;
}

/// The contacts that one tick can tell hits of: many more than bodies have fast impacts at once.
/// Where there are more, the last ones are left out.
[[nodiscard]] constexpr std::size_t most_hits(std::size_t body_capacity) {
  return 2 * body_capacity;
}

/// The last generation of a slot. When its object is gone the slot is never used again: a handle
/// never names two objects.
inline constexpr std::uint32_t k_last_generation = 0xfffffffe;

/// Whether a slot that was ever used may have it.
[[nodiscard]] constexpr bool is_generation(std::uint32_t generation) {
  return generation != 0 && generation <= k_last_generation;
}

/// Whether an object may be made in the slot.
template <class Record>
[[nodiscard]] bool is_free(const Record& slot) {
  return !slot.exists() && slot.generation < k_last_generation;
}

/// Of any bits from outside: the least number has no magnitude.
template <class T>
[[nodiscard]] constexpr bool is_within(T x, T limit) {
  return x <= limit && x >= -limit;
}
template <class T>
[[nodiscard]] constexpr bool is_within(const Vec3<T>& v, T limit) {
  return is_within(v.x, limit) && is_within(v.y, limit) && is_within(v.z, limit);
}

/// At most 1000 m/s² an axis: far above any game, and g·dt stays a small part of the speed limit.
[[nodiscard]] constexpr bool is_valid_gravity(const Vec3<Acceleration>& g) {
  return is_within(g, Acceleration::from_integer(1000));
}

/// A surface's own speed: 500 m/s and 500 rad/s an axis.
[[nodiscard]] constexpr bool is_valid(const Vec3<SolverVelocity>& velocity,
                                      const Vec3<Rate>& turning) {
  constexpr std::int32_t k_limit = 500 << 20;
  const auto within = [](std::int32_t x) { return x <= k_limit && x >= -k_limit; };
  return within(velocity.x.raw) && within(velocity.y.raw) && within(velocity.z.raw) &&
         within(turning.x.raw) && within(turning.y.raw) && within(turning.z.raw);
}

}  // namespace lockstone
