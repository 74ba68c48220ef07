#include <algorithm>

#include <lockstone/mesh.h>

#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/joined_meshes.h"
#include "core/geometry/assets/mesh_editing.h"
#include "core/geometry/assets/mesh_geometry.h"
#include "core/geometry/assets/mesh_walk.h"
#include "core/geometry/mesh_contact/mesh_kernels.h"

namespace lockstone {
namespace geometry {
namespace {

struct MeshRefusal {
  MeshFault fault = MeshFault::none;
  std::uint32_t index = 0;
};

constexpr Length k_max_weld_tolerance = Length::from_integer(1);

MeshRefusal check_sizes(const MeshDef& def) {
  if (def.triangles.empty()) return {MeshFault::empty};
  const bool too_many = def.triangles.size() > k_max_mesh_triangles ||
                        def.vertices.size() > k_max_mesh_vertices ||
                        def.surfaces.size() > k_max_surfaces;
  if (too_many) return {MeshFault::too_many};
  const bool options = def.weld_tolerance >= Length{} &&
                       def.weld_tolerance <= k_max_weld_tolerance && def.flat_angle >= Angle{} &&
                       def.flat_angle <= k_max_flat_angle;
  if (!options) return {MeshFault::invalid_option};
  if (!def.triangle_surfaces.empty() && def.triangle_surfaces.size() != def.triangles.size())
    return {MeshFault::surface_out_of_range};
  if (!def.triangle_groups.empty() && def.triangle_groups.size() != def.triangles.size())
    return {MeshFault::group_out_of_range};
  return {};
}

MeshRefusal check_surfaces(const MeshDef& def) {
  for (std::uint32_t i = 0; i < def.surfaces.size(); ++i)
    if (!is_valid(def.surfaces[i])) return {MeshFault::invalid_surface, i};
  for (std::uint32_t i = 0; i < def.triangle_surfaces.size(); ++i) {
    const std::uint8_t surface = def.triangle_surfaces[i];
    if (surface != k_own_surface && surface >= def.surfaces.size())
      return {MeshFault::surface_out_of_range, i};
  }
  for (std::uint32_t i = 0; i < def.triangle_groups.size(); ++i)
    if (def.triangle_groups[i] >= k_max_mesh_groups) return {MeshFault::group_out_of_range, i};
  return {};
}

MeshRefusal check_geometry(const MeshDef& def) {
  for (std::uint32_t i = 0; i < def.vertices.size(); ++i)
    if (!is_asset_coordinate(def.vertices[i])) return {MeshFault::coordinate_out_of_range, i};
  for (std::uint32_t i = 0; i < def.triangles.size(); ++i) {
    const TriangleIndices& t = def.triangles[i];
    if (std::max({t.a, t.b, t.c}) >= def.vertices.size()) return {MeshFault::index_out_of_range, i};
  }
  return {};
}

MeshRefusal check(const MeshDef& def) {
  MeshRefusal refusal = check_sizes(def);
  if (refusal.fault == MeshFault::none) refusal = check_surfaces(def);
  if (refusal.fault == MeshFault::none) refusal = check_geometry(def);
  return refusal;
}

/// Numbers the vertices by first use, so that neighbours lie together.
void number_vertices_by_use(TriangleSoup& soup) {
  constexpr std::uint32_t none = 0xffffffff;
  std::vector<std::uint32_t> place(soup.vertices.size(), none);
  std::vector<Vec3<Length>> used;
  used.reserve(soup.vertices.size());
  const auto renumber = [&](std::uint32_t& vertex) {
    if (place[vertex] == none) {
      place[vertex] = static_cast<std::uint32_t>(used.size());
      used.push_back(soup.vertices[vertex]);
    }
    vertex = place[vertex];
  };
  for (TriangleIndices& t : soup.triangles) {
    renumber(t.a);
    renumber(t.b);
    renumber(t.c);
  }
  soup.vertices = std::move(used);
}

template <class T>
std::vector<T> reordered(const std::vector<T>& items, std::span<const std::uint32_t> order) {
  std::vector<T> result;
  result.reserve(items.size());
  for (const std::uint32_t i : order)
    result.push_back(items[i]);
  return result;
}

std::vector<MeshGroup> groups_of(const TriangleSoup& soup) {
  std::vector<MeshGroup> groups(soup.groups.empty() ? 0 : k_max_mesh_groups);
  std::vector<bool> exists(groups.size());
  for (std::uint32_t i = 0; i < soup.groups.size(); ++i) {
    const std::uint16_t group = soup.groups[i];
    if (group == k_no_group) continue;
    const LocalBounds bounds = bounds_of(soup.triangle(i));
    LocalBounds& all = groups[group].bounds;
    if (!exists[group]) all = bounds;
    exists[group] = true;
    for (int axis = 0; axis < 3; ++axis) {
      all.lower[axis] = min(all.lower[axis], bounds.lower[axis]);
      all.upper[axis] = max(all.upper[axis], bounds.upper[axis]);
    }
  }
  for (std::size_t i = 0; i < groups.size(); ++i)
    groups[i].group = static_cast<std::uint16_t>(i);
  std::erase_if(groups, [&](const MeshGroup& group) { return !exists[group.group]; });
  return groups;
}

}  // namespace

const MeshGroup* find_group(const MeshData& data, std::uint32_t group) {
  const auto at = std::ranges::lower_bound(data.groups, group, {}, &MeshGroup::group);
  return at != data.groups.end() && at->group == group ? &*at : nullptr;
}

MeshData make_mesh_data(TriangleSoup soup, std::vector<Surface> surfaces, Angle flat_angle) {
  MeshData data;
  const std::vector<std::uint8_t> active = classify_edges(soup, flat_angle);
  std::vector<LocalBounds> bounds;
  bounds.reserve(soup.triangles.size());
  for (std::uint32_t i = 0; i < soup.triangles.size(); ++i)
    bounds.push_back(bounds_of(soup.triangle(i)));
  std::vector<std::uint32_t> order;
  data.tree = StaticTree::build(bounds, order);
  soup.triangles = reordered(soup.triangles, order);
  if (!soup.surfaces.empty()) soup.surfaces = reordered(soup.surfaces, order);
  if (!soup.groups.empty()) soup.groups = reordered(soup.groups, order);
  if (!soup.sources.empty()) soup.sources = reordered(soup.sources, order);
  number_vertices_by_use(soup);
  data.groups = groups_of(soup);
  if (!soup.groups.empty()) data.group_edges = shared_edges(soup);
  for (std::size_t i = 0; i < order.size(); ++i) {
    TriangleIndices& t = soup.triangles[i];
    const std::uint32_t edges = active[order[i]];
    t.a |= (edges & 1U) << 31;
    t.b |= (edges & 2U) << 30;
    t.c |= (edges & 4U) << 29;
  }
  data.soup = std::move(soup);
  data.surfaces = std::move(surfaces);
  data.flat_angle = flat_angle;
  return data;
}

TriangleSoup canonical_soup(const MeshData& data) {
  TriangleSoup soup = data.soup;
  for (std::uint32_t i = 0; i < soup.triangles.size(); ++i)
    soup.triangles[i] = data.indices(i);
  canonicalise(soup, {});
  return soup;
}

const MeshKernels* MeshGeometry::mesh_kernels() const {
  return &geometry::mesh_kernels();
}

const MeshEditing* MeshGeometry::mesh_editing() const {
  return data_.groups.empty() ? nullptr : &geometry::mesh_editing();
}

const MeshJoining* MeshGeometry::mesh_joining() const {
  return &geometry::mesh_joining();
}

void MeshGeometry::visit_parts(const LocalBounds& region, PartVisitor& visitor) const {
  visit_triangles(data_, AllTriangles{data_}, region, visitor);
}

void MeshGeometry::visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                                      const Vec3<Length>& reach, WayPartVisitor& visitor) const {
  visit_nearest_first(data_, AllTriangles{data_}, RayWindow(origin, translation, reach),
                      Unit::from_integer(1), visitor);
}

void MeshGeometry::visit_parts_near(const Vec3<Length>& point, Length reach,
                                    NearPartVisitor& visitor) const {
  visit_nearest_first(data_, AllTriangles{data_}, NearWindow(point), reach, visitor);
}

}  // namespace geometry

