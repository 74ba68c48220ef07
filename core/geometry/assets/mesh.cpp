#include <algorithm>

#include <lockstone/mesh.h>

#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/mesh_data.h"
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

}  // namespace

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
  number_vertices_by_use(soup);
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

}  // namespace geometry

using geometry::MeshData;

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
  }
  return "unknown";
}

Mesh::Mesh(AssetId id, std::unique_ptr<const MeshData> data)
    : Asset(ShapeKind::mesh, id), data_(std::move(data)) {}

Mesh::~Mesh() = default;

MeshResult Mesh::build(const MeshDef& def) {
  MeshResult result;
  const geometry::MeshRefusal refusal = geometry::check(def);
  result.fault = refusal.fault;
  result.index = refusal.index;
  if (result.fault != MeshFault::none) return result;
  geometry::TriangleSoup soup{{def.vertices.begin(), def.vertices.end()},
                              {def.triangles.begin(), def.triangles.end()},
                              {def.triangle_surfaces.begin(), def.triangle_surfaces.end()}};
  const geometry::SoupCounts counts = geometry::canonicalise(soup, def.weld_tolerance);
  result.welded_vertices = counts.welded_vertices;
  result.degenerate_triangles = counts.degenerate_triangles;
  result.duplicate_triangles = counts.duplicate_triangles;
  if (soup.triangles.empty()) {
    result.fault = MeshFault::empty;
    return result;
  }
  const AssetId id = geometry::id_of(geometry::encode_mesh(soup, def.surfaces, def.flat_angle));
  auto data = std::make_unique<const MeshData>(geometry::make_mesh_data(
      std::move(soup), {def.surfaces.begin(), def.surfaces.end()}, def.flat_angle));
  result.mesh.reset(new Mesh(id, std::move(data)));
  return result;
}

std::uint32_t Mesh::triangle_count() const {
  return static_cast<std::uint32_t>(data_->soup.triangles.size());
}

std::uint32_t Mesh::vertex_count() const {
  return static_cast<std::uint32_t>(data_->soup.vertices.size());
}

std::size_t Mesh::memory_bytes() const {
  const geometry::TriangleSoup& soup = data_->soup;
  return sizeof(*this) + sizeof(*data_) + soup.vertices.size() * sizeof(soup.vertices[0]) +
         soup.triangles.size() * sizeof(soup.triangles[0]) + soup.surfaces.size() +
         data_->surfaces.size() * sizeof(Surface) + data_->tree.memory_bytes();
}

std::vector<std::byte> Mesh::canonical_bytes() const {
  return geometry::encode_mesh(geometry::canonical_soup(*data_), data_->surfaces,
                               data_->flat_angle);
}

const geometry::LocalBounds& Mesh::bounds() const {
  return data_->tree.bounds();
}

const geometry::MeshKernels* Mesh::mesh_kernels() const {
  return &geometry::mesh_kernels();
}

namespace {

// Triangles that the window meets within the visitor's present limit.
template <class Window, class Limit, class Visitor>
void visit_nearest_first(const geometry::MeshData& data, const Window& window, Limit most,
                         Visitor& visitor) {
  geometry::TrianglePart part;
  const auto visit = [&](std::uint32_t first, std::uint32_t count, std::int64_t limit) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const geometry::TriangleVertices triangle = data.triangle(i);
      std::int64_t at = 0;
      if (!window.meets(geometry::bounds_of(triangle), limit, at)) continue;
      limit = window.limit_of(
          visitor.visit(part.set(i, triangle, data.active_edges(i), data.surface(i))));
    }
    return limit;
  };
  data.tree.nearest_first(window, window.limit_of(most), visit);
}

}  // namespace

void Mesh::visit_parts(const geometry::LocalBounds& region, geometry::PartVisitor& visitor) const {
  geometry::TrianglePart part;
  data_->tree.overlapping(region, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const geometry::TriangleVertices triangle = data_->triangle(i);
      if (!overlap(geometry::bounds_of(triangle), region)) continue;
      visitor.visit(part.set(i, triangle, data_->active_edges(i), data_->surface(i)));
    }
  });
}

void Mesh::visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                              const Vec3<Length>& reach, geometry::WayPartVisitor& visitor) const {
  visit_nearest_first(*data_, geometry::RayWindow(origin, translation, reach),
                      Unit::from_integer(1), visitor);
}

void Mesh::visit_parts_near(const Vec3<Length>& point, Length reach,
                            geometry::NearPartVisitor& visitor) const {
  visit_nearest_first(*data_, geometry::NearWindow(point), reach, visitor);
}

}  // namespace lockstone
