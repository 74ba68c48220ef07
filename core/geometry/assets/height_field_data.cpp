#include "core/geometry/assets/height_field_data.h"

#include <algorithm>

#include "core/math/trig.h"

namespace lockstone::geometry {
namespace {

/// The number of blocks of 2^shift that `cells` take.
std::int32_t blocks_of(std::int32_t cells, int shift) {
  return (cells + (1 << shift) - 1) >> shift;
}

HeightPyramid::Level lowest_level(const HeightFieldData& data) {
  constexpr int shift = HeightPyramid::k_lowest_level;
  HeightPyramid::Level level{
      blocks_of(data.cell_columns(), shift), blocks_of(data.cell_rows(), shift), {}};
  level.blocks.resize(static_cast<std::size_t>(level.columns * level.rows));
  const auto block = [&](std::int32_t i, std::int32_t j) -> HeightRange& {
    return level.blocks[static_cast<std::size_t>(j * level.columns + i)];
  };
  // A sample on the border of blocks belongs to each of them.
  for (std::int32_t j = 0; j < data.rows; ++j) {
    const std::int32_t low_j = std::max(0, j - 1) >> shift;
    const std::int32_t high_j = std::min(j, data.cell_rows() - 1) >> shift;
    for (std::int32_t i = 0; i < data.columns; ++i) {
      const std::int32_t low_i = std::max(0, i - 1) >> shift;
      const std::int32_t high_i = std::min(i, data.cell_columns() - 1) >> shift;
      const Length y = data.height({i, j});
      block(low_i, low_j).include(y);
      block(high_i, low_j).include(y);
      block(low_i, high_j).include(y);
      block(high_i, high_j).include(y);
    }
  }
  return level;
}

HeightPyramid::Level halved(const HeightPyramid::Level& below) {
  HeightPyramid::Level level{blocks_of(below.columns, 1), blocks_of(below.rows, 1), {}};
  level.blocks.resize(static_cast<std::size_t>(level.columns * level.rows));
  for (std::int32_t j = 0; j < below.rows; ++j) {
    for (std::int32_t i = 0; i < below.columns; ++i) {
      const auto above = static_cast<std::size_t>((j >> 1) * level.columns + (i >> 1));
      level.blocks[above].include(below.blocks[static_cast<std::size_t>(j * below.columns + i)]);
    }
  }
  return level;
}

}  // namespace

std::size_t HeightPyramid::memory_bytes() const {
  std::size_t bytes = 0;
  for (const Level& level : levels_)
    bytes += level.blocks.size() * sizeof(HeightRange);
  return bytes;
}

void HeightFieldData::derive() {
  flat_cosine = sin_cos(flat_angle).cos;
  HeightPyramid::Level level = lowest_level(*this);
  while (level.blocks.size() > 1) {
    HeightPyramid::Level above = halved(level);
    pyramid.add(std::move(level));
    level = std::move(above);
  }
  const HeightRange all = level.blocks.front();
  pyramid.add(std::move(level));
  bounds = {{origin_x, all.lowest, origin_z},
            {x_of(cell_columns()), all.highest, z_of(cell_rows())}};
}

bool HeightFieldData::is_void(const GridPoint& cell) const {
  if (cell.i < 0 || cell.j < 0 || cell.i >= cell_columns() || cell.j >= cell_rows()) return true;
  if (holes.empty()) return false;
  const std::uint32_t number = cell_number(cell);
  return ((holes[number >> 3] >> (number & 7)) & 1) != 0;
}

const Surface* HeightFieldData::surface(const GridPoint& cell) const {
  if (cell_surfaces.empty()) return nullptr;
  const std::uint8_t index = cell_surfaces[cell_number(cell)];
  return index == k_own_surface ? nullptr : &surfaces[index];
}

}  // namespace lockstone::geometry
