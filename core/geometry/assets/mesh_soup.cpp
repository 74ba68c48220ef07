// Welding and the canonical order of a mesh's vertices and triangles.
#include <algorithm>
#include <numeric>
#include <tuple>

#include "core/geometry/assets/mesh_data.h"

namespace lockstone::geometry {
namespace {

constexpr std::uint32_t k_none = 0xffffffff;

auto key(const Vec3<Length>& v) {
  return std::tuple(v.x, v.y, v.z);
}

/// A cell of a grid whose side exceeds the weld tolerance by one: two vertices of one cell are
/// always within it, so a cell has at most one representative.
struct Cell {
  std::int32_t x = 0;
  std::int32_t y = 0;
  std::int32_t z = 0;

  friend constexpr auto operator<=>(const Cell&, const Cell&) = default;
};

/// Floor division of a coordinate, made positive first: coordinates are above −2^31.
std::int32_t cell_of(Length x, Length side) {
  return static_cast<std::int32_t>((std::int64_t{x.raw} + (std::int64_t{1} << 31)) / side.raw);
}

bool is_near(Length a, Length b, Length tolerance) {
  const std::int64_t difference = std::int64_t{a.raw} - b.raw;
  return difference <= tolerance.raw && -difference <= tolerance.raw;
}

/// The representatives so far, by cell.
class WeldGrid {
 public:
  WeldGrid(std::span<const Vec3<Length>> vertices, Length tolerance)
      : vertices_(vertices), tolerance_(tolerance), side_(tolerance + Length::from_raw(1)) {
    for (const Vec3<Length>& v : vertices)
      cells_.push_back(cell(v));
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
    occupant_.assign(cells_.size(), k_none);
  }

  /// The lowest representative within the tolerance of the vertex, or the vertex itself, which then
  /// is one.
  std::uint32_t place(std::uint32_t vertex) {
    const Cell own = cell(vertices_[vertex]);
    std::uint32_t best = k_none;
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy)
        best = std::min(best, lowest_in_column({own.x + dx, own.y + dy, own.z - 1}, vertex));
    }
    if (best != k_none) return best;
    const auto at = std::lower_bound(cells_.begin(), cells_.end(), own) - cells_.begin();
    occupant_[static_cast<std::size_t>(at)] = vertex;
    return vertex;
  }

 private:
  [[nodiscard]] Cell cell(const Vec3<Length>& v) const {
    return {cell_of(v.x, side_), cell_of(v.y, side_), cell_of(v.z, side_)};
  }

  /// Of the three cells from `first` upward in z.
  [[nodiscard]] std::uint32_t lowest_in_column(const Cell& first, std::uint32_t vertex) const {
    const Cell last{first.x, first.y, first.z + 2};
    std::uint32_t best = k_none;
    auto at = std::lower_bound(cells_.begin(), cells_.end(), first);
    for (; at != cells_.end() && *at <= last; ++at) {
      const std::uint32_t candidate = occupant_[static_cast<std::size_t>(at - cells_.begin())];
      if (candidate < best && is_within(candidate, vertex)) best = candidate;
    }
    return best;
  }

  [[nodiscard]] bool is_within(std::uint32_t a, std::uint32_t b) const {
    const Vec3<Length>& p = vertices_[a];
    const Vec3<Length>& q = vertices_[b];
    return is_near(p.x, q.x, tolerance_) && is_near(p.y, q.y, tolerance_) &&
           is_near(p.z, q.z, tolerance_);
  }

  std::span<const Vec3<Length>> vertices_;
  Length tolerance_;
  Length side_;
  std::vector<Cell> cells_;  // ascending
  std::vector<std::uint32_t> occupant_;
};

/// Sorts the vertices and points the triangles at their new places.
void sort_vertices(TriangleSoup& soup) {
  std::vector<std::uint32_t> order(soup.vertices.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const auto a = key(soup.vertices[i]);
    const auto b = key(soup.vertices[j]);
    return a != b ? a < b : i < j;
  });
  std::vector<std::uint32_t> place(order.size());
  std::vector<Vec3<Length>> sorted;
  sorted.reserve(order.size());
  for (const std::uint32_t i : order) {
    place[i] = static_cast<std::uint32_t>(sorted.size());
    sorted.push_back(soup.vertices[i]);
  }
  soup.vertices = std::move(sorted);
  for (TriangleIndices& t : soup.triangles)
    t = {place[t.a], place[t.b], place[t.c]};
}

