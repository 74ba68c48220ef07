// The data of a mesh, and the steps by which it is made.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/mesh.h>

#include "core/geometry/assets/static_tree.h"
#include "core/geometry/mesh_contact/triangle_polytope.h"

namespace lockstone::geometry {

/// The group of triangles that no world switches, beside others of joined meshes.
inline constexpr std::uint16_t k_no_group = 0xffff;
static_assert(k_no_group >= k_max_mesh_groups);

/// A triangle of a child of a compound.
struct TriangleSource {
  std::uint32_t child = 0;
  std::uint32_t triangle = 0;  ///< by its place in the child's mesh

  friend constexpr auto operator<=>(const TriangleSource&, const TriangleSource&) = default;
};

/// Vertices and triangles before the tree is built.
struct TriangleSoup {
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;
  std::vector<std::uint8_t> surfaces;   ///< one for each triangle, or empty: k_own_surface
  std::vector<std::uint16_t> groups;    ///< one for each triangle, or empty: all 0
  std::vector<TriangleSource> sources;  ///< one for each triangle of joined meshes, else empty

  [[nodiscard]] TriangleVertices triangle(const TriangleIndices& t) const {
    return {vertices[t.a], vertices[t.b], vertices[t.c]};
  }
  [[nodiscard]] TriangleVertices triangle(std::uint32_t index) const {
    return triangle(triangles[index]);
  }
};

struct SoupCounts {
  std::uint32_t welded_vertices = 0;
  std::uint32_t degenerate_triangles = 0;
  std::uint32_t duplicate_triangles = 0;
};

/// Brings the soup to its canonical form: vertices welded, in the order of x, y, z, each used;
/// triangles begin with their lowest vertex and ascend, without repeats and all with area.
SoupCounts canonicalise(TriangleSoup& soup, Length weld_tolerance);

/// For each vertex the vertex that it becomes. `vertices` ascend; representatives stand for
/// themselves, and no two of them are within the tolerance.
[[nodiscard]] std::vector<std::uint32_t> weld(std::span<const Vec3<Length>> vertices,
                                              Length tolerance);

/// The active edges of each triangle, bits 0 … 2. Edges with one triangle, with more than two, or
/// between triangles of opposite winding are active.
[[nodiscard]] std::vector<std::uint8_t> classify_edges(const TriangleSoup& soup, Angle flat_angle);

/// A side of an edge between triangles of two groups, and the group on its other side.
struct SharedEdge {
  std::uint32_t corner = 0;  ///< triangle · 4 + edge
  std::uint16_t group = 0;
};

/// Those of a soup of groups, by corner.
[[nodiscard]] std::vector<SharedEdge> shared_edges(const TriangleSoup& soup);

/// The triangles of a group.
struct MeshGroup {
  std::uint16_t group = 0;
  LocalBounds bounds;
};

struct MeshData {
  TriangleSoup soup;  ///< triangles in the order of the tree; the highest bit
                      ///< of each index says whether its edge is active
  std::vector<Surface> surfaces;
  Angle flat_angle{};
  StaticTree tree;
  std::vector<MeshGroup> groups;        ///< ascending; empty of a mesh without groups
  std::vector<SharedEdge> group_edges;  ///< by corner
  std::uint32_t first_part = 0;         ///< the number of the first triangle as a part

  static constexpr std::uint32_t k_active = std::uint32_t{1} << 31;

  [[nodiscard]] TriangleIndices indices(std::uint32_t index) const {
    const TriangleIndices& t = soup.triangles[index];
    return {t.a & ~k_active, t.b & ~k_active, t.c & ~k_active};
  }
  [[nodiscard]] TriangleVertices triangle(std::uint32_t index) const {
    return soup.triangle(indices(index));
  }
  [[nodiscard]] std::uint8_t active_edges(std::uint32_t index) const {
    const TriangleIndices& t = soup.triangles[index];
    return static_cast<std::uint8_t>((t.a >> 31) | ((t.b >> 31) << 1) | ((t.c >> 31) << 2));
  }
  [[nodiscard]] const Surface* surface(std::uint32_t index) const {
    if (soup.surfaces.empty() || soup.surfaces[index] == k_own_surface) return nullptr;
    return &surfaces[soup.surfaces[index]];
  }
};

/// The tree, the numbering that follows from it, and the edges, from a canonical soup.
[[nodiscard]] MeshData make_mesh_data(TriangleSoup soup, std::vector<Surface> surfaces,
                                      Angle flat_angle);

/// Whether the group has triangles, of a mesh of groups.
[[nodiscard]] const MeshGroup* find_group(const MeshData& data, std::uint32_t group);

/// The canonical bytes of a canonical soup.
[[nodiscard]] std::vector<std::byte> encode_mesh(const TriangleSoup& soup,
                                                 std::span<const Surface> surfaces,
                                                 Angle flat_angle);

/// The reverse of the renumbering: the canonical soup of a mesh.
[[nodiscard]] TriangleSoup canonical_soup(const MeshData& data);

}  // namespace lockstone::geometry
