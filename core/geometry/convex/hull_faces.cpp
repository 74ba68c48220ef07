#include "core/geometry/convex/hull_faces.h"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "core/geometry/numeric/exact_plane.h"

namespace lockstone::geometry {
namespace {

using Vertices = std::span<const Vec3<Length>>;

constexpr std::uint16_t k_no_index = 0xffff;

/// v · n in the asset's own frame: below 2^62.
Fine along_normal(const Vec3<Length>& v, const Vec3<Unit>& n) {
  return dot(v, n).raw;
}

// By their indices, one after the other. Not by <=> of vectors: that of g++ 12's library looks at
// half of the bytes where the processor is big-endian.
void sort(std::vector<Loop>& loops) {
  std::ranges::sort(loops, [](const Loop& a, const Loop& b) {
    return std::ranges::lexicographical_compare(a, b);
  });
}

void sort_unique(std::vector<std::uint16_t>& indices) {
  std::ranges::sort(indices);
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

struct Edge {
  std::uint16_t from = 0;
  std::uint16_t to = 0;
};

Edge edge_of(std::span<const std::uint16_t> loop, std::size_t i) {
  return {loop[i], loop[i + 1 == loop.size() ? 0 : i + 1]};
}

/// The cycle that the edges form, the least index first; empty when they are not one simple cycle.
Loop cycle_of(std::span<const Edge> edges) {
  std::array<std::uint16_t, k_max_polytope_vertices> next{};
  next.fill(k_no_index);
  std::uint16_t start = k_no_index;
  for (const Edge& edge : edges) {
    if (next[edge.from] != k_no_index) return {};
    next[edge.from] = edge.to;
    start = std::min(start, edge.from);
  }
  Loop loop;
  for (std::uint16_t v = start; v != k_no_index && loop.size() < edges.size(); v = next[v]) {
    if (v == start && !loop.empty()) return {};
    loop.push_back(v);
  }
  return loop;
}

/// Which face each half edge belongs to.
class EdgeOwners {
 public:
  explicit EdgeOwners(std::size_t vertex_count)
      : stride_(vertex_count), owner_(vertex_count * vertex_count, k_no_index) {}

  [[nodiscard]] std::uint16_t& at(Edge edge) { return owner_[edge.from * stride_ + edge.to]; }
  [[nodiscard]] std::uint16_t beyond(Edge edge) const {
    return owner_[edge.to * stride_ + edge.from];
  }
  void give(std::span<const std::uint16_t> loop, std::uint16_t face) {
    for (std::size_t i = 0; i < loop.size(); ++i)
      at(edge_of(loop, i)) = face;
  }

 private:
  std::size_t stride_;
  std::vector<std::uint16_t> owner_;
};

/// Groups of triangles in exactly one plane.
class Coplanar {
 public:
  Coplanar(Vertices vertices, std::span<const Triangle> triangles)
      : triangles_(triangles), owners_(vertices.size()), root_(triangles.size()) {
    std::iota(root_.begin(), root_.end(), std::uint16_t{0});
    for (std::size_t t = 0; t < triangles.size(); ++t)
      owners_.give(triangles[t], static_cast<std::uint16_t>(t));
    for (std::size_t t = 0; t < triangles.size(); ++t)
      join_neighbours(vertices, t);
  }

  [[nodiscard]] std::vector<Loop> loops() {
    std::vector<std::vector<Edge>> outlines(triangles_.size());
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const std::uint16_t group = find(static_cast<std::uint16_t>(t));
      for (std::size_t i = 0; i < 3; ++i) {
        const Edge edge = edge_of(triangles_[t], i);
        if (find(owners_.beyond(edge)) != group) outlines[group].push_back(edge);
      }
    }
    std::vector<Loop> result;
    for (const auto& outline : outlines)
      if (!outline.empty()) result.push_back(cycle_of(outline));
    sort(result);
    return result;
  }

 private:
  std::uint16_t find(std::uint16_t t) {
    while (root_[t] != t)
      t = root_[t] = root_[root_[t]];
    return t;
  }

  void join_neighbours(Vertices vertices, std::size_t t) {
    const Triangle& corners = triangles_[t];
    const ExactPlane plane =
        plane_through(vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]);
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint16_t other = owners_.beyond(edge_of(corners, i));
      const auto is_in_plane = [&](std::uint16_t v) { return side(plane, vertices[v]) == 0; };
      if (std::ranges::all_of(triangles_[other], is_in_plane)) {
        root_[find(other)] = find(static_cast<std::uint16_t>(t));
      }
    }
  }

