// The commands that change terrain and switch groups of meshes.

#include <algorithm>

#include <lockstone/terrain.h>

#include "core/world/commands/command_executor.h"
#include "core/world/commands/terrain_changes.h"
#include "core/world/data/sorted_table.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

using geometry::GridPoint;
using geometry::HeightFieldData;
using geometry::HeightRange;
using geometry::HeightTile;
using geometry::HeightTileKey;

std::span<const TerrainTileRecord> tiles_of(const WorldData& world) {
  return std::span(world.tiles).first(world.header.terrain_tile_count);
}

/// A rectangle of samples or cells, `end` beyond its last one.
struct GridRectangle {
  GridPoint first;
  GridPoint end;

  [[nodiscard]] bool has(const GridPoint& at) const {
    return at.i >= first.i && at.j >= first.j && at.i < end.i && at.j < end.j;
  }
  /// The place in a list, row by row.
  [[nodiscard]] std::size_t place_of(const GridPoint& at) const {
    return static_cast<std::size_t>((at.j - first.j) * (end.i - first.i) + at.i - first.i);
  }
};

/// The height field of a body as it is, and the change that a command without fault makes.
class HeightEdit {
 public:
  HeightEdit(const WorldData& world, const SetHeights& command)
      : world_(world),
        command_(command),
        editing_(*terrain_of(world, command.body.index)),
        field_(editing_.data_of(*geometry_as_built(world, command.body.index))) {
    const GridPoint first{static_cast<std::int32_t>(command.column),
                          static_cast<std::int32_t>(command.row)};
    const GridPoint last{first.i + static_cast<std::int32_t>(command.columns) - 1,
                         first.j + static_cast<std::int32_t>(command.rows) - 1};
    samples_ = {first, {last.i + 1, last.j + 1}};
    cells_ = {first, last};
  }

  /// Calls `f(tile, is_new, is_original)` for each tile that the command changes, as it will be;
  /// `is_new` where it has no record yet.
  template <class F>
  void for_each_changed(F&& f) const {
    constexpr int k_shift = HeightTile::k_shift;
    for (std::int32_t j = samples_.first.j >> k_shift; j <= (samples_.end.j - 1) >> k_shift; ++j) {
      for (std::int32_t i = samples_.first.i >> k_shift; i <= (samples_.end.i - 1) >> k_shift; ++i)
        visit_tile(HeightTile::key_of(command_.body.index, {i << k_shift, j << k_shift}), f);
    }
  }

  [[nodiscard]] bool changes_any() const {
    bool any = false;
    for_each_changed([&](const HeightTile&, bool, bool) { any = true; });
    return any;
  }

  /// The box in the asset's frame that holds all triangles that the command changes, as they are.
  [[nodiscard]] geometry::LocalBounds bounds() const {
    const GridPoint low{std::max(samples_.first.i - 1, 0), std::max(samples_.first.j - 1, 0)};
    const GridPoint high{std::min(samples_.end.i, field_.cell_columns()),
                         std::min(samples_.end.j, field_.cell_rows())};
    HeightRange range;
    for (std::int32_t j = low.j; j <= high.j; ++j) {
      for (std::int32_t i = low.i; i <= high.i; ++i)
        range.include(height({i, j}));
    }
    return {{field_.x_of(low.i), range.lowest, field_.z_of(low.j)},
            {field_.x_of(high.i), range.highest, field_.z_of(high.j)}};
  }

 private:
  template <class F>
  void visit_tile(const HeightTileKey& key, F&& f) const {
    const TerrainTileRecord* record = find_by_key(tiles_of(world_), key);
    const HeightTile original = editing_.original(field_, key);
    const HeightTile& before = record == nullptr ? original : *record;
    const HeightTile after = changed(before);
    if (after != before) f(after, record == nullptr, after == original);
  }

  [[nodiscard]] HeightTile changed(HeightTile tile) const {
    for (std::size_t place = 0; place < HeightTile::k_samples; ++place) {
      const GridPoint at = tile.point_at(place);
      if (!command_.heights.empty() && samples_.has(at))
        tile.heights[place] = command_.heights[samples_.place_of(at)];
      if (cells_.has(at)) change_cell(tile, place, cells_.place_of(at));
    }
    return tile;
  }

  /// A hole has no surface, and forgets the one it had.
  void change_cell(HeightTile& tile, std::size_t place, std::size_t cell) const {
    const unsigned bit = 1U << place;
    if (!command_.holes.empty()) {
      const unsigned others = tile.holes & ~bit;
      tile.holes = static_cast<std::uint16_t>(command_.holes[cell] != 0 ? others | bit : others);
    }
    if (!command_.cell_surfaces.empty()) tile.surfaces[place] = command_.cell_surfaces[cell];
    if (tile.is_hole(place)) tile.surfaces[place] = k_own_surface;
  }

