#include <algorithm>
#include <optional>

#include <lockstone/scaled_asset.h>

#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/height_field_geometry.h"
#include "core/geometry/assets/mesh_geometry.h"

namespace lockstone {
namespace {

bool are_factors(const Vec3<Number>& factors) {
  return factors.x != Number{} && factors.y != Number{} && factors.z != Number{};
}

bool mirrors(const Vec3<Number>& factors) {
  return (factors.x < Number{}) != ((factors.y < Number{}) != (factors.z < Number{}));
}

/// Nothing beyond the coordinates of an asset.
std::optional<Length> scaled_length(Length x, Number factor) {
  const std::optional<Length> product = try_rounded<Length>(x * factor);
  return product && geometry::is_asset_coordinate(*product) ? product : std::nullopt;
}

/// Scales points in place; the number of the first one that leaves the range, or of them all.
std::size_t scale_points(std::vector<Vec3<Length>>& points, const Vec3<Number>& factors) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::optional<Length> x = scaled_length(points[i][axis], factors[axis]);
      if (!x) return i;
      points[i][axis] = *x;
    }
  }
  return points.size();
}

MeshResult refused(MeshFault fault, std::size_t index = 0) {
  MeshResult result;
  result.fault = fault;
  result.index = static_cast<std::uint32_t>(index);
  return result;
}

HeightFieldResult refused(HeightFieldFault fault, std::size_t index = 0) {
  return {nullptr, fault, static_cast<std::uint32_t>(index)};
}

/// A byte for each cell, of a bit for each.
std::vector<std::uint8_t> bytes_of(const std::vector<std::uint8_t>& bits, std::size_t cells) {
  std::vector<std::uint8_t> bytes(bits.empty() ? 0 : cells);
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = (bits[i / 8] >> (i % 8)) & 1;
  return bytes;
}

}  // namespace

HullResult scaled(const Hull& hull, const Vec3<Number>& factors) {
  const Vec3<Number> sizes{abs(factors.x), abs(factors.y), abs(factors.z)};
  const bool even = sizes.x == sizes.y && sizes.y == sizes.z;
  const std::optional<Length> radius = scaled_length(hull.radius(), sizes.x);
  if (!are_factors(factors) || (hull.radius() != Length{} && !even))
    return {nullptr, HullFault::invalid_options, {}};
  std::vector<Vec3<Length>> vertices(hull.vertices().begin(), hull.vertices().end());
  if (!radius || scale_points(vertices, factors) < vertices.size())
    return {nullptr, HullFault::coordinate_out_of_range, {}};
  HullOptions options;
  options.tolerance = saturated<Length>(hull.tolerance() * max(max(sizes.x, sizes.y), sizes.z));
  options.max_vertices = k_max_hull_vertices;
  options.radius = *radius;
  return Hull::build(vertices, options);
}

MeshResult scaled(const Mesh& mesh, const Vec3<Number>& factors) {
  if (!are_factors(factors)) return refused(MeshFault::invalid_option);
  const geometry::MeshData& data = geometry::mesh_data(mesh.geometry());
  geometry::TriangleSoup soup = geometry::canonical_soup(data);
  const std::size_t beyond = scale_points(soup.vertices, factors);
  if (beyond < soup.vertices.size()) return refused(MeshFault::coordinate_out_of_range, beyond);
  if (mirrors(factors))
    for (TriangleIndices& triangle : soup.triangles)
      std::swap(triangle.b, triangle.c);
  return Mesh::build({soup.vertices,
                      soup.triangles,
                      soup.surfaces,
                      data.surfaces,
                      {},
                      data.flat_angle,
                      soup.groups});
}

HeightFieldResult scaled(const HeightField& field, const Vec3<Number>& factors) {
  if (factors.x <= Number{} || factors.y <= Number{} || factors.z <= Number{})
    return refused(HeightFieldFault::invalid_option);
  const geometry::HeightFieldData& data = geometry::height_field_data(field.geometry());
  const std::optional<Length> x = scaled_length(data.origin_x, factors.x);
  const std::optional<Length> z = scaled_length(data.origin_z, factors.z);
  const std::optional<Length> cell_x = scaled_length(data.cell_x, factors.x);
  const std::optional<Length> cell_z = scaled_length(data.cell_z, factors.z);
  if (!x || !z || !cell_x || !cell_z) return refused(HeightFieldFault::coordinate_out_of_range);
  std::vector<Length> heights;
  heights.reserve(data.heights.size());
  for (const Length height : data.heights) {
    const std::optional<Length> y = scaled_length(height, factors.y);
    if (!y) return refused(HeightFieldFault::coordinate_out_of_range, heights.size());
    heights.push_back(*y);
  }
  HeightFieldDef def;
  def.columns = field.columns();
  def.rows = field.rows();
  def.origin = {*x, Length{}, *z};
  def.cell_x = *cell_x;
  def.cell_z = *cell_z;
  def.heights = heights;
  const std::vector<std::uint8_t> holes = bytes_of(data.holes, data.cell_count());
  def.holes = holes;
  def.cell_surfaces = data.cell_surfaces;
  def.surfaces = data.surfaces;
  def.flat_angle = data.flat_angle;
  return HeightField::build(def);
}

}  // namespace lockstone
