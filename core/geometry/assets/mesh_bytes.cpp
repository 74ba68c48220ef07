// The canonical bytes of meshes.
//
//   header (asset_frame.h), version 2
//   i32 flat angle; u32 vertices, triangles; u16 surfaces; u8: 1 triangles have surfaces, 2 groups
//   i32 x, y, z of each vertex; u32 a, b, c of each triangle; i32 friction, restitution of each
//   surface; u8 surface of each triangle; u16 group of each triangle
#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/mesh_data.h"

namespace lockstone {
namespace geometry {
namespace {

constexpr std::uint16_t k_mesh_version = 2;
constexpr std::size_t k_mesh_counts_bytes = 15;

struct MeshCounts {
  Angle flat_angle{};
  std::uint32_t vertices = 0;
  std::uint32_t triangles = 0;
  std::uint16_t surfaces = 0;
  bool has_surfaces = false;
  bool has_groups = false;

  /// Of all that follows the counts.
  [[nodiscard]] std::uint64_t bytes() const {
    const std::uint64_t a_triangle = 12U + (has_surfaces ? 1U : 0U) + (has_groups ? 2U : 0U);
    return 12 * std::uint64_t{vertices} + a_triangle * triangles +
           k_surface_bytes * std::uint64_t{surfaces};
  }
};

Status read_counts(ByteReader& reader, MeshCounts& counts) {
  counts.flat_angle.raw = reader.get<std::int32_t>();
  counts.vertices = reader.get<std::uint32_t>();
  counts.triangles = reader.get<std::uint32_t>();
  counts.surfaces = reader.get<std::uint16_t>();
  const auto flags = reader.get<std::uint8_t>();
  counts.has_surfaces = (flags & 1U) != 0;
  counts.has_groups = (flags & 2U) != 0;
  if (!reader.ok()) return Status::truncated;
  const bool known = flags <= 3 && counts.vertices <= k_max_mesh_vertices &&
                     counts.triangles <= k_max_mesh_triangles && counts.surfaces <= k_max_surfaces;
  if (!known) return Status::malformed;
  if (counts.bytes() > reader.remaining()) return Status::truncated;
  return counts.bytes() == reader.remaining() ? Status::ok : Status::malformed;
}

void read_payload(ByteReader& reader, const MeshCounts& counts, TriangleSoup& soup,
                  std::vector<Surface>& surfaces) {
  soup.vertices.resize(counts.vertices);
  for (Vec3<Length>& v : soup.vertices)
    v = get_vector(reader);
  soup.triangles.resize(counts.triangles);
  for (TriangleIndices& t : soup.triangles) {
    t.a = reader.get<std::uint32_t>();
    t.b = reader.get<std::uint32_t>();
    t.c = reader.get<std::uint32_t>();
  }
  surfaces.resize(counts.surfaces);
  for (Surface& surface : surfaces)
    surface = get_surface(reader);
  soup.surfaces.resize(counts.has_surfaces ? counts.triangles : 0);
  for (std::uint8_t& index : soup.surfaces)
    index = reader.get<std::uint8_t>();
  soup.groups.resize(counts.has_groups ? counts.triangles : 0);
  for (std::uint16_t& group : soup.groups)
    group = reader.get<std::uint16_t>();
}

}  // namespace

std::vector<std::byte> encode_mesh(const TriangleSoup& soup, std::span<const Surface> surfaces,
                                   Angle flat_angle) {
  const MeshCounts counts{flat_angle,
                          static_cast<std::uint32_t>(soup.vertices.size()),
                          static_cast<std::uint32_t>(soup.triangles.size()),
                          static_cast<std::uint16_t>(surfaces.size()),
                          !soup.surfaces.empty(),
                          !soup.groups.empty()};
  std::vector<std::byte> bytes(k_asset_header_bytes + k_mesh_counts_bytes + counts.bytes());
  ByteWriter writer(bytes);
  put_asset_header(writer, ShapeKind::mesh, k_mesh_version);
  writer.put(flat_angle.raw);
  writer.put(counts.vertices);
  writer.put(counts.triangles);
  writer.put(counts.surfaces);
  writer.put(
      static_cast<std::uint8_t>((counts.has_surfaces ? 1 : 0) | (counts.has_groups ? 2 : 0)));
  for (const Vec3<Length>& v : soup.vertices)
    put_vector(writer, v);
  for (const TriangleIndices& t : soup.triangles) {
    writer.put(t.a);
    writer.put(t.b);
    writer.put(t.c);
  }
  for (const Surface& surface : surfaces)
    put_surface(writer, surface);
  for (const std::uint8_t index : soup.surfaces)
    writer.put(index);
  for (const std::uint16_t group : soup.groups)
    writer.put(group);
  LKS_CHECK(writer.ok() && writer.size() == bytes.size());
  return bytes;
}

}  // namespace geometry

Result<std::shared_ptr<const Mesh>> Mesh::from_bytes(ByteView bytes) {
  using namespace geometry;
  ByteReader reader(bytes);
  MeshCounts counts;
  if (const Status s = read_asset_header(reader, ShapeKind::mesh, k_mesh_version); s != Status::ok)
    return s;
  if (const Status s = read_counts(reader, counts); s != Status::ok) return s;
  TriangleSoup soup;
  std::vector<Surface> surfaces;
  read_payload(reader, counts, soup, surfaces);
  MeshDef def{soup.vertices,     soup.triangles, soup.surfaces, surfaces, {},
              counts.flat_angle, soup.groups};
  MeshResult result = build(def);
  // Two files of one geometry must not have two names.
  if (!result.ok() || result.mesh->id() != id_of(bytes)) return Status::malformed;
  return std::move(result.mesh);
}

}  // namespace lockstone
