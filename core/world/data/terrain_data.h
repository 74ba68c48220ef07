// The changed tiles of the height fields of a world, and the groups of meshes that are off.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/dynamics/state/terrain_record.h"
#include "core/geometry/assets/height_editing.h"
#include "core/geometry/assets/mesh_editing.h"

namespace lockstone {

struct WorldData;

/// The terrain of a world.
struct TerrainData {
  std::vector<TerrainTileRecord> tiles;  // canonical state: the first header.terrain_tile_count
  // Derived: the assets of bodies with tiles, and these bodies; a slot is a place in the list.
  std::unique_ptr<geometry::EditedAssets> edited_fields;
  std::unique_ptr<geometry::EditedAssets> edited_meshes;
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

/// The geometry of a body that exists, without a world's changes of terrain; null of a shape that
/// is complete in itself.
[[nodiscard]] const geometry::AssetGeometry* geometry_as_built(const WorldData& world,
                                                               std::uint32_t body);

/// Removes the tiles of a body. Returns whether there were any: then `refresh_terrain` follows.
[[nodiscard]] bool forget_terrain_of(WorldData& world, std::uint32_t body);

/// Of a body that exists: its functions, or null where it has no mesh of groups.
[[nodiscard]] const geometry::MeshEditing* mesh_groups_of(const WorldData& world,
                                                          std::uint32_t body);

/// Of a body that exists: its functions, or null where it has no height field.
[[nodiscard]] const geometry::HeightEditing* terrain_of(const WorldData& world, std::uint32_t body);

}  // namespace lockstone
