// Triangle meshes: surfaces of up to a million triangles, for static and kinematic bodies.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <lockstone/asset.h>

namespace lockstone {

inline constexpr std::uint32_t k_max_mesh_triangles = std::uint32_t{1} << 20;
inline constexpr std::uint32_t k_max_mesh_vertices = 3 * k_max_mesh_triangles;
/// Groups of triangles have numbers below this.
inline constexpr std::uint32_t k_max_mesh_groups = 4096;

/// Three vertices, counter-clockwise seen from the front. A mesh is met from the front only.
struct TriangleIndices {
  std::uint32_t a = 0;
  std::uint32_t b = 0;
  std::uint32_t c = 0;

  friend constexpr auto operator<=>(const TriangleIndices&, const TriangleIndices&) = default;
};

/// Definition of a mesh; read during `Mesh::build` only.
struct MeshDef {
  std::span<const Vec3<Length>> vertices;  ///< within ±512 m; at most k_max_mesh_vertices
  std::span<const TriangleIndices> triangles;

  /// For each triangle an index into `surfaces`, or k_own_surface; empty: all k_own_surface.
  std::span<const std::uint8_t> triangle_surfaces;
  std::span<const Surface> surfaces;  ///< at most k_max_surfaces

  /// Vertices whose coordinates differ by at most this become one; 0: only equal ones. At most 1 m.
  Length weld_tolerance{};

  /// A convex edge whose faces' normals differ by at most this is met as if it were flat. From 0
  /// (every convex edge is an edge) to 1 rad.
  Angle flat_angle = Angle::from_ratio(1, 50);

  /// For each triangle the number of its group, which a world may switch off (SetMeshGroup); empty:
  /// all are of group 0, and none can be.
  std::span<const std::uint16_t> triangle_groups{};
};

/// Why a mesh was refused.
enum class MeshFault : std::uint8_t {
  none = 0,
  empty,                    ///< no triangle, or none with area
  too_many,                 ///< triangles, vertices or surfaces
  index_out_of_range,       ///< a triangle names no vertex
  coordinate_out_of_range,  ///< a vertex beyond k_max_asset_coordinate
  surface_out_of_range,     ///< a triangle names no surface, or not one index for each triangle
  invalid_surface,          ///< a property or rule outside the ranges of Surface
  invalid_option,           ///< weld_tolerance or flat_angle out of range
  group_out_of_range,       ///< k_max_mesh_groups or more, or not one group for each triangle
};

/// A short lower-case English text, for logs.
[[nodiscard]] std::string_view to_string(MeshFault fault);

class Mesh;

struct [[nodiscard]] MeshResult {
  std::shared_ptr<const Mesh> mesh;  ///< null when refused
  MeshFault fault = MeshFault::none;
  std::uint32_t index = 0;  ///< of the offending triangle, vertex or surface

  // Dropped while building.
  std::uint32_t welded_vertices = 0;       ///< equal to another within the tolerance
  std::uint32_t degenerate_triangles = 0;  ///< without area, after welding
  std::uint32_t duplicate_triangles = 0;   ///< the same three vertices, turned the same way

  [[nodiscard]] bool ok() const { return mesh != nullptr; }
  [[nodiscard]] explicit operator bool() const { return ok(); }
};

/// The order of vertices and triangles in the definition does not matter: parts are numbered by
/// place. Where the weld tolerance is not 0, a vertex joins the first in the order of x, y, z that
/// is within reach and stands for others already. Triangles without area and repeated ones are
/// dropped and counted; of repeated ones the lowest surface index stays, and of these the lowest
/// group.
///
/// Memory: 12 bytes a vertex; 12 a triangle, 1 more where there are surfaces, 2 where there are
/// groups, and about 22 for the tree; 8 a side of an edge between two groups.
class Mesh final : public Asset {
 public:
  [[nodiscard]] static MeshResult build(const MeshDef& def);

  /// From canonical bytes of any origin: truncated, malformed, unsupported_version, or the mesh
  /// with exactly these canonical bytes.
  [[nodiscard]] static Result<std::shared_ptr<const Mesh>> from_bytes(ByteView bytes);

  [[nodiscard]] std::uint32_t triangle_count() const;
  [[nodiscard]] std::uint32_t vertex_count() const;
  [[nodiscard]] std::size_t memory_bytes() const;

  [[nodiscard]] std::vector<std::byte> canonical_bytes() const override;

 private:
  Mesh(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry);
};

}  // namespace lockstone
