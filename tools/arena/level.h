// Builds the arena: ground, walls, machines, zones, loose bodies and players.
#pragma once

#include <lockstone/vehicle.h>

#include "tools/arena/arena.h"

namespace lockstone::arena {

/// The capacities for a configuration.
[[nodiscard]] WorldDef world_def(const ArenaConfig& config);

/// A match before its first tick.
[[nodiscard]] Arena build_arena(const ArenaConfig& config,
                                BroadPhaseKind broad_phase = BroadPhaseKind::tree);

/// Where a slot's player starts and returns to.
[[nodiscard]] Vec3<Position> spawn_point(std::size_t slot);

/// The playing field spans ± this in x and z.
inline constexpr std::int32_t k_field_half_mm = 20'000;

/// The buggy where it starts and returns to, standing.
[[nodiscard]] BodyDef buggy_def();
[[nodiscard]] VehicleDef buggy_wheels();

/// The ferry's way along z: it turns back every this many ticks.
inline constexpr std::uint64_t k_ferry_leg_ticks = 240;

}  // namespace lockstone::arena
