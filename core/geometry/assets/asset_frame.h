// The frame of an asset's canonical bytes: magic, version, kind; then the payload and nothing after
// it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/bytes.h>
#include <lockstone/shape.h>
#include <lockstone/status.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone::geometry {

/// "LKSA".
inline constexpr std::uint32_t k_asset_magic = 0x41534b4c;
inline constexpr std::size_t k_asset_header_bytes = 8;

void put_asset_header(ByteWriter& writer, ShapeKind kind, std::uint16_t version);

/// ok, truncated, malformed, or unsupported_version.
[[nodiscard]] Status read_asset_header(ByteReader& reader, ShapeKind kind, std::uint16_t version);

/// The hash of canonical bytes, never 0.
[[nodiscard]] AssetId id_of(ByteView canonical_bytes);

/// Whether every coordinate is within k_max_asset_coordinate.
[[nodiscard]] constexpr bool is_asset_coordinate(Length x) {
  return x >= -k_max_asset_coordinate && x <= k_max_asset_coordinate;
}
[[nodiscard]] constexpr bool is_asset_coordinate(const Vec3<Length>& v) {
  return is_asset_coordinate(v.x) && is_asset_coordinate(v.y) && is_asset_coordinate(v.z);
}

/// Of meshes and height fields: MeshDef::flat_angle.
inline constexpr Angle k_max_flat_angle = Angle::from_integer(1);

/// Friction 0 … 1.99, restitution and rolling resistance 0 … 1, known rules.
[[nodiscard]] constexpr bool is_valid(const Surface& surface) {
  constexpr Coefficient most_friction = Coefficient::from_ratio(199, 100);
  constexpr Coefficient one = Coefficient::from_integer(1);
  return surface.friction >= Coefficient{} && surface.friction <= most_friction &&
         surface.restitution >= Coefficient{} && surface.restitution <= one &&
         surface.rolling_resistance >= Coefficient{} && surface.rolling_resistance <= one &&
         surface.friction_rule <= CombineRule::maximum &&
         surface.restitution_rule <= CombineRule::maximum &&
         surface.rolling_rule <= CombineRule::maximum;
}

/// Of a surface: three coefficients, the tag, three rules.
inline constexpr std::size_t k_surface_bytes = 19;

inline void put_surface(ByteWriter& writer, const Surface& surface) {
  writer.put(surface.friction.raw);
  writer.put(surface.restitution.raw);
  writer.put(surface.rolling_resistance.raw);
  writer.put(surface.tag);
  writer.put(surface.friction_rule);
  writer.put(surface.restitution_rule);
  writer.put(surface.rolling_rule);
}

[[nodiscard]] inline Surface get_surface(ByteReader& reader) {
  Surface surface;
  surface.friction.raw = reader.get<std::int32_t>();
  surface.restitution.raw = reader.get<std::int32_t>();
  surface.rolling_resistance.raw = reader.get<std::int32_t>();
  surface.tag = reader.get<std::uint32_t>();
  surface.friction_rule = static_cast<CombineRule>(reader.get<std::uint8_t>());
  surface.restitution_rule = static_cast<CombineRule>(reader.get<std::uint8_t>());
  surface.rolling_rule = static_cast<CombineRule>(reader.get<std::uint8_t>());
  return surface;
}

inline void put_vector(ByteWriter& writer, const Vec3<Length>& v) {
  for (int axis = 0; axis < 3; ++axis)
    writer.put(v[axis].raw);
}

[[nodiscard]] inline Vec3<Length> get_vector(ByteReader& reader) {
  Vec3<Length> v;
  for (int axis = 0; axis < 3; ++axis)
    v[axis].raw = reader.get<std::int32_t>();
  return v;
}

}  // namespace lockstone::geometry
