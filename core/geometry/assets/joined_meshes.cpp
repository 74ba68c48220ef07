#include "core/geometry/assets/joined_meshes.h"

#include <algorithm>
#include <vector>

#include "core/geometry/assets/mesh_geometry.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {
namespace {

/// To the nearest step along each axis.
Vec3<Length> placed_vertex(const PlacedMesh& placed, const Vec3<Length>& vertex) {
  Vec3<Length> result;
  for (int axis = 0; axis < 3; ++axis) {
    std::int64_t sum = 0;  // below 2^61
    for (int i = 0; i < 3; ++i)
      sum += (placed.rotation.column(i)[axis] * vertex[i]).raw;
    const std::int64_t steps = placed.position[axis].raw + raw::round_shift(sum, Unit::frac_bits);
    result[axis].raw = raw::saturate<std::int32_t>(steps);
  }
  return result;
}

/// The meshes in the making.
class MeshJoiner {
 public:
  /// Nothing is added after a fault.
  [[nodiscard]] JoinFault add(const PlacedMesh& placed) {
    const MeshData& data = mesh_data(placed.mesh);
    const auto base = static_cast<std::uint32_t>(soup_.vertices.size());
    const auto count = static_cast<std::uint32_t>(data.soup.triangles.size());
    if (soup_.triangles.size() + count > k_max_mesh_triangles) return JoinFault::too_many_triangles;
    for (const Vec3<Length>& vertex : data.soup.vertices)
      soup_.vertices.push_back(placed_vertex(placed, vertex));
    for (std::uint32_t i = 0; i < count; ++i) {
      const Surface* own = data.surface(i);
      const std::optional<std::uint8_t> surface = index_of(own == nullptr ? placed.surface : own);
      if (!surface) return JoinFault::too_many_surfaces;
      const TriangleIndices t = data.indices(i);
      soup_.triangles.push_back({t.a + base, t.b + base, t.c + base});
      soup_.surfaces.push_back(*surface);
      soup_.groups.push_back(data.soup.groups.empty() ? k_no_group : data.soup.groups[i]);
      soup_.sources.push_back({placed.child, i});
    }
    flat_angle_ = min(flat_angle_, data.flat_angle);
    return JoinFault::none;
  }

  /// Null where no triangle is left.
  [[nodiscard]] std::unique_ptr<const AssetGeometry> finished() {
    if (std::ranges::count(soup_.groups, k_no_group) == std::ssize(soup_.groups))
      soup_.groups.clear();
    (void)canonicalise(soup_, {});
    if (soup_.triangles.empty()) return nullptr;
    MeshData data = make_mesh_data(std::move(soup_), std::move(surfaces_), flat_angle_);
    data.first_part = k_first_triangle_part;
    return std::make_unique<const MeshGeometry>(std::move(data));
  }

 private:
  /// Nothing where there is no room for another surface.
  [[nodiscard]] std::optional<std::uint8_t> index_of(const Surface* surface) {
    if (surface == nullptr) return k_own_surface;
    const auto at = std::ranges::find(surfaces_, *surface) - surfaces_.begin();
    if (at == k_max_surfaces) return std::nullopt;
    if (at == std::ssize(surfaces_)) surfaces_.push_back(*surface);
    return static_cast<std::uint8_t>(at);
  }

  TriangleSoup soup_;
  std::vector<Surface> surfaces_;
  Angle flat_angle_ = Angle::max();
};

JoinedMeshes join(std::span<const PlacedMesh> meshes) {
  MeshJoiner joiner;
  for (const PlacedMesh& mesh : meshes) {
    const JoinFault fault = joiner.add(mesh);
    if (fault != JoinFault::none) return {nullptr, fault, mesh.child};
  }
  JoinedMeshes result{joiner.finished(), JoinFault::none, meshes.front().child};
  if (result.triangles == nullptr) result.fault = JoinFault::empty;
  return result;
}

const TriangleSource* source_of(const AssetGeometry& joined, std::uint32_t part) {
  const std::vector<TriangleSource>& sources = mesh_data(joined).soup.sources;
  const bool exists =
      part >= k_first_triangle_part && part - k_first_triangle_part < sources.size();
  return exists ? &sources[part - k_first_triangle_part] : nullptr;
}

}  // namespace

const MeshJoining& mesh_joining() {
  static constexpr MeshJoining k_joining{join, source_of};
  return k_joining;
}

}  // namespace lockstone::geometry
