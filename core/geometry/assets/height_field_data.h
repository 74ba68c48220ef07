// The data of a height field.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/height_field.h>

#include "core/geometry/mesh_contact/triangle_polytope.h"

namespace lockstone::geometry {

struct GridPoint {
  std::int32_t i = 0;  ///< along x
  std::int32_t j = 0;  ///< along z
};

struct HeightRange {
  Length lowest = Length::max();
  Length highest = Length::min();

  void include(Length y) {
    lowest = min(lowest, y);
    highest = max(highest, y);
  }
  void include(const HeightRange& other) {
    include(other.lowest);
    include(other.highest);
  }
};

/// The heights over square blocks of 2^level cells, 4 and more; finer ones are read from the
/// samples. Each level halves the one below, up to a single block.
class HeightPyramid {
 public:
  static constexpr int k_lowest_level = 2;

  struct Level {
    std::int32_t columns = 0;
    std::int32_t rows = 0;
    std::vector<HeightRange> blocks;
  };

  void add(Level level) { levels_.push_back(std::move(level)); }
  [[nodiscard]] int top_level() const {
    return k_lowest_level + static_cast<int>(levels_.size()) - 1;
  }
  [[nodiscard]] const Level& level(int number) const {
    return levels_[static_cast<std::size_t>(number - k_lowest_level)];
  }
  [[nodiscard]] const HeightRange& block(int number, const GridPoint& at) const {
    const Level& l = level(number);
    return l.blocks[static_cast<std::size_t>(at.j * l.columns + at.i)];
  }
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  std::vector<Level> levels_;
};

struct HeightFieldData {
  std::int32_t columns = 0;  ///< samples
  std::int32_t rows = 0;
  Length origin_x{};
  Length origin_z{};
  Length cell_x{};
  Length cell_z{};
  Angle flat_angle{};
  std::vector<Length> heights;              ///< absolute
  std::vector<std::uint8_t> holes;          ///< a bit a cell, or empty
  std::vector<std::uint8_t> cell_surfaces;  ///< or empty; k_own_surface at holes
  std::vector<Surface> surfaces;

  // Derived
  Unit flat_cosine{};
  LocalBounds bounds;
  HeightPyramid pyramid;

  void derive();

  [[nodiscard]] std::int32_t cell_columns() const { return columns - 1; }
  [[nodiscard]] std::int32_t cell_rows() const { return rows - 1; }
  [[nodiscard]] std::size_t cell_count() const {
    return static_cast<std::size_t>(cell_columns()) * static_cast<std::size_t>(cell_rows());
  }
  [[nodiscard]] std::uint32_t cell_number(const GridPoint& cell) const {
    return static_cast<std::uint32_t>(cell.j * cell_columns() + cell.i);
  }
  [[nodiscard]] Length height(const GridPoint& sample) const {
    return heights[static_cast<std::size_t>(sample.j * columns + sample.i)];
  }
  [[nodiscard]] Length x_of(std::int32_t i) const { return origin_x + cell_x * i; }
  [[nodiscard]] Length z_of(std::int32_t j) const { return origin_z + cell_z * j; }
  /// Whether the cell is outside the grid or a hole.
  [[nodiscard]] bool is_void(const GridPoint& cell) const;

  [[nodiscard]] const Surface* surface(const GridPoint& cell) const;
  /// Bounds of the heights of a block of the pyramid.
  [[nodiscard]] HeightRange block_range(int level, const GridPoint& at) const {
    return pyramid.block(level, at);
  }
  [[nodiscard]] const HeightFieldData& grid() const { return *this; }
};

/// The canonical bytes.
[[nodiscard]] std::vector<std::byte> encode_height_field(const HeightFieldData& data);

}  // namespace lockstone::geometry
