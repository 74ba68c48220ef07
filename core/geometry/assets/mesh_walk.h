// The triangles of a mesh, or of one whose groups a world has switched, that a region or a window
// meets.
#pragma once

#include "core/geometry/assets/mesh_data.h"
#include "core/geometry/convex/slab_tests.h"

namespace lockstone::geometry {

/// All triangles, with their own edges.
struct AllTriangles {
  const MeshData& data;

  [[nodiscard]] static constexpr bool has(std::uint32_t) { return true; }
  [[nodiscard]] std::uint8_t active_edges(std::uint32_t index) const {
    return data.active_edges(index);
  }
};

template <class Triangles>
void visit_triangles(const MeshData& data, const Triangles& triangles, const LocalBounds& region,
                     PartVisitor& visitor) {
  TrianglePart part;
  data.tree.overlapping(region, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const TriangleVertices triangle = data.triangle(i);
      if (!overlap(bounds_of(triangle), region) || !triangles.has(i)) continue;
      visitor.visit(
          part.set(data.first_part + i, triangle, triangles.active_edges(i), data.surface(i)));
    }
  });
}

/// Triangles that the window meets within the visitor's present limit.
template <class Triangles, class Window, class Limit, class Visitor>
void visit_nearest_first(const MeshData& data, const Triangles& triangles, const Window& window,
                         Limit most, Visitor& visitor) {
  TrianglePart part;
  const auto visit = [&](std::uint32_t first, std::uint32_t count, std::int64_t limit) {
    for (std::uint32_t i = first; i < first + count; ++i) {
      const TriangleVertices triangle = data.triangle(i);
      std::int64_t at = 0;
      if (!window.meets(bounds_of(triangle), limit, at) || !triangles.has(i)) continue;
      limit = window.limit_of(visitor.visit(
          part.set(data.first_part + i, triangle, triangles.active_edges(i), data.surface(i))));
    }
    return limit;
  };
  data.tree.nearest_first(window, window.limit_of(most), visit);
}

}  // namespace lockstone::geometry
