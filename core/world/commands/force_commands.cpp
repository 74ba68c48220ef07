// Commands that push: impulses at once, forces and torques over the coming tick.

#include <algorithm>

#include "core/dynamics/body/motion.h"
#include "core/dynamics/body/tick_gain.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/math/block_float.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/command_executor.h"
#include "core/world/derived/quantities.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// J/m as a velocity.
Vec3<Velocity> velocity_gain(const BodyRecord& body, const Vec3<Impulse>& impulse) {
  const auto gain = [&](Impulse j) {
    return multiply_saturating<Velocity>(j, body.inverse_mass_value());
  };
  return {gain(impulse.x), gain(impulse.y), gain(impulse.z)};
}

// Adds a gain of any size to a velocity within ±2^13 m/s.
void add_velocity(Vec3<Velocity>& velocity, const Vec3<Velocity>& gain) {
  constexpr Velocity k_bound = Velocity::from_integer(1 << 12);
  for (int i = 0; i < 3; ++i)
    velocity[i] += clamp(gain[i], -k_bound, k_bound);
}

// (r/s) × gain, with r/s in Q30.
Vec3<Velocity> turning_gain(const BodyRecord& body, const Vec3<Length>& point,
                            const Vec3<Velocity>& gain) {
  constexpr Velocity k_bound = Velocity::from_integer(1 << 12);
  const auto product = [&](Velocity v, Length arm) {
    const std::int32_t arm_q30 =
        raw::saturate<std::int32_t>(std::int64_t{arm.raw} << (10 - body.scale_exponent));
    return Velocity::from_raw(raw::multiply_shift(clamp(v, -k_bound, k_bound).raw, arm_q30, 30));
  };
  return {product(gain.z, point.y) - product(gain.y, point.z),
          product(gain.x, point.z) - product(gain.z, point.x),
          product(gain.y, point.x) - product(gain.x, point.y)};
}

// L/(m·2^k) as spin.
Vec3<Velocity> spin_gain(const BodyRecord& body, const Vec3<AngularImpulse>& impulse) {
  const int shift = Velocity::frac_bits - AngularImpulse::frac_bits - body.scale_exponent;
  const auto gain = [&](AngularImpulse l) {
    return Velocity::from_raw(scale_saturating(l.raw, body.inverse_mass_value(), shift));
  };
  return {gain(impulse.x), gain(impulse.y), gain(impulse.z)};
}

// Over one tick a force is the impulse F·dt: Q20 to Q24, divided by the tick rate.
template <class To, class From>
Vec3<To> over_a_tick(const Vec3<From>& force, int tick_rate) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 56;
  const auto impulse = [&](From f) {
    return To::from_raw(raw::round_divide(std::clamp(f.raw, -k_bound, k_bound) * 16, tick_rate));
  };
  return {impulse(force.x), impulse(force.y), impulse(force.z)};
}

// A vector of 64 bits along world axes; clamped to 2^60.
template <class T>
Vec3<T> turned(const Mat3& rotation, const Vec3<T>& v) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 60;
  Vec3<Velocity> words;
  for (int i = 0; i < 3; ++i)
    words[i].raw = std::clamp(v[i].raw, -k_bound, k_bound);
  words = rotate_wide(rotation, words);
  return {T::from_raw(words.x.raw), T::from_raw(words.y.raw), T::from_raw(words.z.raw)};
}

}  // namespace

// The gains of an impulse, without a point at the centre of mass; gains along locked axes are
// removed.
Status gain_of(const WorldData& world, BodyHandle body, const Push& push, TickGain& gain) {
  const BodyRecord* record = world.find(body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->is_dynamic() || push.frame > Frame::body) return Status::invalid_argument;
  const geometry::AssetGeometry* asset = world.cache.asset(body.index);
  Vec3<Impulse> impulse = push.impulse;
  Vec3<AngularImpulse> turn = push.turn;
  Vec3<Length> point = push.point != nullptr ? *push.point : Vec3<Length>{};
  if (push.frame == Frame::body) {
    const PlacedShape shape = world.placed(body.index);
    impulse = turned(shape.rotation, impulse);
    turn = turned(shape.rotation, turn);
    if (push.point != nullptr) {
      const Vec3<Position> at = shape.origin + rotate(shape.rotation, rounded<Position>(point));
      point = saturated<Length>(at - record->position);
    }
  }
  const Length radius = properties_of(record->shape(), asset).radius;
  const Length reach = Length::from_raw(raw::saturate<std::int32_t>(std::int64_t{2} * radius.raw));
  if (!is_within(point, reach)) return Status::invalid_argument;
  gain.velocity = velocity_gain(*record, impulse);
  gain.spin = turning_gain(*record, point, gain.velocity);
  add_velocity(gain.spin, spin_gain(*record, turn));
  for (int i = 0; i < 3; ++i) {
    if (record->is_locked(i)) gain.velocity[i] = {};
    if (record->is_turn_locked(i)) gain.spin[i] = {};
  }
  return Status::ok;
}

Status CommandExecutor::push_now(BodyHandle body, const Push& push) {
  TickGain gain;
  if (const Status status = gain_of(world_, body, push, gain); status != Status::ok) return status;
  if (gain.velocity == Vec3<Velocity>{} && gain.spin == Vec3<Velocity>{}) return Status::ok;
  world_.waking.wake(body.index);
  BodyRecord& record = *world_.edit(body);
  add_velocity(record.velocity, gain.velocity);
  add_velocity(record.spin, gain.spin);
  clamp_speed(record.velocity);
  clamp_speed(record.spin);
  world_.refresh(body.index);
  return Status::ok;
}

Status CommandExecutor::push_in_tick(BodyHandle body, const Push& push) {
  TickGain gain;
  if (const Status status = gain_of(world_, body, push, gain); status != Status::ok) return status;
  if (!is_enabled(world_.bodies[body.index])) return Status::invalid_argument;
  if (gain.velocity == Vec3<Velocity>{} && gain.spin == Vec3<Velocity>{}) return Status::ok;
  world_.waking.wake(body.index);
  add_gain(*world_.edit(body), gain);
  return Status::ok;
}

Status CommandExecutor::execute(const ApplyImpulse& command) {
  return push_now(command.body, {command.impulse, {}, nullptr, command.frame});
}

Status CommandExecutor::execute(const ApplyImpulseAt& command) {
  return push_now(command.body, {command.impulse, {}, &command.point, command.frame});
}

Status CommandExecutor::execute(const ApplyAngularImpulse& command) {
  return push_now(command.body, {{}, command.impulse, nullptr, command.frame});
}

Status CommandExecutor::execute(const ApplyForce& command) {
  const auto impulse = over_a_tick<Impulse>(command.force, world_.def.tick_rate);
  return push_in_tick(command.body, {impulse, {}, nullptr, command.frame});
}

Status CommandExecutor::execute(const ApplyForceAt& command) {
  const auto impulse = over_a_tick<Impulse>(command.force, world_.def.tick_rate);
  return push_in_tick(command.body, {impulse, {}, &command.point, command.frame});
}

Status CommandExecutor::execute(const ApplyTorque& command) {
  const auto turn = over_a_tick<AngularImpulse>(command.torque, world_.def.tick_rate);
  return push_in_tick(command.body, {{}, turn, nullptr, command.frame});
}

}  // namespace lockstone
