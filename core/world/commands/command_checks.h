// Checks and writes that several commands share.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/body.h>
#include <lockstone/command.h>
#include <lockstone/transform.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/limits.h"
#include "core/world/derived/quantities.h"

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

/// The asset that a shape names; null without error for a shape that names none.
[[nodiscard]] Result<const Asset*> asset_of(const Shape& shape, const AssetSet& assets);

/// The mass of a solid, kg: the asset's or the primitive shape's volume times the density.
[[nodiscard]] Mass mass_of(const Shape& shape, const geometry::AssetGeometry* asset,
                           Density density);
/// The one that the definition gives, or that of its solid.
[[nodiscard]] Mass mass_of(const BodyDef& def, const geometry::AssetGeometry* asset);

/// Of a dynamic body.
[[nodiscard]] constexpr bool is_body_mass(Mass mass) {
  return mass >= k_min_mass && mass <= k_max_mass;
}
/// Whether a body of this scale may have such a mass, not 0, and such moments.
[[nodiscard]] bool has_valid_mass_data(const MassData& data, int scale_exponent);

/// Scale and moments of a body's solid.
void set_solid(BodyRecord& record, const ShapeProperties& properties);
/// Of a dynamic body; without moments those of `set_solid` stay.
void set_mass_data(BodyRecord& record, const MassData& data);

[[nodiscard]] bool is_valid(const PairSurface& surface);

/// BodyLock bits.
[[nodiscard]] std::uint8_t locks_of(const AxisLocks& locks);
[[nodiscard]] AxisLocks axis_locks(std::uint8_t bits);

void set_events(BodyRecord& record, const EventSettings& settings);

/// Limits beyond the formats are clamped to them. The scale exponent must be known.
void set_speed_limit(BodyRecord& record, const SpeedLimit& limit);

/// Of the shape's frame, which the asset may place away from the body's.
void set_surface_motion(BodyRecord& record, const geometry::AssetGeometry* asset,
                        const SurfaceMotion& motion);
[[nodiscard]] SurfaceMotion surface_motion_of(const BodyRecord& record,
                                              const geometry::AssetGeometry* asset);

}  // namespace lockstone
