#include "core/geometry/assets/edited_height_field.h"

#include <algorithm>

#include "core/geometry/assets/height_editing.h"
#include "core/geometry/assets/height_field_geometry.h"
#include "core/geometry/assets/height_field_walk.h"
#include "core/geometry/mesh_contact/mesh_kernels.h"

namespace lockstone::geometry {
namespace {

HeightRange heights_of(const HeightFieldData& field, const HeightTile& tile) {
  HeightRange range;
  for (std::size_t place = 0; place < HeightTile::k_samples; ++place) {
    const GridPoint at = tile.point_at(place);
    if (at.i < field.columns && at.j < field.rows) range.include(tile.heights[place]);
  }
  return range;
}

std::unique_ptr<EditedAssets> make_edited(std::uint32_t capacity) {
  return std::make_unique<EditedSlots<EditedHeightField>>(capacity);
}

}  // namespace

const HeightEditing& height_editing() {
  static constexpr HeightEditing k_editing{make_edited, height_field_data, original_tile,
                                           is_tile_of};
  return k_editing;
}

EditedCells::EditedCells(const HeightFieldData& base, std::span<const HeightTile> tiles)
    : base_(base), tiles_(tiles), first_{tiles.front().column, tiles.front().row}, last_(first_) {
  for (const HeightTile& tile : tiles_) {
    first_ = {std::min<std::int32_t>(first_.i, tile.column),
              std::min<std::int32_t>(first_.j, tile.row)};
    last_ = {std::max<std::int32_t>(last_.i, tile.column),
             std::max<std::int32_t>(last_.j, tile.row)};
    range_.include(heights_of(base_, tile));
  }
}

const HeightTile* EditedCells::find(const GridPoint& tile) const {
  if (tile.i < first_.i || tile.j < first_.j || tile.i > last_.i || tile.j > last_.j)
    return nullptr;
  const HeightTileKey key{tiles_.front().owner, static_cast<std::uint16_t>(tile.j),
                          static_cast<std::uint16_t>(tile.i)};
  const auto at = std::ranges::lower_bound(tiles_, key, {}, &HeightTile::key);
  return at != tiles_.end() && at->key() == key ? &*at : nullptr;
}

Length EditedCells::height(const GridPoint& sample) const {
  const HeightTile* tile = tile_of(sample);
  return tile == nullptr ? base_.height(sample) : tile->heights[HeightTile::place_of(sample)];
}

bool EditedCells::is_void(const GridPoint& cell) const {
  if (cell.i < 0 || cell.j < 0 || cell.i >= base_.cell_columns() || cell.j >= base_.cell_rows())
    return true;
  const HeightTile* tile = tile_of(cell);
  return tile == nullptr ? base_.is_void(cell) : tile->is_hole(HeightTile::place_of(cell));
}

const Surface* EditedCells::surface(const GridPoint& cell) const {
  const HeightTile* tile = tile_of(cell);
  if (tile == nullptr) return base_.surface(cell);
  const std::uint8_t index = tile->surfaces[HeightTile::place_of(cell)];
  return index == k_own_surface ? nullptr : &base_.surfaces[index];
}

// A block of cells also has the first samples of the blocks beside it.
HeightRange EditedCells::block_range(int level, const GridPoint& at) const {
  HeightRange range = base_.block_range(level, at);
  const int shift = level - HeightPyramid::k_lowest_level;
  const GridPoint low{at.i << shift, at.j << shift};
  const GridPoint high{(at.i + 1) << shift, (at.j + 1) << shift};
  if (high.i < first_.i || high.j < first_.j || low.i > last_.i || low.j > last_.j) return range;
  if (shift > 0) {
    range.include(range_);
    return range;
  }
  for (std::int32_t j = low.j; j <= high.j; ++j) {
    for (std::int32_t i = low.i; i <= high.i; ++i)
      if (const HeightTile* tile = find({i, j})) range.include(heights_of(base_, *tile));
  }
  return range;
}

EditedHeightField::EditedHeightField(const AssetGeometry& base, std::span<const HeightTile> tiles)
    : cells_(height_field_data(base), tiles), bounds_(base.bounds()) {
  bounds_.lower.y = min(bounds_.lower.y, cells_.range().lowest);
  bounds_.upper.y = max(bounds_.upper.y, cells_.range().highest);
}

const MeshKernels* EditedHeightField::mesh_kernels() const {
  return &geometry::mesh_kernels();
}

void EditedHeightField::visit_parts(const LocalBounds& region, PartVisitor& visitor) const {
  visit_cells(cells_, region, visitor);
}

void EditedHeightField::visit_parts_on_way(const Vec3<Length>& origin,
                                           const Vec3<Length>& translation,
                                           const Vec3<Length>& reach,
                                           WayPartVisitor& visitor) const {
  visit_cells_on_way(cells_, origin, translation, reach, visitor);
}

void EditedHeightField::visit_parts_near(const Vec3<Length>& point, Length reach,
                                         NearPartVisitor& visitor) const {
  visit_cells_near(cells_, point, reach, visitor);
}

}  // namespace lockstone::geometry
