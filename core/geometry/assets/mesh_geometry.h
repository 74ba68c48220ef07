// A mesh as the engine sees it.
#pragma once

#include <utility>

#include "core/geometry/assets/mesh_data.h"
#include "core/geometry/convex/asset_geometry.h"

namespace lockstone::geometry {

class MeshGeometry final : public AssetGeometry {
 public:
  explicit MeshGeometry(MeshData data) : data_(std::move(data)) {}

  [[nodiscard]] const MeshData& data() const { return data_; }

  [[nodiscard]] const LocalBounds& bounds() const override { return data_.tree.bounds(); }
  [[nodiscard]] const MeshKernels* mesh_kernels() const override;
  [[nodiscard]] const MeshEditing* mesh_editing() const override;
  [[nodiscard]] const MeshJoining* mesh_joining() const override;
  [[nodiscard]] const AssetGeometry* triangles() const override { return this; }
  void visit_parts(const LocalBounds& region, PartVisitor& visitor) const override;
  void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                          const Vec3<Length>& reach, WayPartVisitor& visitor) const override;
  void visit_parts_near(const Vec3<Length>& point, Length reach,
                        NearPartVisitor& visitor) const override;

 private:
  MeshData data_;
};

/// Of a mesh, or of the meshes of a compound, as it was built.
[[nodiscard]] inline const MeshData& mesh_data(const AssetGeometry& geometry) {
  LKS_ASSERT(geometry.mesh_kernels() != nullptr && geometry.height_editing() == nullptr);
  return static_cast<const MeshGeometry&>(*geometry.triangles()).data();
}

}  // namespace lockstone::geometry
