// Walks over the cells of a height field that a region, a ray or a point's surroundings meet.
#pragma once

#include <algorithm>
#include <array>

#include "core/geometry/assets/height_field_cells.h"
#include "core/geometry/convex/slab_tests.h"

namespace lockstone::geometry {

[[nodiscard]] inline std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  const std::int64_t quotient = a / b;
  return a % b < 0 ? quotient - 1 : quotient;
}

/// The cells along one axis that meet a closed interval.
struct CellRange {
  std::int32_t first = 0;
  std::int32_t last = -1;
};

[[nodiscard]] inline CellRange cells_between(Length low, Length high, Length origin, Length cell,
                                             std::int32_t count) {
  const std::int64_t before = std::int64_t{low.raw} - origin.raw - 1;
  const std::int64_t first = floor_divide(before, cell.raw);  // ⌈(low − origin) / cell⌉ − 1
  const std::int64_t last = floor_divide(std::int64_t{high.raw} - origin.raw, cell.raw);
  return {static_cast<std::int32_t>(std::max<std::int64_t>(first, 0)),
          static_cast<std::int32_t>(std::min<std::int64_t>(last, count - 1))};
}

/// A walk over the cells of a region, row by row.
template <class Field>
class RegionWalk {
 public:
  RegionWalk(const Field& field, const LocalBounds& region, PartVisitor& visitor)
      : field_(field), data_(field.grid()), region_(region), visitor_(visitor) {}

  void run() {
    const CellRange across = cells_between(region_.lower.x, region_.upper.x, data_.origin_x,
                                           data_.cell_x, data_.cell_columns());
    const CellRange along = cells_between(region_.lower.z, region_.upper.z, data_.origin_z,
                                          data_.cell_z, data_.cell_rows());
    for (std::int32_t j = along.first; j <= along.last; ++j)
      visit_row(across, j);
  }

 private:
  static constexpr int k_block_shift = HeightPyramid::k_lowest_level;

  void visit_row(const CellRange& across, std::int32_t j) {
    for (std::int32_t i = across.first; i <= across.last;) {
      const std::int32_t clear = end_of_clear_block({i, j});
      if (clear > i) {
        i = clear;
        continue;
      }
      const std::int32_t end =
          std::min(across.last + 1, ((i >> k_block_shift) + 1) << k_block_shift);
      for (; i < end; ++i)
        visit_cell({i, j});
    }
  }

  [[nodiscard]] bool is_clear(const HeightRange& range) const {
    return range.highest < region_.lower.y || range.lowest > region_.upper.y;
  }

  /// The column after the largest block around the cell that lies below or above the region; the
  /// cell's own column when there is none.
  [[nodiscard]] std::int32_t end_of_clear_block(const GridPoint& cell) const {
    std::int32_t end = cell.i;
    for (int level = k_block_shift; level <= data_.pyramid.top_level(); ++level) {
      const GridPoint block{cell.i >> level, cell.j >> level};
      if (!is_clear(field_.block_range(level, block))) break;
      end = (block.i + 1) << level;
    }
    return end;
  }

  void visit_cell(const GridPoint& cell) {
    if (field_.is_void(cell)) return;
    for (int half = 0; half < 2; ++half) {
      const TriangleVertices triangle = triangle_of(field_, cell, half);
      if (!overlap(bounds_of(triangle), region_)) continue;
      const std::uint32_t index = 2 * data_.cell_number(cell) + static_cast<std::uint32_t>(half);
      const std::uint8_t edges =
          visitor_.wants_edges() ? active_edges_of(field_, cell, half) : std::uint8_t{0};
      visitor_.visit(part_.set(index, triangle, edges, field_.surface(cell)));
    }
  }

  const Field& field_;
  const HeightFieldData& data_;
  const LocalBounds& region_;
  PartVisitor& visitor_;
  TrianglePart part_;
};

/// A descent of the pyramid, the blocks first that a window (RayWindow, NearWindow) meets first.
template <class Field, class Window, class Visitor>
class NearestWalk {
 public:
  NearestWalk(const Field& field, const Window& window, std::int64_t limit, Visitor& visitor)
      : field_(field), data_(field.grid()), window_(window), visitor_(visitor), limit_(limit) {}

  void run() { run_from({data_.pyramid.top_level(), {0, 0}}); }

  /// The same, of a window that meets cells of these ranges alone: from the least block with all of
  /// them.
  void run(const CellRange& across, const CellRange& along) {
    if (across.first > across.last || along.first > along.last) return;
    int level = 0;
    while (across.first >> level != across.last >> level ||
           along.first >> level != along.last >> level)
      ++level;
    LKS_ASSERT(level <= data_.pyramid.top_level());
    run_from({level, {across.first >> level, along.first >> level}});
  }

