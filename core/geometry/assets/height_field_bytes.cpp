// The canonical bytes of height fields.
//
//   header (asset_frame.h), version 2
//   i32 flat angle, origin x and z, cell x and z; u16 columns, rows, surfaces; u8 bit 0: holes,
//   bit 1: cells have surfaces
//   i32 height of each sample; the holes, a bit a cell from the lowest up, padded with zeros;
//   surfaces; u8 surface of each cell
#include "core/geometry/assets/asset_frame.h"
#include "core/geometry/assets/height_field_data.h"

namespace lockstone {
namespace geometry {
namespace {

constexpr std::uint16_t k_height_field_version = 2;
constexpr std::size_t k_height_field_counts_bytes = 27;

struct HeightFieldCounts {
  std::uint16_t columns = 0;
  std::uint16_t rows = 0;
  std::uint16_t surfaces = 0;
  std::uint8_t flags = 0;

  [[nodiscard]] bool has_holes() const { return (flags & 1) != 0; }
  [[nodiscard]] bool has_surfaces() const { return (flags & 2) != 0; }
  [[nodiscard]] bool in_range() const {
    return columns >= 2 && columns <= k_max_height_field_samples && rows >= 2 &&
           rows <= k_max_height_field_samples && surfaces <= k_max_surfaces && flags <= 3;
  }
  [[nodiscard]] std::size_t samples() const { return std::size_t{columns} * rows; }
  [[nodiscard]] std::size_t cells() const {
    return (std::size_t{columns} - 1) * (std::size_t{rows} - 1);
  }
  /// Of all that follows the counts.
  [[nodiscard]] std::size_t bytes() const {
    return 4 * samples() + (has_holes() ? (cells() + 7) / 8 : 0) +
           k_surface_bytes * std::size_t{surfaces} + (has_surfaces() ? cells() : 0);
  }
};

Status read_counts(ByteReader& reader, HeightFieldDef& def, HeightFieldCounts& counts) {
  for (std::int32_t* field : {&def.flat_angle.raw, &def.origin.x.raw, &def.origin.z.raw,
                              &def.cell_x.raw, &def.cell_z.raw})
    *field = reader.get<std::int32_t>();
  counts.columns = reader.get<std::uint16_t>();
  counts.rows = reader.get<std::uint16_t>();
  counts.surfaces = reader.get<std::uint16_t>();
  counts.flags = reader.get<std::uint8_t>();
  if (!reader.ok()) return Status::truncated;
  if (!counts.in_range()) return Status::malformed;
  if (counts.bytes() > reader.remaining()) return Status::truncated;
  return counts.bytes() == reader.remaining() ? Status::ok : Status::malformed;
}

/// The spans of a definition that came from bytes.
struct Payload {
  std::vector<Length> heights;
  std::vector<std::uint8_t> holes;
  std::vector<Surface> surfaces;
  std::vector<std::uint8_t> cell_surfaces;
};

Payload read_payload(ByteReader& reader, const HeightFieldCounts& counts) {
  Payload payload;
  payload.heights.resize(counts.samples());
  for (Length& height : payload.heights)
    height.raw = reader.get<std::int32_t>();
  payload.holes.resize(counts.has_holes() ? counts.cells() : 0);
  std::uint8_t bits = 0;
  for (std::size_t i = 0; i < payload.holes.size(); ++i) {
    if (i % 8 == 0) bits = reader.get<std::uint8_t>();
    payload.holes[i] = (bits >> (i % 8)) & 1;
  }
  payload.surfaces.resize(counts.surfaces);
  for (Surface& surface : payload.surfaces)
    surface = get_surface(reader);
  payload.cell_surfaces.resize(counts.has_surfaces() ? counts.cells() : 0);
  for (std::uint8_t& index : payload.cell_surfaces)
    index = reader.get<std::uint8_t>();
  return payload;
}

}  // namespace

std::vector<std::byte> encode_height_field(const HeightFieldData& data) {
  HeightFieldCounts counts;
  counts.columns = static_cast<std::uint16_t>(data.columns);
  counts.rows = static_cast<std::uint16_t>(data.rows);
  counts.surfaces = static_cast<std::uint16_t>(data.surfaces.size());
  counts.flags = static_cast<std::uint8_t>((data.holes.empty() ? 0 : 1) |
                                           (data.cell_surfaces.empty() ? 0 : 2));
  std::vector<std::byte> bytes(k_asset_header_bytes + k_height_field_counts_bytes + counts.bytes());
  ByteWriter writer(bytes);
  put_asset_header(writer, ShapeKind::height_field, k_height_field_version);
  writer.put(data.flat_angle.raw);
  for (const Length field : {data.origin_x, data.origin_z, data.cell_x, data.cell_z})
    writer.put(field.raw);
  writer.put(counts.columns);
  writer.put(counts.rows);
  writer.put(counts.surfaces);
  writer.put(counts.flags);
  for (const Length height : data.heights)
    writer.put(height.raw);
  for (const std::uint8_t bits : data.holes)
    writer.put(bits);
  for (const Surface& surface : data.surfaces)
    put_surface(writer, surface);
  for (const std::uint8_t index : data.cell_surfaces)
    writer.put(index);
  LKS_CHECK(writer.ok() && writer.size() == bytes.size());
  return bytes;
}

}  // namespace geometry

Result<std::shared_ptr<const HeightField>> HeightField::from_bytes(ByteView bytes) {
  using namespace geometry;
  ByteReader reader(bytes);
  const Status header = read_asset_header(reader, ShapeKind::height_field, k_height_field_version);
  if (header != Status::ok) return header;
  HeightFieldDef def;
  HeightFieldCounts counts;
  if (const Status s = read_counts(reader, def, counts); s != Status::ok) return s;
  const Payload payload = read_payload(reader, counts);
  def.columns = counts.columns;
  def.rows = counts.rows;
  def.heights = payload.heights;
  def.holes = payload.holes;
  def.surfaces = payload.surfaces;
  def.cell_surfaces = payload.cell_surfaces;
  HeightFieldResult result = build(def);
  // Two files of one geometry must not have two names.
  if (!result.ok() || result.height_field->id() != id_of(bytes)) return Status::malformed;
  return std::move(result.height_field);
}

}  // namespace lockstone