  [[nodiscard]] Length height(const GridPoint& at) const {
    const auto* record = find_by_key(tiles_of(world_), HeightTile::key_of(command_.body.index, at));
    return record == nullptr ? field_.height(at) : record->heights[HeightTile::place_of(at)];
  }

  const WorldData& world_;
  const SetHeights& command_;
  const geometry::HeightEditing& editing_;
  const HeightFieldData& field_;
  GridRectangle samples_;
  GridRectangle cells_;
};

bool is_range_of(std::uint32_t first, std::uint32_t count, std::int32_t all) {
  const auto most = static_cast<std::uint32_t>(all);
  return count >= 1 && first < most && count <= most - first;
}

template <class List>
bool fits(const List& list, std::size_t count) {
  return list.empty() || list.size() == count;
}

bool has_heights_in_range(const SetHeights& command) {
  return std::ranges::all_of(command.heights, [](Length height) {
    return height >= -k_max_asset_coordinate && height <= k_max_asset_coordinate;
  });
}

bool has_known_surfaces(const SetHeights& command, const HeightFieldData& field) {
  return std::ranges::all_of(command.cell_surfaces, [&](std::uint8_t surface) {
    return surface == k_own_surface || surface < field.surfaces.size();
  });
}

// The bodies that sleep on triangles wake.
void disturb(World::Impl& world, std::uint32_t body, const geometry::LocalBounds& changed) {
  const WorldBox box = world_box(world.placed(body), changed);
  constexpr Position k_margin = rounded<Position>(k_contact_margin / 2);
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    bounds.lower[i] = round_down(box.lower[i] - k_margin);
    bounds.upper[i] = round_up(box.upper[i] + k_margin);
  }
  world.waking.disturb_within(bounds, body);
}

void change_tiles(WorldData& world, const HeightEdit& edit) {
  std::uint32_t& count = world.header.terrain_tile_count;
  edit.for_each_changed([&](const HeightTile& tile, bool, bool is_original) {
    const HeightTileKey key = tile.key();
    if (is_original)
      remove_records(world.tiles, count, [&](const HeightTile& old) { return old.key() == key; });
    else
      LKS_CHECK(set_record(world.tiles, count, tile));
  });
}

}  // namespace

HeightsFault fault_of(const WorldData& world, const SetHeights& command) {
  const std::uint32_t body = command.body.index;
  const HeightFieldData& field = terrain_of(world, body)->data_of(*geometry_as_built(world, body));
  if (!is_range_of(command.column, command.columns, field.columns)) return HeightsFault::columns;
  if (!is_range_of(command.row, command.rows, field.rows)) return HeightsFault::rows;
  const std::size_t samples = std::size_t{command.columns} * command.rows;
  const std::size_t cells = std::size_t{command.columns - 1} * (command.rows - 1);
  if (!fits(command.heights, samples) || !has_heights_in_range(command))
    return HeightsFault::heights;
  if (!fits(command.holes, cells)) return HeightsFault::holes;
  if (!fits(command.cell_surfaces, cells) || !has_known_surfaces(command, field))
    return HeightsFault::cell_surfaces;
  const bool nothing =
      command.heights.empty() && command.holes.empty() && command.cell_surfaces.empty();
  return nothing ? HeightsFault::nothing : HeightsFault::none;
}

bool has_room_for(const WorldData& world, const SetHeights& command) {
  std::size_t count = world.header.terrain_tile_count;
  HeightEdit(world, command)
      .for_each_changed([&](const HeightTile&, bool is_new, bool is_original) {
        if (is_new) ++count;
        if (is_original) --count;
      });
  return count <= world.tiles.size();
}

Status CommandExecutor::execute(const SetHeights& command) {
  if (world_.find(command.body) == nullptr) return Status::stale_handle;
  const std::uint32_t body = command.body.index;
  if (terrain_of(world_, body) == nullptr) return Status::not_found;
  if (fault_of(world_, command) != HeightsFault::none) return Status::invalid_argument;
  if (!has_room_for(world_, command)) return Status::capacity_exhausted;
  const HeightEdit edit(world_, command);
  if (!edit.changes_any()) return Status::ok;
  disturb(world_, body, edit.bounds());
  change_tiles(world_, edit);
  refresh_terrain(world_);
  world_.contacts.forget_manifolds_of(body);
  disturb(world_, body, edit.bounds());
  return Status::ok;
}

