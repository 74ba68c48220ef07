// The balance of a motorcycle: a torque that leans it into its turns.
#pragma once

#include <span>

#include "core/world/phases/vehicle/wheel.h"

namespace lockstone {

/// A torque on the chassis, and a force on its centre of mass.
struct Balance {
  Real3 torque{}, force{};
};

/// Leans the chassis towards the angle at which its weight and the centrifugal force balance. The
/// torque raises the motorcycle only with energy that the force takes from its way ahead: one that
/// stands is held, and never raised. Nothing in the air, and nothing without gravity.
[[nodiscard]] Balance balance_of(const WorldData& world, const VehicleRecord& vehicle,
                                 const Chassis& chassis, std::span<const WheelContact> contacts);

/// Of a body's axes to the right, against gravity; 0 without it.
[[nodiscard]] Angle lean_of(const WorldData& world, const Mat3& axes);

}  // namespace lockstone
