// Checks and changes of the rules about pairs, and of vehicles.
#pragma once

#include <cstdint>

#include "core/dynamics/state/rule_records.h"
#include "core/world/data/world_data.h"

namespace lockstone {

/// Whether each table has room for a rule with this key.
[[nodiscard]] bool has_room_for_rule(const WorldData& world, const RuleKey& bodies);
[[nodiscard]] bool has_room_for_surface_rule(const WorldData& world, const RuleKey& tags);

/// Removes the rules that name a body.
void forget_rules_of(WorldData& world, std::uint32_t body);

/// Removes the vehicle of a chassis, if there is one.
void forget_vehicle_of(WorldData& world, std::uint32_t body);
/// Null for a body that is no chassis.
[[nodiscard]] VehicleRecord* find_vehicle(WorldData& world, std::uint32_t body);
[[nodiscard]] const VehicleRecord* find_vehicle(const WorldData& world, std::uint32_t body);
/// Whether the body is dynamic and there is room for its vehicle.
[[nodiscard]] bool can_be_chassis(const WorldData& world, std::uint32_t body);

}  // namespace lockstone
