// Wheels, engine and gearbox through the parts of a tick.
#pragma once

#include <array>
#include <span>

#include "core/world/phases/vehicle/wheel.h"

namespace lockstone {

inline constexpr std::size_t k_max_wheels = 2 * k_max_axles;

/// The force of the ground on a wheel, mean over a tick, N.
struct TyreForce {
  Real ahead, right;
};

/// Shifts, as the gearbox or the driver wants.
void shift(VehicleRecord& vehicle);

/// Turns the wheels and the engine for a tick, with the loads of the wheels and the velocities of
/// the ground under them. Returns the forces on the wheels.
[[nodiscard]] std::array<TyreForce, k_max_wheels> turn_wheels(
    VehicleRecord& vehicle, std::span<const WheelContact> contacts, std::uint32_t tick_rate);

}  // namespace lockstone
