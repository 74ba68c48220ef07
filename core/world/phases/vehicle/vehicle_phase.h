// The vehicles of a world: the forces of their wheels.
#pragma once

#include "core/dynamics/state/vehicle_record.h"
#include "core/world/data/world_data.h"

namespace lockstone {

/// The part of a tick that drives vehicles.
struct VehiclePhase {
  /// Adds the forces of the wheels to those of commands, by chassis, and turns wheels and engines.
  void (*drive)(World::Impl& world);
};

/// The phase of a program that links the command; null in others, which refuse states with
/// vehicles.
extern const VehiclePhase* linked_vehicle_phase;
[[nodiscard]] const VehiclePhase& vehicle_phase();

/// Whether a definition is within its ranges.
[[nodiscard]] bool is_valid(const VehicleDef& def);

/// The record of a definition, at rest, and back.
[[nodiscard]] VehicleRecord record_of(std::uint32_t chassis, const VehicleDef& def);
[[nodiscard]] VehicleDef def_of(const VehicleRecord& record);
void set_controls(VehicleRecord& record, const VehicleControls& controls);
[[nodiscard]] VehicleControls controls_of(const VehicleRecord& record);

}  // namespace lockstone