  std::span<const Triangle> triangles_;
  EdgeOwners owners_;
  std::vector<std::uint16_t> root_;
};

/// Where the loop does not turn left, seen against `normal`; exact for that normal.
std::vector<std::uint16_t> dents_of(Vertices vertices, const Loop& loop, const Vec3<Unit>& normal) {
  std::vector<std::uint16_t> dents;
  const RawVec axis = raws_of(normal);
  RawVec before = difference(vertices[loop.front()], vertices[loop.back()]);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Edge edge = edge_of(loop, i);
    const RawVec after = difference(vertices[edge.to], vertices[edge.from]);
    if (dot_wide(cross(before, after), axis) <= Int128{}) dents.push_back(edge.from);
    before = after;
  }
  return dents;
}

/// Newell: twice the vector area, fanned from the first vertex.
Vec3<Unit> mean_normal(Vertices vertices, const Loop& loop) {
  std::array<Int128, 3> sum{};
  const Vec3<Length> apex = vertices[loop[0]];
  for (std::size_t i = 2; i < loop.size(); ++i) {
    const RawVec area =
        cross(difference(vertices[loop[i - 1]], apex), difference(vertices[loop[i]], apex));
    for (int axis = 0; axis < 3; ++axis) {
      Int128& component = sum[static_cast<std::size_t>(axis)];
      component = component + Int128::from(area[axis]);
    }
  }
  UInt128 all{};
  for (const Int128& component : sum)
    all = std::max(all, magnitude(component));
  const int excess = std::max(0, 66 - countl_zero(all));  // bring it below 2^62
  const auto reduced = [excess](const Int128& x) {
    return saturate_to_int64(round_shift(x, excess));
  };
  return direction_of(reduced(sum[0]), reduced(sum[1]), reduced(sum[2]));
}

Fine lowest(Vertices vertices, const Loop& loop, const Vec3<Unit>& normal) {
  Fine low = std::numeric_limits<Fine>::max();
  for (const std::uint16_t v : loop)
    low = std::min(low, along_normal(vertices[v], normal));
  return low;
}

struct MergeCandidate {
  std::uint16_t a = 0;
  std::uint16_t b = 0;
  Fine depth = 0;

  friend bool operator<(const MergeCandidate& x, const MergeCandidate& y) {
    return std::tie(x.depth, x.a, x.b) < std::tie(y.depth, y.a, y.b);
  }
};

/// Merges faces that are nearly in one plane.
class Merger {
 public:
  Merger(Vertices vertices, std::vector<Loop> loops, Length tolerance)
      : vertices_(vertices),
        tolerance_(fine(tolerance)),
        loops_(std::move(loops)),
        owners_(vertices.size()) {
    for (std::size_t face = 0; face < loops_.size(); ++face) {
      owners_.give(loops_[face], static_cast<std::uint16_t>(face));
      normals_.push_back(mean_normal(vertices, loops_[face]));
    }
    for (std::size_t face = 0; face < loops_.size(); ++face)
      consider_neighbours(static_cast<std::uint16_t>(face), face);
  }

