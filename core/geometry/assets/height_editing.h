// The operations of worlds that change height fields, behind a pointer that a height field gives: a
// program that makes none links none of this.
#pragma once

#include <memory>

#include "core/geometry/assets/edited_assets.h"

namespace lockstone::geometry {

/// The geometry is that of a height field as it was built.
struct HeightEditing {
  std::unique_ptr<EditedAssets> (*make_edited)(std::uint32_t capacity);
  const HeightFieldData& (*data_of)(const AssetGeometry& geometry);
  HeightTile (*original)(const HeightFieldData& field, const HeightTileKey& key);
  bool (*is_tile)(const HeightFieldData& field, const HeightTile& tile);
};

/// The one table.
[[nodiscard]] const HeightEditing& height_editing();

}  // namespace lockstone::geometry
