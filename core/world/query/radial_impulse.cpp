#include <array>

#include <lockstone/assert.h>
#include <lockstone/radial_impulse.h>
#include <lockstone/vector_math.h>

#include "core/math/divide.h"

namespace lockstone {
namespace {

ClosestHit nearest_point(const World& world, const RadialImpulse& def, BodyHandle body) {
  QueryFilter only = def.filter;
  only.accept = [](void* wanted, BodyHandle each) {
    return each == *static_cast<const BodyHandle*>(wanted);
  };
  only.context = &body;
  return world.closest_point(def.centre, def.radius, only);
}

bool is_shielded(const World& world, const RadialImpulse& def, const ClosestHit& nearest) {
  if (def.obstacle_mask == 0) return false;
  Vec3<Length> way;
  for (int i = 0; i < 3; ++i)
    way[i] = saturated<Length>(nearest.point[i] - def.centre[i]);
  return world.is_ray_blocked(def.centre, way, {.mask = def.obstacle_mask, .ignore = nearest.body});
}

Unit factor_at(const RadialImpulse& def, Length distance) {
  constexpr Unit k_one = Unit::from_integer(1);
  if (def.falloff == Falloff::constant) return k_one;
  const Unit linear = divide_saturating<Unit>(def.radius - min(distance, def.radius), def.radius);
  return def.falloff == Falloff::linear ? linear : rounded<Unit>(linear * linear);
}

// Upwards where there is no direction.
Vec3<Unit> direction_to(const Vec3<Position>& centre, const Vec3<Position>& body) {
  const Vec3<Position> way = body - centre;
  if (way == Vec3<Position>{}) return {{}, Unit::from_integer(1), {}};
  return normalized(way);
}

}  // namespace

std::string_view to_string(Falloff falloff) {
  constexpr std::string_view k_names[] = {"constant", "linear", "quadratic"};
  const auto index = static_cast<std::size_t>(falloff);
  return index < std::size(k_names) ? k_names[index] : "unknown";
}

std::size_t radial_impulse(const World& world, const RadialImpulse& def,
                           std::span<ApplyImpulse> out) {
  if (def.radius <= Length{} || def.radius > k_max_cast)
    misused("radial_impulse: `radius` must be above 0 and at most k_max_cast, 512 m");
  std::array<BodyHandle, k_most_radial_impulses> found{};
  const std::size_t count = world.overlap_sphere(def.centre, def.radius, found, def.filter);
  std::size_t written = 0;
  for (const BodyHandle body : std::span(found).first(count)) {
    if (written == out.size()) break;
    const BodyView view = world.body(body);
    if (view.motion != MotionType::dynamic) continue;
    const ClosestHit nearest = nearest_point(world, def, body);
    if (nearest.body.is_null() || is_shielded(world, def, nearest)) continue;
    const Unit factor = factor_at(def, nearest.distance);
    const Vec3<Unit> direction = direction_to(def.centre, view.centre_of_mass);
    ApplyImpulse command{body, {}, Frame::world};
    for (int i = 0; i < 3; ++i) {
      const Unit part = rounded<Unit>(direction[i] * factor);
      command.impulse[i].raw = raw::multiply_shift(def.impulse.raw, part.raw, Unit::frac_bits);
    }
    out[written++] = command;
  }
  return written;
}

}  // namespace lockstone
