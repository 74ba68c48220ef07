// The geometry of an asset, as the engine sees it: also of a terrain as a world has changed it.
#pragma once

#include <lockstone/asset.h>

#include "core/geometry/convex/parts.h"

namespace lockstone::geometry {

class Curve;
struct HeightEditing;
struct MeshEditing;
struct MeshJoining;
struct MeshKernels;
struct Solid;

class AssetGeometry {
 public:
  virtual ~AssetGeometry() = default;
  AssetGeometry(const AssetGeometry&) = delete;
  AssetGeometry& operator=(const AssetGeometry&) = delete;

  [[nodiscard]] virtual const LocalBounds& bounds() const = 0;

  /// Mass distribution; null for assets that no dynamic body can have.
  [[nodiscard]] virtual const Solid* solid() const { return nullptr; }

  /// The polyhedron when the asset is a single convex one.
  [[nodiscard]] virtual const Polytope* polytope() const { return nullptr; }

  /// Its triangles alone: itself where it has no other parts; null of an asset without triangles.
  [[nodiscard]] virtual const AssetGeometry* triangles() const { return nullptr; }

  /// Its convex parts alone, where it may have triangles too; null of other assets.
  [[nodiscard]] virtual const AssetGeometry* solids() const { return nullptr; }

  /// The kernels that collide with its triangles; null for an asset without triangles.
  [[nodiscard]] virtual const MeshKernels* mesh_kernels() const { return nullptr; }

  /// The functions that change its heights in a world; null for an asset that is no height field.
  [[nodiscard]] virtual const HeightEditing* height_editing() const { return nullptr; }

  /// The functions that switch its groups in a world; null for an asset that is no mesh of groups.
  [[nodiscard]] virtual const MeshEditing* mesh_editing() const { return nullptr; }

  /// The functions that join it with other meshes of a compound; null of an asset that is no mesh.
  [[nodiscard]] virtual const MeshJoining* mesh_joining() const { return nullptr; }

  /// The curve of a path; null for other assets.
  [[nodiscard]] virtual const Curve* curve() const { return nullptr; }

  /// Calls the visitor for every part whose bounds meet `region` (asset frame, closed), in
  /// ascending order of part.
  virtual void visit_parts(const LocalBounds& region, PartVisitor& visitor) const = 0;

  /// Calls the visitor for parts whose bounds a box meets within the fraction of its way that the
  /// visitor still asks for; order not promised. The box, of half extents `reach`, goes from
  /// `origin` by `translation`, asset frame; without extents it is a ray.
  virtual void visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                                  const Vec3<Length>& reach, WayPartVisitor& visitor) const = 0;

  /// Calls the visitor for parts whose bounds come as near to `point` (asset frame) as `reach`, and
  /// then as near as the visitor still asks for; order not promised.
  virtual void visit_parts_near(const Vec3<Length>& point, Length reach,
                                NearPartVisitor& visitor) const = 0;

 protected:
  AssetGeometry() = default;
};

/// Null of none.
[[nodiscard]] inline const AssetGeometry* geometry_of(const Asset* asset) {
  return asset == nullptr ? nullptr : &asset->geometry();
}

}  // namespace lockstone::geometry
