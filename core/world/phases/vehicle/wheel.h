// A wheel in a tick: where it touches the ground, and the force there.
#pragma once

#include "core/dynamics/state/vehicle_record.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/vehicle/real.h"

namespace lockstone {

/// The chassis as its wheels see it.
struct Chassis {
  std::uint32_t body = 0;
  Transform frame{};  // of its shape
  Mat3 axes{};        // of its shape: ahead, up, right
  Real3 velocity{};   // of its centre of mass
  Real3 turning{};    // rad/s
  Real mass{};
  Real3 moments{};  // about its principal axes, kg·m²
  Real dt{};        // of a tick
};

/// Where a wheel stands. Directions are units.
struct WheelContact {
  bool exists = false;
  BodyHandle ground{};
  Vec3<Position> point{};
  Real3 up{}, ahead{}, right{};  // normal of the ground; along it
  Real speed_ahead{}, speed_right{};
  Real closing{};  // of its spring, m/s
  Real grip{};     // combined friction
  // Of a motorcycle, the speed to the right that a force of 1 N there gives in 1 s; else 0.
  Real yield_right{};
};

/// Of a vector that is not 0.
[[nodiscard]] Real3 unit_real(const Real3& v);

/// Velocity of a body's material point, zero of one that stands.
[[nodiscard]] Real3 velocity_at(const WorldData& world, std::uint32_t body,
                                const Vec3<Position>& point);
[[nodiscard]] Real3 turning_of(const WorldData& world, std::uint32_t body);

[[nodiscard]] Chassis chassis_of(const WorldData& world, std::uint32_t body);

/// ω² per N·m: the part of a torque's turning that goes along it, Σ tᵢ²/Iᵢ in principal axes.
[[nodiscard]] Real yield_to(const WorldData& world, const Chassis& chassis, const Real3& torque);

/// In the axes of the chassis, the direction in which a wheel rolls ahead.
[[nodiscard]] Real3 heading_of(const VehicleRecord& vehicle, std::size_t wheel);

/// Finds the ground, and sets the wheel's compression.
[[nodiscard]] WheelContact find_ground(const WorldData& world, const VehicleRecord& vehicle,
                                       const Chassis& chassis, std::size_t wheel,
                                       WheelRecord& record);

}  // namespace lockstone
