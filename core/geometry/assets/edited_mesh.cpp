// A mesh as a world has switched its groups.
#include <algorithm>
#include <optional>

#include "core/geometry/assets/mesh_editing.h"
#include "core/geometry/assets/mesh_geometry.h"
#include "core/geometry/assets/mesh_walk.h"
#include "core/geometry/assets/mixed_geometry.h"
#include "core/geometry/mesh_contact/mesh_kernels.h"

namespace lockstone::geometry {
namespace {

/// The triangles of groups that are on. Where the triangle beyond an edge is off, the edge is met.
class SwitchedTriangles {
 public:
  SwitchedTriangles(const MeshData& data, std::span<const HeightTile> tiles)
      : data_(data), tiles_(tiles) {
    LKS_ASSERT(!data.soup.groups.empty() && !tiles.empty());
  }

  [[nodiscard]] bool has(std::uint32_t index) const { return !is_off(data_.soup.groups[index]); }

  [[nodiscard]] std::uint8_t active_edges(std::uint32_t index) const {
    std::uint8_t edges = data_.active_edges(index);
    auto at = std::ranges::lower_bound(data_.group_edges, index * 4, {}, &SharedEdge::corner);
    for (; at != data_.group_edges.end() && at->corner >> 2 == index; ++at) {
      if (is_off(at->group)) edges = static_cast<std::uint8_t>(edges | 1U << (at->corner & 3));
    }
    return edges;
  }

 private:
  [[nodiscard]] bool is_off(std::uint16_t group) const {
    const HeightTileKey key = group_tile_key(tiles_.front().owner, group);
    const auto at = std::ranges::lower_bound(tiles_, key, {}, &HeightTile::key);
    return at != tiles_.end() && at->key() == key && at->is_hole(group % HeightTile::k_samples);
  }

  const MeshData& data_;
  std::span<const HeightTile> tiles_;
};

/// The triangles of a body some of whose groups are off.
class EditedMesh final : public AssetGeometry {
 public:
  EditedMesh(const AssetGeometry& base, std::span<const HeightTile> tiles)
      : data_(mesh_data(base)), triangles_(data_, tiles) {}

  [[nodiscard]] const LocalBounds& bounds() const override { return data_.tree.bounds(); }
  [[nodiscard]] const AssetGeometry* triangles() const override { return this; }
  [[nodiscard]] const MeshKernels* mesh_kernels() const override {
    return &geometry::mesh_kernels();
  }
  void visit_parts(const LocalBounds& region, PartVisitor& visitor) const override {
    visit_triangles(data_, triangles_, region, visitor);
  }
  void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                          const Vec3<Length>& reach, WayPartVisitor& visitor) const override {
    visit_nearest_first(data_, triangles_, RayWindow(origin, translation, reach),
                        Unit::from_integer(1), visitor);
  }
  void visit_parts_near(const Vec3<Length>& point, Length reach,
                        NearPartVisitor& visitor) const override {
    visit_nearest_first(data_, triangles_, NearWindow(point), reach, visitor);
  }

 private:
  const MeshData& data_;
  SwitchedTriangles triangles_;
};

/// With the convex parts of a compound, where the body has some.
class EditedMeshAsset {
 public:
  EditedMeshAsset(const AssetGeometry& base, std::span<const HeightTile> tiles)
      : triangles_(base, tiles) {
    if (base.solids() != nullptr) mixed_.emplace(*base.solids(), triangles_);
  }
  EditedMeshAsset(const EditedMeshAsset&) = delete;  // one part refers to the other
  EditedMeshAsset& operator=(const EditedMeshAsset&) = delete;

  [[nodiscard]] const AssetGeometry* whole() const {
    return mixed_ ? static_cast<const AssetGeometry*>(&*mixed_) : &triangles_;
  }

 private:
  EditedMesh triangles_;
  std::optional<MixedGeometry> mixed_;
};

std::unique_ptr<EditedAssets> make_edited_meshes(std::uint32_t capacity) {
  return std::make_unique<EditedSlots<EditedMeshAsset>>(capacity);
}

const LocalBounds* bounds_of_group(const AssetGeometry& geometry, std::uint32_t group) {
  const MeshGroup* found = find_group(mesh_data(geometry), group);
  return found == nullptr ? nullptr : &found->bounds;
}

bool is_tile_of_groups(const AssetGeometry& geometry, const HeightTile& tile) {
  HeightTile plain;
  plain.owner = tile.owner;
  plain.row = k_group_row;
  plain.column = tile.column;
  plain.holes = tile.holes;
  if (tile != plain || tile.holes == 0) return false;
  for (std::size_t place = 0; place < HeightTile::k_samples; ++place) {
    const auto group = static_cast<std::uint32_t>(tile.column * HeightTile::k_samples + place);
    if (tile.is_hole(place) && bounds_of_group(geometry, group) == nullptr) return false;
  }
  return true;
}

}  // namespace

const MeshEditing& mesh_editing() {
  static constexpr MeshEditing k_editing{make_edited_meshes, bounds_of_group, is_tile_of_groups};
  return k_editing;
}

}  // namespace lockstone::geometry