  MergedFaces run() {
    while (!candidates_.empty()) {
      const MergeCandidate best = *std::min_element(candidates_.begin(), candidates_.end());
      merge(best.a, best.b);
    }
    dented_.clear();  // only dents between the final faces count
    for (std::size_t face = 0; face < loops_.size(); ++face)
      consider_neighbours(static_cast<std::uint16_t>(face), face);
    std::erase_if(loops_, [](const Loop& loop) { return loop.empty(); });
    sort(loops_);
    sort_unique(dented_);
    return {std::move(loops_), std::move(dented_)};
  }

 private:
  [[nodiscard]] Loop union_of(std::uint16_t a, std::uint16_t b) const {
    std::vector<Edge> outline;
    const auto take = [&](const Loop& loop, std::uint16_t other) {
      for (std::size_t i = 0; i < loop.size(); ++i)
        if (owners_.beyond(edge_of(loop, i)) != other) outline.push_back(edge_of(loop, i));
    };
    take(loops_[a], b);
    take(loops_[b], a);
    return cycle_of(outline);
  }

  /// How far vertices would lie below the merged face; nothing when it must not be.
  std::optional<Fine> depth_of_union(std::uint16_t a, std::uint16_t b) {
    const Loop loop = union_of(a, b);
    if (loop.size() < 3) return std::nullopt;
    const Vec3<Unit> normal = mean_normal(vertices_, loop);
    const bool faces_both = dot(normal, normals_[a]).raw > 0 && dot(normal, normals_[b]).raw > 0;
    if (!faces_both) return std::nullopt;
    const Fine low = lowest(vertices_, loop, normal);
    Fine depth = 0;
    for (const Vec3<Length>& vertex : vertices_) {
      depth = std::max(depth, along_normal(vertex, normal) - low);
      if (depth > tolerance_) return std::nullopt;
    }
    const auto dents = dents_of(vertices_, loop, normal);
    dented_.insert(dented_.end(), dents.begin(), dents.end());
    return dents.empty() ? std::optional(depth) : std::nullopt;
  }

  /// Pairs of `face` and its neighbours with at least the index `from`, each once.
  void consider_neighbours(std::uint16_t face, std::size_t from) {
    std::vector<std::uint16_t> others;
    for (std::size_t i = 0; i < loops_[face].size(); ++i)
      others.push_back(owners_.beyond(edge_of(loops_[face], i)));
    sort_unique(others);
    for (const std::uint16_t other : others) {
      if (other < from) continue;
      const auto [a, b] = std::minmax(face, other);
      if (const auto depth = depth_of_union(a, b)) candidates_.push_back({a, b, *depth});
    }
  }

  void merge(std::uint16_t a, std::uint16_t b) {
    loops_[a] = union_of(a, b);
    loops_[b].clear();
    owners_.give(loops_[a], a);
    normals_[a] = mean_normal(vertices_, loops_[a]);
    std::erase_if(candidates_, [a, b](const MergeCandidate& c) {
      return c.a == a || c.b == a || c.a == b || c.b == b;
    });
    consider_neighbours(a, 0);
  }

  Vertices vertices_;
  Fine tolerance_;
  std::vector<Loop> loops_;
  std::vector<Vec3<Unit>> normals_;
  EdgeOwners owners_;
  std::vector<MergeCandidate> candidates_;
  std::vector<std::uint16_t> dented_;
};

}  // namespace

SupportingFace supporting_face(Vertices vertices, const Loop& loop) {
  SupportingFace face;
  face.normal = mean_normal(vertices, loop);
  face.offset = std::numeric_limits<Fine>::min();
  for (const Vec3<Length>& vertex : vertices)
    face.offset = std::max(face.offset, along_normal(vertex, face.normal));
  face.depth = face.offset - lowest(vertices, loop, face.normal);
  return face;
}

MergedFaces merge_faces(Vertices vertices, std::span<const Triangle> triangles, Length tolerance) {
  return Merger(vertices, Coplanar(vertices, triangles).loops(), tolerance).run();
}

}  // namespace lockstone::geometry
