// A height field as a world has changed it: the asset, and the tiles that take the place of its
// own.
#pragma once

#include <span>

#include "core/geometry/assets/height_tile.h"
#include "core/geometry/convex/asset_geometry.h"

namespace lockstone::geometry {

/// The samples and cells. Tiles are of one owner, by key, and at least one; they and the asset
/// outlive this.
class EditedCells {
 public:
  EditedCells(const HeightFieldData& base, std::span<const HeightTile> tiles);

  [[nodiscard]] const HeightFieldData& grid() const { return base_; }
  [[nodiscard]] Length height(const GridPoint& sample) const;
  /// Whether the cell is outside the grid or a hole.
  [[nodiscard]] bool is_void(const GridPoint& cell) const;
  [[nodiscard]] const Surface* surface(const GridPoint& cell) const;
  /// Of the asset's heights and those of the tiles: they may be farther apart than the block's.
  [[nodiscard]] HeightRange block_range(int level, const GridPoint& at) const;
  [[nodiscard]] const HeightRange& range() const { return range_; }

 private:
  [[nodiscard]] const HeightTile* find(const GridPoint& tile) const;
  [[nodiscard]] const HeightTile* tile_of(const GridPoint& at) const {
    return find({at.i >> HeightTile::k_shift, at.j >> HeightTile::k_shift});
  }

  const HeightFieldData& base_;
  std::span<const HeightTile> tiles_;
  GridPoint first_;  // of the rectangle that holds all tiles
  GridPoint last_;
  HeightRange range_;  // of all tiles' heights
};

/// The geometry of a body whose height field was changed.
class EditedHeightField final : public AssetGeometry {
 public:
  /// `base` is a height field as it was built.
  EditedHeightField(const AssetGeometry& base, std::span<const HeightTile> tiles);

  [[nodiscard]] const LocalBounds& bounds() const override { return bounds_; }
  [[nodiscard]] const MeshKernels* mesh_kernels() const override;
  [[nodiscard]] const AssetGeometry* triangles() const override { return this; }
  [[nodiscard]] const AssetGeometry* whole() const { return this; }
  void visit_parts(const LocalBounds& region, PartVisitor& visitor) const override;
  void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                          const Vec3<Length>& reach, WayPartVisitor& visitor) const override;
  void visit_parts_near(const Vec3<Length>& point, Length reach,
                        NearPartVisitor& visitor) const override;

 private:
  EditedCells cells_;
  LocalBounds bounds_;
};

}  // namespace lockstone::geometry
