// A height field as the engine sees it.
#pragma once

#include <utility>

#include "core/geometry/assets/height_field_data.h"
#include "core/geometry/convex/asset_geometry.h"

namespace lockstone::geometry {

class HeightFieldGeometry final : public AssetGeometry {
 public:
  explicit HeightFieldGeometry(HeightFieldData data) : data_(std::move(data)) {}

  [[nodiscard]] const HeightFieldData& data() const { return data_; }

  [[nodiscard]] const LocalBounds& bounds() const override { return data_.bounds; }
  [[nodiscard]] const MeshKernels* mesh_kernels() const override;
  [[nodiscard]] const AssetGeometry* triangles() const override { return this; }
  [[nodiscard]] const HeightEditing* height_editing() const override;
  void visit_parts(const LocalBounds& region, PartVisitor& visitor) const override;
  void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                          const Vec3<Length>& reach, WayPartVisitor& visitor) const override;
  void visit_parts_near(const Vec3<Length>& point, Length reach,
                        NearPartVisitor& visitor) const override;

 private:
  HeightFieldData data_;
};

/// Of a height field as it was built.
[[nodiscard]] inline const HeightFieldData& height_field_data(const AssetGeometry& geometry) {
  LKS_ASSERT(geometry.height_editing() != nullptr);
  return static_cast<const HeightFieldGeometry&>(geometry).data();
}

}  // namespace lockstone::geometry
