#include "core/dynamics/body/rest.h"

#include <algorithm>

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
  return {ticks, distance};
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

}  // namespace lockstone
