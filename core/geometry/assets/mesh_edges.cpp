// Which edges of a mesh may be met as edges.
#include <algorithm>

#include "core/geometry/assets/mesh_data.h"
#include "core/math/trig.h"

namespace lockstone::geometry {
namespace {

/// One side of an edge: the edge by its vertices, lower first, and the triangle's corner where it
/// begins.
struct EdgeSide {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t corner = 0;  ///< triangle · 4 + edge
  bool rising = false;       ///< runs from `low` to `high`

  friend constexpr auto operator<=>(const EdgeSide&, const EdgeSide&) = default;

  [[nodiscard]] bool same_edge(const EdgeSide& other) const {
    return low == other.low && high == other.high;
  }
  [[nodiscard]] std::uint32_t triangle() const { return corner >> 2; }
  [[nodiscard]] int edge() const { return static_cast<int>(corner & 3); }
};

std::vector<EdgeSide> sorted_sides(const TriangleSoup& soup) {
  std::vector<EdgeSide> sides;
  sides.reserve(3 * soup.triangles.size());
  for (std::uint32_t i = 0; i < soup.triangles.size(); ++i) {
    const TriangleIndices& t = soup.triangles[i];
    const std::array<std::uint32_t, 3> v{t.a, t.b, t.c};
    for (std::uint32_t edge = 0; edge < 3; ++edge) {
      const std::uint32_t from = v[edge];
      const std::uint32_t to = v[(edge + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), 4 * i + edge, from < to});
    }
  }
  std::sort(sides.begin(), sides.end());
  return sides;
}

bool is_active(const TriangleSoup& soup, std::span<const EdgeSide> sides, Unit flat_cosine) {
  if (sides.size() != 2 || sides[0].rising == sides[1].rising) return true;
  const TriangleVertices neighbour = soup.triangle(sides[1].triangle());
  const auto apex = static_cast<std::size_t>((sides[1].edge() + 2) % 3);
  return is_edge_active(soup.triangle(sides[0].triangle()), sides[0].edge(), neighbour[apex],
                        flat_cosine);
}

// Calls `f(sides)` for the sides of each edge.
template <class F>
void for_each_edge(const std::vector<EdgeSide>& sides, F&& f) {
  for (std::size_t first = 0; first < sides.size();) {
    std::size_t end = first + 1;
    while (end < sides.size() && sides[end].same_edge(sides[first]))
      ++end;
    f(std::span<const EdgeSide>(&sides[first], end - first));
    first = end;
  }
}

}  // namespace

std::vector<SharedEdge> shared_edges(const TriangleSoup& soup) {
  std::vector<SharedEdge> shared;
  const auto add = [&](const EdgeSide& side, const EdgeSide& other) {
    shared.push_back({side.corner, soup.groups[other.triangle()]});
  };
  for_each_edge(sorted_sides(soup), [&](std::span<const EdgeSide> sides) {
    if (sides.size() != 2) return;  // active
    if (soup.groups[sides[0].triangle()] == soup.groups[sides[1].triangle()]) return;
    add(sides[0], sides[1]);
    add(sides[1], sides[0]);
  });
  std::ranges::sort(shared, {}, &SharedEdge::corner);
  return shared;
}

std::vector<std::uint8_t> classify_edges(const TriangleSoup& soup, Angle flat_angle) {
  const Unit flat_cosine = sin_cos(flat_angle).cos;
  const std::vector<EdgeSide> sides = sorted_sides(soup);
  std::vector<std::uint8_t> active(soup.triangles.size(), 0);
  for_each_edge(sides, [&](std::span<const EdgeSide> group) {
    const unsigned bit = is_active(soup, group, flat_cosine) ? 1 : 0;
    for (const EdgeSide& side : group) {
      std::uint8_t& edges = active[side.triangle()];
      edges = static_cast<std::uint8_t>(edges | (bit << side.edge()));
    }
  });
  return active;
}

}  // namespace lockstone::geometry
