#include "core/dynamics/body/rest.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/pose_distance.h"

namespace lockstone {
namespace {

// Positions are noted to 2^-20 m and modulo 4096 m, more than any body goes in two ticks.
std::int32_t noted(Position x) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(x.raw >> 12));
}

std::int64_t difference(std::int32_t now, std::int32_t then) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) -
                                   static_cast<std::uint32_t>(then));
}

bool is_near(const BodyRecord& body, std::int64_t distance) {
  const Vec3<Length> then = body.rest_position();
  return is_within(3, distance,
                   [&](int i) { return difference(noted(body.position[i]), then[i].raw); });
}

// Turning by a small angle θ takes a point of the surface θ · 2^scale_exponent or less.
bool is_turned_little(const BodyRecord& body, std::int64_t distance) {
  constexpr std::int64_t k_whole = 1 << 30;
  const int to_half_angle = 9 - body.scale_exponent;  // Q20 to Q30, halved
  const std::int64_t limit = std::min(raw::scale_binary(distance, to_half_angle), k_whole);
  return is_turned_within(limit, body.orientation, body.rest_orientation());
}

}  // namespace

RestRules RestRules::of(std::uint32_t tick_rate, std::uint32_t milliseconds, Length distance) {
  const std::uint32_t ticks = (tick_rate * milliseconds + 999) / 1000;
  LKS_ASSERT(ticks <= 0xffff);
  return {static_cast<std::uint16_t>(ticks), distance};
}

Velocity RestRules::brake(std::uint32_t tick_rate) const {
  LKS_ASSERT(tick_rate >= 1);
  if (ticks == 0) return {};
  const std::int64_t two_distances = std::int64_t{distance.raw} << (33 - Length::frac_bits);
  return Velocity::from_raw(two_distances * tick_rate / (std::int64_t{ticks} * ticks));
}

void begin_rest(BodyRecord& body, const RestRules& rules) {
  body.rest_ticks = 0;
  if (!body.is_dynamic() || body.is_pushed()) return;
  if (!is_watched(body, rules)) return body.set_rest({}, Quat{{}, {}, {}, {}});
  Vec3<Length> place;
  for (int i = 0; i < 3; ++i)
    place[i].raw = noted(body.position[i]);
  body.set_rest(place, body.orientation);
}

void end_pushes(BodyRecord& body, const RestRules& rules) {
  body.flags = static_cast<std::uint8_t>(body.flags & ~k_body_pushed);
  begin_rest(body, rules);
}

bool count_rest(BodyRecord& body, const RestRules& rules) {
  if (!is_near(body, rules.distance.raw) || !is_turned_little(body, rules.distance.raw)) {
    begin_rest(body, rules);
  } else if (body.rest_ticks < rules.long_ticks()) {
    ++body.rest_ticks;
  }
  return body.rest_ticks >= rules.ticks;
}

bool slow_down(BodyRecord& body, const Mat3& rotation, Velocity brake) {
  LKS_ASSERT(brake >= Velocity{});
  constexpr std::int64_t k_fast = std::int64_t{1} << 28;  // 1/16 m²/s², Q32
  // Most bodies that are faster need no inertia to tell. A little more, since surface speeds are
  // rounded.
  constexpr Velocity k_faster = Velocity::from_ratio(5, 16);
  for (int i = 0; i < 3; ++i)
    if (abs(body.velocity[i]) > k_faster) return false;
  const Vec3<Velocity> surface = surface_velocity(inverse_inertia(body, rotation), body.spin);
  const std::int64_t square = energy_product(body.velocity, body.velocity, body.spin, surface);
  if (square >= k_fast) return false;
  const auto speed = static_cast<std::int64_t>(isqrt(static_cast<std::uint64_t>(square) << 32));
  const std::int32_t kept = share_of(speed - brake.raw, speed);
  for (int i = 0; i < 3; ++i) {
    body.velocity[i].raw = raw::multiply_shift(body.velocity[i].raw, kept, k_share_bits);
    body.spin[i].raw = raw::multiply_shift(body.spin[i].raw, kept, k_share_bits);
  }
  return true;
}

}  // namespace lockstone
