#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/load_asset.h>
#include <lockstone/mesh.h>
#include <lockstone/path.h>

#include "core/geometry/assets/asset_frame.h"

namespace lockstone {
namespace {

template <class T>
Result<AssetPtr> as_asset(Result<std::shared_ptr<const T>> loaded) {
  if (!loaded) return loaded.status();
  return AssetPtr(std::move(loaded).value());
}

}  // namespace

// Version and the rest of the head are judged by the kind's own reader.
Result<AssetPtr> load_asset(ByteView canonical, const AssetSet& known) {
  ByteReader reader(canonical);
  const auto magic = reader.get<std::uint32_t>();
  (void)reader.get<std::uint16_t>();
  const auto kind = static_cast<ShapeKind>(reader.get<std::uint8_t>());
  if (!reader.ok()) return Status::truncated;
  if (magic != geometry::k_asset_magic) return Status::malformed;
  switch (kind) {
    case ShapeKind::hull:
      (void)HullOptions::rounded({});  // links rounded ones
      return as_asset(Hull::from_bytes(canonical));
    case ShapeKind::mesh:
      return as_asset(Mesh::from_bytes(canonical));
    case ShapeKind::height_field:
      return as_asset(HeightField::from_bytes(canonical));
    case ShapeKind::compound:
      return as_asset(Compound::from_bytes(canonical, known));
    case ShapeKind::path:
      return as_asset(Path::from_bytes(canonical));
    default:
      return Status::malformed;
  }
}

}  // namespace lockstone