std::string_view to_string(MeshFault fault) {
  switch (fault) {
    case MeshFault::none:
      return "none";
    case MeshFault::empty:
      return "no triangle with area";
    case MeshFault::too_many:
      return "too many triangles, vertices or surfaces";
    case MeshFault::index_out_of_range:
      return "triangle names no vertex";
    case MeshFault::coordinate_out_of_range:
      return "coordinate out of range";
    case MeshFault::surface_out_of_range:
      return "triangle names no surface";
    case MeshFault::invalid_surface:
      return "surface out of range";
    case MeshFault::invalid_option:
      return "option out of range";
    case MeshFault::group_out_of_range:
      return "group out of range";
  }
  return "unknown";
}

Mesh::Mesh(AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry)
    : Asset(ShapeKind::mesh, id, std::move(geometry)) {}

MeshResult Mesh::build(const MeshDef& def) {
  MeshResult result;
  const geometry::MeshRefusal refusal = geometry::check(def);
  result.fault = refusal.fault;
  result.index = refusal.index;
  if (result.fault != MeshFault::none) return result;
  geometry::TriangleSoup soup{{def.vertices.begin(), def.vertices.end()},
                              {def.triangles.begin(), def.triangles.end()},
                              {def.triangle_surfaces.begin(), def.triangle_surfaces.end()},
                              {def.triangle_groups.begin(), def.triangle_groups.end()},
                              {}};
  const geometry::SoupCounts counts = geometry::canonicalise(soup, def.weld_tolerance);
  result.welded_vertices = counts.welded_vertices;
  result.degenerate_triangles = counts.degenerate_triangles;
  result.duplicate_triangles = counts.duplicate_triangles;
  if (soup.triangles.empty()) {
    result.fault = MeshFault::empty;
    return result;
  }
  const AssetId id = geometry::id_of(geometry::encode_mesh(soup, def.surfaces, def.flat_angle));
  result.mesh.reset(new Mesh(
      id, std::make_unique<const geometry::MeshGeometry>(geometry::make_mesh_data(
              std::move(soup), {def.surfaces.begin(), def.surfaces.end()}, def.flat_angle))));
  return result;
}

std::uint32_t Mesh::triangle_count() const {
  return static_cast<std::uint32_t>(geometry::mesh_data(geometry()).soup.triangles.size());
}

std::uint32_t Mesh::vertex_count() const {
  return static_cast<std::uint32_t>(geometry::mesh_data(geometry()).soup.vertices.size());
}

std::size_t Mesh::memory_bytes() const {
  const geometry::MeshData& data = geometry::mesh_data(geometry());
  const geometry::TriangleSoup& soup = data.soup;
  return sizeof(*this) + sizeof(geometry::MeshGeometry) +
         soup.vertices.size() * sizeof(soup.vertices[0]) +
         soup.triangles.size() * sizeof(soup.triangles[0]) + soup.surfaces.size() +
         2 * soup.groups.size() + data.groups.size() * sizeof(geometry::MeshGroup) +
         data.group_edges.size() * sizeof(geometry::SharedEdge) +
         data.surfaces.size() * sizeof(Surface) + data.tree.memory_bytes();
}

std::vector<std::byte> Mesh::canonical_bytes() const {
  const geometry::MeshData& data = geometry::mesh_data(geometry());
  return geometry::encode_mesh(geometry::canonical_soup(data), data.surfaces, data.flat_angle);
}

}  // namespace lockstone
