#include "core/geometry/assets/height_tile.h"

#include "core/geometry/assets/asset_frame.h"

namespace lockstone::geometry {
namespace {

bool has_sample(const HeightFieldData& field, const GridPoint& at) {
  return at.i < field.columns && at.j < field.rows;
}

bool has_cell(const HeightFieldData& field, const GridPoint& at) {
  return at.i < field.cell_columns() && at.j < field.cell_rows();
}

bool is_surface_of(const HeightFieldData& field, std::uint8_t surface) {
  return surface == k_own_surface || surface < field.surfaces.size();
}

}  // namespace

HeightTile original_tile(const HeightFieldData& field, const HeightTileKey& key) {
  HeightTile tile;
  tile.owner = key.owner;
  tile.row = key.row;
  tile.column = key.column;
  tile.surfaces.fill(k_own_surface);
  for (std::size_t place = 0; place < HeightTile::k_samples; ++place) {
    const GridPoint at = tile.point_at(place);
    if (has_sample(field, at)) tile.heights[place] = field.height(at);
    if (!has_cell(field, at)) continue;
    if (field.is_void(at)) tile.holes = static_cast<std::uint16_t>(tile.holes | 1U << place);
    if (!field.cell_surfaces.empty())
      tile.surfaces[place] = field.cell_surfaces[field.cell_number(at)];
  }
  return tile;
}

bool is_tile_of(const HeightFieldData& field, const HeightTile& tile) {
  if (!has_sample(field, tile.point_at(0)) || tile.reserved != 0) return false;
  for (std::size_t place = 0; place < HeightTile::k_samples; ++place) {
    const GridPoint at = tile.point_at(place);
    const Length height = tile.heights[place];
    const bool good_height = has_sample(field, at) ? height >= -k_max_asset_coordinate &&
                                                         height <= k_max_asset_coordinate
                                                   : height == Length{};
    const bool plain = tile.surfaces[place] == k_own_surface;
    const bool good_cell = has_cell(field, at) ? is_surface_of(field, tile.surfaces[place]) &&
                                                     (plain || !tile.is_hole(place))
                                               : plain && !tile.is_hole(place);
    if (!good_height || !good_cell) return false;
  }
  return true;
}

}  // namespace lockstone::geometry