namespace {

// The tile of a group; one without holes where it has no record.
HeightTile group_tile_of(const WorldData& world, const SetMeshGroup& command) {
  const HeightTileKey key = geometry::group_tile_key(command.body.index, command.group);
  if (const TerrainTileRecord* record = find_by_key(tiles_of(world), key)) return *record;
  HeightTile none;
  none.owner = key.owner;
  none.row = key.row;
  none.column = key.column;
  return none;
}

HeightTile switched(HeightTile tile, const SetMeshGroup& command) {
  const unsigned bit = 1U << command.group % HeightTile::k_samples, others = tile.holes & ~bit;
  tile.holes = static_cast<std::uint16_t>(command.is_on ? others : others | bit);
  return tile;
}

const geometry::LocalBounds* bounds_of_group(const WorldData& world, BodyHandle body,
                                             std::uint32_t group) {
  const geometry::AssetGeometry& mesh = *geometry_as_built(world, body.index);
  return mesh.mesh_editing()->bounds_of(mesh, group);
}

}  // namespace

bool has_group(const WorldData& world, const SetMeshGroup& command) {
  return bounds_of_group(world, command.body, command.group) != nullptr;
}

bool has_room_for(const WorldData& world, const SetMeshGroup& command) {
  const HeightTile tile = group_tile_of(world, command);
  const bool is_new = tile.holes == 0 && !command.is_on;
  return !is_new || world.header.terrain_tile_count < world.tiles.size();
}

Status CommandExecutor::execute(const SetMeshGroup& command) {
  if (world_.find(command.body) == nullptr) return Status::stale_handle;
  const std::uint32_t body = command.body.index;
  if (mesh_groups_of(world_, body) == nullptr) return Status::not_found;
  if (!has_group(world_, command)) return Status::invalid_argument;
  if (!has_room_for(world_, command)) return Status::capacity_exhausted;
  const HeightTile before = group_tile_of(world_, command), after = switched(before, command);
  if (after == before) return Status::ok;
  disturb(world_, body, *bounds_of_group(world_, command.body, command.group));
  std::uint32_t& count = world_.header.terrain_tile_count;
  if (after.holes == 0)
    remove_records(world_.tiles, count,
                   [&](const HeightTile& old) { return old.key() == after.key(); });
  else
    LKS_CHECK(set_record(world_.tiles, count, after));
  refresh_terrain(world_);
  world_.contacts.forget_manifolds_of(body);
  return Status::ok;
}

/// The way of the functions below into a world.
class WorldTerrain {
 public:
  static const WorldData& of(const World& world) { return *world.impl_; }
};

std::optional<TerrainSample> terrain_sample_of(const World& world, BodyHandle body,
                                               std::uint32_t column, std::uint32_t row) {
  const WorldData& data = WorldTerrain::of(world);
  if (data.find(body) == nullptr) return {};
  const geometry::HeightEditing* editing = terrain_of(data, body.index);
  if (editing == nullptr) return {};
  const HeightFieldData& field = editing->data_of(*geometry_as_built(data, body.index));
  if (!is_range_of(column, 1, field.columns) || !is_range_of(row, 1, field.rows)) return {};
  const GridPoint at{static_cast<std::int32_t>(column), static_cast<std::int32_t>(row)};
  const HeightTileKey key = HeightTile::key_of(body.index, at);
  const TerrainTileRecord* record = find_by_key(tiles_of(data), key);
  const HeightTile tile = record == nullptr ? editing->original(field, key) : *record;
  const std::size_t place = HeightTile::place_of(at);
  const bool is_cell = at.i < field.cell_columns() && at.j < field.cell_rows();
  return TerrainSample{tile.heights[place], !is_cell || tile.is_hole(place), tile.surfaces[place]};
}

std::optional<bool> is_mesh_group_on(const World& world, BodyHandle body, std::uint32_t group) {
  const WorldData& data = WorldTerrain::of(world);
  if (data.find(body) == nullptr || mesh_groups_of(data, body.index) == nullptr) return {};
  if (bounds_of_group(data, body, group) == nullptr) return {};
  const HeightTile tile = group_tile_of(data, {.body = body, .group = group});
  return !tile.is_hole(group % HeightTile::k_samples);
}

const geometry::AssetGeometry* geometry_of(const World& world, BodyHandle body) {
  const WorldData& data = WorldTerrain::of(world);
  return data.find(body) == nullptr ? nullptr : data.cache.asset(body.index);
}

std::uint32_t terrain_tile_count(const World& world) {
  return WorldTerrain::of(world).header.terrain_tile_count;
}

}  // namespace lockstone
