// Checks of the command that changes terrain.
#pragma once

#include <lockstone/command.h>

#include "core/world/data/world_data.h"

namespace lockstone {

/// The first argument of the command that is out of range.
enum class HeightsFault : std::uint8_t {
  none = 0,
  columns,  ///< the rectangle: 1 or more columns within the grid
  rows,
  heights,        ///< the number of heights, or one beyond ±512 m
  holes,          ///< the number of holes
  cell_surfaces,  ///< the number of surfaces, or one that the asset does not have
  nothing,        ///< all lists are empty
};

/// `body` has a height field (`terrain_of`).
[[nodiscard]] HeightsFault fault_of(const WorldData& world, const SetHeights& command);

/// `body` has a mesh of groups (`mesh_groups_of`): whether the group has triangles.
[[nodiscard]] bool has_group(const WorldData& world, const SetMeshGroup& command);
/// Whether the tile of its group fits the capacity.
[[nodiscard]] bool has_room_for(const WorldData& world, const SetMeshGroup& command);

/// Whether its tiles fit the capacity, of a command without fault.
[[nodiscard]] bool has_room_for(const WorldData& world, const SetHeights& command);

}  // namespace lockstone
