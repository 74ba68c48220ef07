// The meshes of a compound as one, behind a pointer that a mesh gives: a program that makes no mesh
// links none of this.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "core/geometry/assets/mesh_data.h"
#include "core/geometry/convex/asset_geometry.h"

namespace lockstone::geometry {

/// A mesh as a child of a compound.
struct PlacedMesh {
  std::uint32_t child = 0;
  const AssetGeometry& mesh;
  Vec3<Length> position{};           ///< of the mesh's frame in the compound's
  Mat3 rotation{};                   ///< of the mesh's frame in the compound's
  const Surface* surface = nullptr;  ///< of triangles without one; null: the body's own
};

enum class JoinFault : std::uint8_t {
  none = 0,
  empty,               ///< no triangle has area once its vertices are rounded
  too_many_triangles,  ///< more than a mesh may have
  too_many_surfaces,   ///< more than a mesh may have
};

struct JoinedMeshes {
  std::unique_ptr<const AssetGeometry> triangles;  ///< null exactly when there is a fault
  JoinFault fault = JoinFault::none;
  std::uint32_t child = 0;  ///< the one that is too many
};

struct MeshJoining {
  /// The triangles of the meshes, which lie within the coordinates of an asset, as those of one
  /// mesh: vertices are rounded to the nearest step, and equal ones are one vertex.
  JoinedMeshes (*join)(std::span<const PlacedMesh> meshes);
  /// The origin of a part of joined meshes; null of another number.
  const TriangleSource* (*source_of)(const AssetGeometry& joined, std::uint32_t part);
};

/// The one table.
[[nodiscard]] const MeshJoining& mesh_joining();

}  // namespace lockstone::geometry