TriangleIndices lowest_first(const TriangleIndices& t) {
  if (t.a <= t.b && t.a <= t.c) return t;
  if (t.b <= t.c) return {t.b, t.c, t.a};
  return {t.c, t.a, t.b};
}

struct SurfacedTriangle {
  TriangleIndices indices;
  std::uint8_t surface = k_own_surface;
  std::uint16_t group = 0;
  TriangleSource source;

  friend constexpr auto operator<=>(const SurfacedTriangle&, const SurfacedTriangle&) = default;
};

/// Drops triangles without area and repeats, and sorts the rest.
void sort_triangles(TriangleSoup& soup, SoupCounts& counts) {
  std::vector<SurfacedTriangle> kept;
  kept.reserve(soup.triangles.size());
  for (std::size_t i = 0; i < soup.triangles.size(); ++i) {
    const TriangleIndices& t = soup.triangles[i];
    if (is_degenerate(soup.triangle(t))) {
      ++counts.degenerate_triangles;
    } else {
      kept.push_back({lowest_first(t), soup.surfaces.empty() ? k_own_surface : soup.surfaces[i],
                      soup.groups.empty() ? std::uint16_t{0} : soup.groups[i],
                      soup.sources.empty() ? TriangleSource{} : soup.sources[i]});
    }
  }
  std::sort(kept.begin(), kept.end());
  const auto same = [](const SurfacedTriangle& a, const SurfacedTriangle& b) {
    return a.indices == b.indices;
  };
  const auto end = std::unique(kept.begin(), kept.end(), same);
  counts.duplicate_triangles += static_cast<std::uint32_t>(kept.end() - end);
  kept.erase(end, kept.end());
  const bool plain = std::all_of(kept.begin(), kept.end(), [](const SurfacedTriangle& t) {
    return t.surface == k_own_surface;
  });
  const bool single =
      std::all_of(kept.begin(), kept.end(), [](const SurfacedTriangle& t) { return t.group == 0; });
  const bool joined = !soup.sources.empty();
  soup.triangles.clear();
  soup.surfaces.clear();
  soup.groups.clear();
  soup.sources.clear();
  for (const SurfacedTriangle& t : kept) {
    soup.triangles.push_back(t.indices);
    if (!plain) soup.surfaces.push_back(t.surface);
    if (!single) soup.groups.push_back(t.group);
    if (joined) soup.sources.push_back(t.source);
  }
}

/// Keeps the order.
void drop_unused_vertices(TriangleSoup& soup) {
  std::vector<std::uint32_t> place(soup.vertices.size(), k_none);
  for (const TriangleIndices& t : soup.triangles)
    place[t.a] = place[t.b] = place[t.c] = 0;
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < place.size(); ++i) {
    if (place[i] == k_none) continue;
    soup.vertices[count] = soup.vertices[i];
    place[i] = count++;
  }
  soup.vertices.resize(count);
  for (TriangleIndices& t : soup.triangles)
    t = {place[t.a], place[t.b], place[t.c]};
}

}  // namespace

std::vector<std::uint32_t> weld(std::span<const Vec3<Length>> vertices, Length tolerance) {
  std::vector<std::uint32_t> result(vertices.size());
  std::iota(result.begin(), result.end(), std::uint32_t{0});
  if (tolerance.raw == 0) {
    for (std::size_t i = 1; i < vertices.size(); ++i)
      if (vertices[i] == vertices[i - 1]) result[i] = result[i - 1];
    return result;
  }
  WeldGrid grid(vertices, tolerance);
  for (std::uint32_t& vertex : result)
    vertex = grid.place(vertex);
  return result;
}

SoupCounts canonicalise(TriangleSoup& soup, Length weld_tolerance) {
  SoupCounts counts;
  sort_vertices(soup);
  const std::vector<std::uint32_t> becomes = weld(soup.vertices, weld_tolerance);
  for (std::uint32_t i = 0; i < becomes.size(); ++i)
    counts.welded_vertices += becomes[i] != i ? 1U : 0U;
  for (TriangleIndices& t : soup.triangles)
    t = {becomes[t.a], becomes[t.b], becomes[t.c]};
  sort_triangles(soup, counts);
  drop_unused_vertices(soup);
  return counts;
}

}  // namespace lockstone::geometry
