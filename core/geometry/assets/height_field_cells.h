// The two triangles of each cell of a height field.
//
// A `Field` is a height field as the functions below see it: `grid()`, the data of the asset, and
// height, is_void, surface and block_range, which an edited one answers from its tiles.
#pragma once

#include <array>
#include <cstdint>

#include "core/geometry/assets/height_field_data.h"

namespace lockstone::geometry {

constexpr GridPoint operator+(const GridPoint& a, const GridPoint& b) {
  return {a.i + b.i, a.j + b.j};
}

/// The sample beyond each edge of a half: the neighbour's sample there, and the neighbour's cell.
struct CellNeighbour {
  GridPoint cell;
  GridPoint apex;
};

inline constexpr std::array<std::array<CellNeighbour, 3>, 2> k_cell_neighbours{
    {{{{{-1, 0}, {-1, 0}}, {{0, 1}, {1, 2}}, {{0, 0}, {1, 0}}}},
     {{{{0, 0}, {0, 1}}, {{1, 0}, {2, 1}}, {{0, -1}, {0, -1}}}}}};

inline constexpr std::array<std::array<GridPoint, 3>, 2> k_cell_corners{
    {{{{0, 0}, {0, 1}, {1, 1}}}, {{{0, 0}, {1, 1}, {1, 0}}}}};

template <class Field>
[[nodiscard]] Vec3<Length> vertex_of(const Field& field, const GridPoint& sample) {
  return {field.grid().x_of(sample.i), field.height(sample), field.grid().z_of(sample.j)};
}

/// half 0 or 1.
template <class Field>
[[nodiscard]] TriangleVertices triangle_of(const Field& field, const GridPoint& cell, int half) {
  const auto& corners = k_cell_corners[static_cast<std::size_t>(half)];
  return {vertex_of(field, cell + corners[0]), vertex_of(field, cell + corners[1]),
          vertex_of(field, cell + corners[2])};
}

/// See TriangleTopology.
template <class Field>
[[nodiscard]] std::uint8_t active_edges_of(const Field& field, const GridPoint& cell, int half) {
  const TriangleVertices vertices = triangle_of(field, cell, half);
  unsigned active = 0;
  for (int edge = 0; edge < 3; ++edge) {
    const CellNeighbour& beyond =
        k_cell_neighbours[static_cast<std::size_t>(half)][static_cast<std::size_t>(edge)];
    const bool is_active = field.is_void(cell + beyond.cell) ||
                           is_edge_active(vertices, edge, vertex_of(field, cell + beyond.apex),
                                          field.grid().flat_cosine);
    active |= is_active ? 1U << edge : 0U;
  }
  return static_cast<std::uint8_t>(active);
}

}  // namespace lockstone::geometry
