// Checks and writes that several commands share.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/body.h>
#include <lockstone/command.h>
#include <lockstone/transform.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/limits.h"

namespace lockstone {

/// ω·2^exponent in m/s, the speed of the surface; false beyond the speed limit.
[[nodiscard]] bool to_surface_velocity(const Vec3<AngularVelocity>& omega, int exponent,
                                       Vec3<Velocity>& w);

[[nodiscard]] constexpr bool is_valid(const SpeedLimit& limit) {
  return limit.linear > Velocity{} && limit.angular > AngularVelocity{};
}

/// The velocities that take a body to a pose in one tick; false beyond the speed limit.
[[nodiscard]] bool motion_to(const BodyRecord& body, const Transform& target, int tick_rate,
                             Vec3<Velocity>& velocity, Vec3<Velocity>& spin);

/// The mass of a body's solid, kg: the asset's or the primitive shape's volume times its density.
[[nodiscard]] Mass mass_of(const BodyDef& def, const Asset* asset);

/// BodyLock bits.
[[nodiscard]] std::uint8_t locks_of(const AxisLocks& locks);
[[nodiscard]] AxisLocks axis_locks(std::uint8_t bits);

void set_events(BodyRecord& record, const EventSettings& settings);

/// Limits beyond the formats are clamped to them. The scale exponent must be known.
void set_speed_limit(BodyRecord& record, const SpeedLimit& limit);

/// Of the shape's frame, which the asset may place away from the body's.
void set_surface_motion(BodyRecord& record, const Asset* asset, const SurfaceMotion& motion);

}  // namespace lockstone
