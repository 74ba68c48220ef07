// The changed tiles of the height fields of a world.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/dynamics/state/terrain_record.h"
#include "core/geometry/assets/height_editing.h"

namespace lockstone {

struct WorldData;

/// The terrain of a world.
struct TerrainData {
  std::vector<TerrainTileRecord> tiles;  // canonical state: the first header.terrain_tile_count
  // Derived: the assets of bodies with tiles, and these bodies; a slot is a place in the list.
  std::unique_ptr<geometry::EditedHeightFields> edited_fields;
  std::vector<std::uint32_t> edited_bodies;
  std::uint64_t tile_hash = 0;  // derived: of all tiles, where it is known
  bool is_tile_hash_known = false;

  /// No function but this allocates.
  void make_terrain_room(std::uint32_t tile_capacity, std::uint32_t body_capacity,
                         const AssetSet& assets);
};

/// Brings all that is derived of the tiles up to date, bounds of bodies included: after every
/// change of them.
void refresh_terrain(WorldData& world);

/// Removes the tiles of a body. Returns whether there were any: then `refresh_terrain` follows.
[[nodiscard]] bool forget_terrain_of(WorldData& world, std::uint32_t body);

/// Of a body that exists: its functions, or null where it has no height field.
[[nodiscard]] const geometry::HeightEditing* terrain_of(const WorldData& world, std::uint32_t body);

}  // namespace lockstone