 private:
  struct Block {
    int level = 0;
    GridPoint place;
    std::int64_t at = 0;
  };

  void run_from(Block top) {
    if (meets(top)) stack_[size_++] = top;
    while (size_ > 0) {
      const Block block = stack_[--size_];
      if (block.at > limit_) continue;
      if (block.level == 0) {
        visit_cell(block.place);
      } else {
        push_children(block);
      }
    }
  }

  // Only contacts ask for them, and they visit regions.
  static constexpr std::uint8_t k_no_edges = 0;
  // A block leaves at most three of its children behind, on at most 12 levels.
  static constexpr std::size_t k_stack = 48;

  [[nodiscard]] HeightRange heights_of(const Block& block, const GridPoint& low,
                                       const GridPoint& high) const {
    if (block.level >= HeightPyramid::k_lowest_level)
      return field_.block_range(block.level, block.place);
    HeightRange range;
    for (std::int32_t j = low.j; j <= high.j; ++j) {
      for (std::int32_t i = low.i; i <= high.i; ++i)
        range.include(field_.height({i, j}));
    }
    return range;
  }

  bool meets(Block& block) const {
    const GridPoint low{block.place.i << block.level, block.place.j << block.level};
    if (low.i >= data_.cell_columns() || low.j >= data_.cell_rows()) return false;
    const GridPoint high{std::min(low.i + (1 << block.level), data_.cell_columns()),
                         std::min(low.j + (1 << block.level), data_.cell_rows())};
    const HeightRange heights = heights_of(block, low, high);
    const LocalBounds box{{data_.x_of(low.i), heights.lowest, data_.z_of(low.j)},
                          {data_.x_of(high.i), heights.highest, data_.z_of(high.j)}};
    return window_.meets(box, limit_, block.at);
  }

  /// The nearest on top; of equals the last.
  void push_children(const Block& block) {
    const std::size_t base = size_;
    LKS_CHECK(base + 4 <= k_stack);
    for (std::int32_t k = 0; k < 4; ++k) {
      Block child{block.level - 1, {2 * block.place.i + (k & 1), 2 * block.place.j + (k >> 1)}};
      if (!meets(child)) continue;
      std::size_t at = size_++;
      for (; at > base && stack_[at - 1].at < child.at; --at)
        stack_[at] = stack_[at - 1];
      stack_[at] = child;
    }
  }

  void visit_cell(const GridPoint& cell) {
    if (field_.is_void(cell)) return;
    for (int half = 0; half < 2; ++half) {
      const TriangleVertices triangle = triangle_of(field_, cell, half);
      std::int64_t at = 0;
      if (!window_.meets(bounds_of(triangle), limit_, at)) continue;
      const std::uint32_t index = 2 * data_.cell_number(cell) + static_cast<std::uint32_t>(half);
      limit_ = window_.limit_of(
          visitor_.visit(part_.set(index, triangle, k_no_edges, field_.surface(cell))));
    }
  }

  const Field& field_;
  const HeightFieldData& data_;
  const Window& window_;
  Visitor& visitor_;
  TrianglePart part_;
  std::int64_t limit_;
  std::array<Block, k_stack> stack_{};
  std::size_t size_ = 0;
};

/// The visits of an asset (asset.h) over a field.
template <class Field>
void visit_cells(const Field& field, const LocalBounds& region, PartVisitor& visitor) {
  RegionWalk(field, region, visitor).run();
}

template <class Field>
void visit_cells_on_way(const Field& field, const Vec3<Length>& origin,
                        const Vec3<Length>& translation, const Vec3<Length>& reach,
                        WayPartVisitor& visitor) {
  const RayWindow window(origin, translation, reach);
  const HeightFieldData& grid = field.grid();
  const auto cells_on_way = [&](int axis, Length first, Length cell, std::int32_t count) {
    constexpr std::int64_t k_slack = 4;  // more than that of the window
    const std::int64_t from = origin[axis].raw, to = from + translation[axis].raw;
    const std::int64_t wide = reach[axis].raw + k_slack;
    const auto bound = [](std::int64_t x) {
      return Length::from_raw(raw::saturate<std::int32_t>(x));
    };
    return cells_between(bound(std::min(from, to) - wide), bound(std::max(from, to) + wide), first,
                         cell, count);
  };
  NearestWalk(field, window, window.limit_of(Unit::from_integer(1)), visitor)
      .run(cells_on_way(0, grid.origin_x, grid.cell_x, grid.cell_columns()),
           cells_on_way(2, grid.origin_z, grid.cell_z, grid.cell_rows()));
}

template <class Field>
void visit_cells_near(const Field& field, const Vec3<Length>& point, Length reach,
                      NearPartVisitor& visitor) {
  const NearWindow window(point);
  NearestWalk(field, window, window.limit_of(reach), visitor).run();
}

}  // namespace lockstone::geometry
