// Tiles: squares of samples and cells of a height field that a world has changed.
#pragma once

#include <array>
#include <compare>
#include <cstdint>

#include <lockstone/asset.h>

#include "core/geometry/assets/height_field_data.h"

namespace lockstone::geometry {

/// The place of a tile: of the samples and cells from (4 · column, 4 · row) on, in the height field
/// of an owner.
struct HeightTileKey {
  std::uint32_t owner = 0;
  std::uint16_t row = 0;
  std::uint16_t column = 0;

  friend constexpr auto operator<=>(const HeightTileKey&, const HeightTileKey&) = default;
};

/// Takes the place of 4 × 4 samples and cells, row by row. Beyond the edges of the field there is
/// none: height 0, no hole, k_own_surface.
struct HeightTile {
  static constexpr int k_shift = 2;
  static constexpr std::int32_t k_side = 1 << k_shift;
  static constexpr std::size_t k_samples = std::size_t{1} << (2 * k_shift);

  std::uint32_t owner = 0;
  std::uint16_t row = 0;
  std::uint16_t column = 0;
  std::array<Length, k_samples> heights{};  ///< absolute
  std::array<std::uint8_t, k_samples> surfaces{};
  std::uint16_t holes = 0;  ///< a bit a cell
  std::uint16_t reserved = 0;

  friend bool operator==(const HeightTile&, const HeightTile&) = default;

  [[nodiscard]] HeightTileKey key() const { return {owner, row, column}; }
  /// The tile that holds a sample or a cell, and its place there.
  [[nodiscard]] static HeightTileKey key_of(std::uint32_t owner, const GridPoint& at) {
    return {owner, static_cast<std::uint16_t>(at.j >> k_shift),
            static_cast<std::uint16_t>(at.i >> k_shift)};
  }
  [[nodiscard]] static std::size_t place_of(const GridPoint& at) {
    return static_cast<std::size_t>((at.j & (k_side - 1)) * k_side + (at.i & (k_side - 1)));
  }
  /// The sample or cell at a place.
  [[nodiscard]] GridPoint point_at(std::size_t place) const {
    const auto number = static_cast<std::int32_t>(place);
    return {column * k_side + (number & (k_side - 1)), row * k_side + (number >> k_shift)};
  }
  [[nodiscard]] bool is_hole(std::size_t place) const { return ((holes >> place) & 1U) != 0; }
};
static_assert(HeightTile::k_shift == HeightPyramid::k_lowest_level, "a tile is a block");

/// The tile as the asset has it.
[[nodiscard]] HeightTile original_tile(const HeightFieldData& field, const HeightTileKey& key);

/// Whether the tile can be one of the field: within its grid, heights and surfaces in range, holes
/// without a surface.
[[nodiscard]] bool is_tile_of(const HeightFieldData& field, const HeightTile& tile);

}  // namespace lockstone::geometry
