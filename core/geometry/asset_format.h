// The head of an asset's canonical bytes.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/bytes.h>
#include <lockstone/hash.h>
#include <lockstone/status.h>

namespace lockstone::geometry {

inline constexpr std::uint32_t k_asset_magic = 0x41534b4c;  // "LKSA"
inline constexpr std::uint16_t k_asset_version = 1;
inline constexpr std::size_t k_asset_head_bytes = 8;

/// u32 magic, u16 version, u8 kind, u8 zero.
inline void put_asset_head(ByteWriter& writer, ShapeKind kind) {
  writer.put(k_asset_magic);
  writer.put(k_asset_version);
  writer.put(kind);
  writer.put(std::uint8_t{0});
}

/// ok when a head of this kind was read.
[[nodiscard]] inline Status read_asset_head(ByteReader& reader, ShapeKind kind) {
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  const auto found = reader.get<std::uint8_t>();
  const auto reserved = reader.get<std::uint8_t>();
  if (!reader.ok()) return Status::truncated;
  if (magic != k_asset_magic) return Status::malformed;
  if (version != k_asset_version) return Status::unsupported_version;
  const bool good = found == static_cast<std::uint8_t>(kind) && reserved == 0;
  return good ? Status::ok : Status::malformed;
}

/// The name of what has these canonical bytes; never null.
[[nodiscard]] inline AssetId asset_id_of(ByteView bytes) {
  const std::uint64_t hash = hash64(bytes);
  return {hash != 0 ? hash : 1};
}

}  // namespace lockstone::geometry
