#include "core/world/data/terrain_data.h"

#include <algorithm>

#include "core/world/data/sorted_table.h"
#include "core/world/data/world_data.h"

namespace lockstone {
namespace {

// Bodies with tiles have the assets of their own again.
void unbind(WorldData& world) {
  for (const std::uint32_t body : world.edited_bodies) {
    if (!world.bodies[body].exists()) continue;
    world.cache.set_asset(body, geometry_as_built(world, body));
    world.refresh(body);
  }
  world.edited_bodies.clear();
}

// The memory for the asset of a body with changes; null of one that can have none.
geometry::EditedAssets* room_for(WorldData& world, std::uint32_t body) {
  if (terrain_of(world, body) != nullptr) return world.edited_fields.get();
  return mesh_groups_of(world, body) != nullptr ? world.edited_meshes.get() : nullptr;
}

// Damaged memory may name a body without a height field or a mesh of groups.
void bind(WorldData& world, std::uint32_t body, std::span<const TerrainTileRecord> tiles) {
  if (body >= world.header.body_limit || !world.bodies[body].exists()) return;
  geometry::EditedAssets* room = room_for(world, body);
  if (room == nullptr) return;
  LKS_ASSERT(world.edited_bodies.size() < room->slots());
  const auto slot = static_cast<std::uint32_t>(world.edited_bodies.size());
  world.cache.set_asset(body, room->set(slot, *geometry_as_built(world, body), tiles));
  world.edited_bodies.push_back(body);
  world.refresh(body);
}

}  // namespace

void TerrainData::make_terrain_room(std::uint32_t tile_capacity, std::uint32_t body_capacity,
                                    const AssetSet& assets) {
  if (tile_capacity == 0) return;
  tiles.resize(tile_capacity);
  const std::uint32_t most = std::min(tile_capacity, body_capacity);
  edited_bodies.reserve(most);
  for (const AssetPtr& asset : assets.all()) {
    if (const auto* editing = asset->geometry().height_editing();
        editing != nullptr && !edited_fields)
      edited_fields = editing->make_edited(most);
    if (const auto* editing = asset->geometry().mesh_editing();
        editing != nullptr && !edited_meshes)
      edited_meshes = editing->make_edited(most);
  }
}

void refresh_terrain(WorldData& world) {
  world.is_tile_hash_known = false;
  unbind(world);
  auto tiles =
      std::span<const TerrainTileRecord>(world.tiles).first(world.header.terrain_tile_count);
  while (!tiles.empty()) {
    const std::uint32_t body = tiles.front().owner;
    const auto end = std::ranges::find_if(
        tiles, [&](const TerrainTileRecord& tile) { return tile.owner != body; });
    const auto count = static_cast<std::size_t>(end - tiles.begin());
    bind(world, body, tiles.first(count));
    tiles = tiles.subspan(count);
  }
}

bool forget_terrain_of(WorldData& world, std::uint32_t body) {
  const std::uint32_t before = world.header.terrain_tile_count;
  if (before == 0) return false;
  remove_records(world.tiles, world.header.terrain_tile_count,
                 [&](const TerrainTileRecord& tile) { return tile.owner == body; });
  return world.header.terrain_tile_count != before;
}

const geometry::AssetGeometry* geometry_as_built(const WorldData& world, std::uint32_t body) {
  return geometry::geometry_of(world.assets->find(world.bodies[body].shape().asset_id()));
}

const geometry::MeshEditing* mesh_groups_of(const WorldData& world, std::uint32_t body) {
  const geometry::AssetGeometry* geometry = geometry_as_built(world, body);
  return geometry == nullptr ? nullptr : geometry->mesh_editing();
}

const geometry::HeightEditing* terrain_of(const WorldData& world, std::uint32_t body) {
  const geometry::AssetGeometry* geometry = geometry_as_built(world, body);
  return geometry == nullptr ? nullptr : geometry->height_editing();
}

}  // namespace lockstone
