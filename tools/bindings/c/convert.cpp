#include "tools/bindings/c/convert.h"

namespace lockstone::c {
namespace {

CombineRule rule_of(std::uint32_t rule, std::string_view field) {
  return enumerator(rule, CombineRule::standard, CombineRule::maximum, field);
}

}  // namespace

Shape shape_of(const lks_shape& shape, std::string_view field) {
  [[maybe_unused]] static const bool linked = link_all_shapes();
  return {enumerator(shape.kind, ShapeKind::sphere, k_last_shape_kind, field),
          vec<Length>(shape.size),
          {shape.asset}};
}

Surface surface_of(const lks_surface& surface, std::string_view field) {
  return {Unit::from_raw(surface.friction),
          Unit::from_raw(surface.restitution),
          Unit::from_raw(surface.rolling_resistance),
          rule_of(surface.friction_rule, field),
          rule_of(surface.restitution_rule, field),
          rule_of(surface.rolling_rule, field),
          surface.tag};
}

Material material_of(const Surface& surface, lks_density density) {
  return {surface.friction,           surface.restitution,
          Density::from_raw(density), surface.rolling_resistance,
          surface.friction_rule,      surface.restitution_rule,
          surface.rolling_rule,       surface.tag};
}

SurfaceMotion surface_motion_of(const lks_surface_motion& motion) {
  return {vec<SolverVelocity>(motion.velocity), vec<Rate>(motion.turning)};
}

AxisLocks locks_of(std::uint32_t bits, std::string_view field) {
  check_bits(bits, 0x3f, field);
  const auto has = [&](std::uint32_t bit) { return (bits & bit) != 0; };
  return {has(LKS_LOCK_MOVE_X), has(LKS_LOCK_MOVE_Y), has(LKS_LOCK_MOVE_Z),
          has(LKS_LOCK_TURN_X), has(LKS_LOCK_TURN_Y), has(LKS_LOCK_TURN_Z)};
}

EventSettings events_of(std::uint32_t bits, lks_speed hit_speed, std::string_view field) {
  check_bits(bits, LKS_BODY_CONTACT_EVENTS | LKS_BODY_PERSIST_EVENTS, field);
  return {(bits & LKS_BODY_CONTACT_EVENTS) != 0, SolverVelocity::from_raw(hit_speed),
          (bits & LKS_BODY_PERSIST_EVENTS) != 0};
}

Frame frame_of(std::uint32_t frame) {
  return enumerator(frame, Frame::world, Frame::body, "frame");
}

lks_shape raw_of(const Shape& shape) {
  return {static_cast<std::uint32_t>(shape.kind), raw_of(shape.size), shape.asset.value};
}

lks_surface raw_of(const Surface& surface) {
  return {surface.friction.raw,
          surface.restitution.raw,
          surface.rolling_resistance.raw,
          static_cast<std::uint32_t>(surface.friction_rule),
          static_cast<std::uint32_t>(surface.restitution_rule),
          static_cast<std::uint32_t>(surface.rolling_rule),
          surface.tag};
}

std::uint32_t raw_of(const AxisLocks& locks) {
  const bool bits[] = {locks.move_x, locks.move_y, locks.move_z,
                       locks.turn_x, locks.turn_y, locks.turn_z};
  std::uint32_t result = 0;
  for (std::uint32_t i = 0; i < 6; ++i)
    result |= static_cast<std::uint32_t>(bits[i]) << i;
  return result;
}

std::uint32_t raw_of(const EventSettings& events) {
  std::uint32_t bits = 0;
  if (events.contacts) bits |= LKS_BODY_CONTACT_EVENTS;
  if (events.persist) bits |= LKS_BODY_PERSIST_EVENTS;
  return bits;
}

Vec3<Position> place_of(const lks_position3* place, std::string_view field) {
  const auto result = vec<Position>(required(place, field));
  for (int i = 0; i < 3; ++i) {
    if (result[i] > k_world_limit || result[i] < -k_world_limit)
      throw_invalid(field, "must be within ±1048576 m");
  }
  return result;
}

}  // namespace lockstone::c
