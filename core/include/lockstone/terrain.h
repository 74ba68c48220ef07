// Terrain that changes: the samples and cells of a height field that the commands of a world have
// replaced, and the groups of a mesh that they have switched off. The asset stays as it is; the
// changes are part of the state.
#pragma once

#include <cstdint>
#include <optional>

#include <lockstone/asset.h>
#include <lockstone/body.h>
#include <lockstone/units.h>

namespace lockstone {

class World;

/// The most tiles of a world: squares of 4 × 4 samples, or 16 groups of a mesh, from a multiple of
/// 16 on, of which one is off. Each takes 92 bytes of a state.
inline constexpr std::uint32_t k_max_terrain_tiles = 1U << 16;

/// A sample of a height field, and the cell from it to the next sample along both axes.
struct TerrainSample {
  Length height{};             ///< y in the frame of the asset
  bool is_hole = true;         ///< also where there is no cell: in the last column or row
  std::uint8_t surface = 255;  ///< index into the surfaces of the asset, or k_own_surface
};

/// A sample of the body's height field as it is now; nothing for a body without one, or outside the
/// grid.
[[nodiscard]] std::optional<TerrainSample> terrain_sample_of(const World& world, BodyHandle body,
                                                             std::uint32_t column,
                                                             std::uint32_t row);

/// Whether a group of triangles of the body's mesh is switched on; nothing for a body without a
/// mesh of groups, or a group without triangles.
[[nodiscard]] std::optional<bool> is_mesh_group_on(const World& world, BodyHandle body,
                                                   std::uint32_t group);

/// The geometry of a body as it is now, for the engine's own drawing: its parts are those that
/// bodies meet. Null for a shape complete in itself, or an unknown body. Valid until the next
/// command or load.
[[nodiscard]] const geometry::AssetGeometry* geometry_of(const World& world, BodyHandle body);

/// The changed tiles of all bodies, of WorldDef::terrain_tile_capacity.
[[nodiscard]] std::uint32_t terrain_tile_count(const World& world);

}  // namespace lockstone
