#include "core/geometry/assets/asset_frame.h"

#include <lockstone/hash.h>

namespace lockstone::geometry {

void put_asset_header(ByteWriter& writer, ShapeKind kind, std::uint16_t version) {
  writer.put(k_asset_magic);
  writer.put(version);
  writer.put(kind);
  writer.put(std::uint8_t{0});
}

Status read_asset_header(ByteReader& reader, ShapeKind kind, std::uint16_t version) {
  const auto magic = reader.get<std::uint32_t>();
  const auto read_version = reader.get<std::uint16_t>();
  const auto read_kind = reader.get<std::uint8_t>();
  const auto reserved = reader.get<std::uint8_t>();
  if (!reader.ok()) return Status::truncated;
  if (magic != k_asset_magic) return Status::malformed;
  if (read_version != version) return Status::unsupported_version;
  const bool known = read_kind == static_cast<std::uint8_t>(kind) && reserved == 0;
  return known ? Status::ok : Status::malformed;
}

AssetId id_of(ByteView canonical_bytes) {
  const std::uint64_t hash = hash64(canonical_bytes);
  return {hash == 0 ? 1 : hash};
}

}  // namespace lockstone::geometry
