// Convex parts and triangles as one asset.
#pragma once

#include <memory>
#include <utility>

#include "core/geometry/convex/asset_geometry.h"

namespace lockstone::geometry {

/// The convex parts of one geometry, then the triangles of another, in the same frame. Both must
/// outlive it. Numbers of triangles are above those of convex parts.
class MixedGeometry : public AssetGeometry {
 public:
  MixedGeometry(const AssetGeometry& solids, const AssetGeometry& triangles)
      : solids_(solids), triangles_(triangles) {
    LKS_ASSERT(solids.solids() == &solids && triangles.triangles() == &triangles);
  }

  /// Those of the convex parts, which were built with those of the triangles.
  [[nodiscard]] const LocalBounds& bounds() const override { return solids_.bounds(); }
  [[nodiscard]] const AssetGeometry* triangles() const override { return &triangles_; }
  [[nodiscard]] const AssetGeometry* solids() const override { return &solids_; }
  [[nodiscard]] const MeshKernels* mesh_kernels() const override {
    return triangles_.mesh_kernels();
  }
  [[nodiscard]] const MeshEditing* mesh_editing() const override {
    return triangles_.mesh_editing();
  }
  void visit_parts(const LocalBounds& region, PartVisitor& visitor) const override {
    solids_.visit_parts(region, visitor);
    triangles_.visit_parts(region, visitor);
  }
  void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                          const Vec3<Length>& reach, WayPartVisitor& visitor) const override {
    solids_.visit_parts_on_way(origin, translation, reach, visitor);
    triangles_.visit_parts_on_way(origin, translation, reach, visitor);
  }
  void visit_parts_near(const Vec3<Length>& point, Length reach,
                        NearPartVisitor& visitor) const override {
    solids_.visit_parts_near(point, reach, visitor);
    triangles_.visit_parts_near(point, reach, visitor);
  }

 private:
  const AssetGeometry& solids_;
  const AssetGeometry& triangles_;
};

/// One that owns its two halves.
class OwnedMixedGeometry final : public MixedGeometry {
 public:
  OwnedMixedGeometry(std::unique_ptr<const AssetGeometry> solids,
                     std::unique_ptr<const AssetGeometry> triangles)
      : MixedGeometry(*solids, *triangles),
        owned_solids_(std::move(solids)),
        owned_triangles_(std::move(triangles)) {}

 private:
  std::unique_ptr<const AssetGeometry> owned_solids_;
  std::unique_ptr<const AssetGeometry> owned_triangles_;
};

}  // namespace lockstone::geometry
