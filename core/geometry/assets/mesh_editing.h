// The operations of worlds that switch groups of meshes, behind a pointer that a mesh of groups
// gives. The groups that are off are bits of tiles, which a world keeps with those of height
// fields.
#pragma once

#include <memory>

#include "core/geometry/assets/edited_assets.h"
#include "core/geometry/convex/parts.h"

namespace lockstone::geometry {

/// The row of tiles of groups, which no height field has; tile `column` has the groups from
/// 16 · column on, and its holes are those that are off. Heights and surfaces are 0.
inline constexpr std::uint16_t k_group_row = 0xffff;

/// The place of a group's tile, of a group below k_max_mesh_groups.
[[nodiscard]] constexpr HeightTileKey group_tile_key(std::uint32_t owner, std::uint32_t group) {
  return {owner, k_group_row, static_cast<std::uint16_t>(group / HeightTile::k_samples)};
}

/// The geometry is that of a mesh of groups as it was built.
struct MeshEditing {
  std::unique_ptr<EditedAssets> (*make_edited)(std::uint32_t capacity);
  /// Of the triangles of a group; null of one without triangles.
  const LocalBounds* (*bounds_of)(const AssetGeometry& geometry, std::uint32_t group);
  /// Whether a world can have it: groups that exist, of which one is off.
  bool (*is_tile)(const AssetGeometry& geometry, const HeightTile& tile);
};

/// The one table.
[[nodiscard]] const MeshEditing& mesh_editing();

}  // namespace lockstone::geometry
