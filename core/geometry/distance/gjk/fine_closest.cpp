#include "core/geometry/distance/gjk/fine_closest.h"

#include <limits>

#include "core/geometry/distance/gjk/fine_features.h"
#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_max_steps = 32;

/// The point nearest to the origin of the span of one to three vertices of B − A, if it lies
/// within.
struct Candidate {
  bool is_within = false;
  Simplex simplex{};
  RawVec normal{};  ///< from the origin to the point, of any length
  Fine distance = 0;
  FineFeatures features{};
};

/// The vertices of a simplex in fine lanes.
struct FineVertices {
  std::array<RawVec, 4> a{};
  std::array<RawVec, 4> b{};
};

FineVertices vertices_of(const FinePair& pair, const Simplex& all) {
  FineVertices vertices;
  for (std::size_t i = 0; i < static_cast<std::size_t>(all.count); ++i) {
    vertices.a[i] = vertex_of(pair.a, all.vertices[i].a);
    vertices.b[i] = vertex_of(pair.b, all.vertices[i].b) + pair.offset;
  }
  return vertices;
}

/// The span of those vertices whose bits are set.
Candidate span_of(const Simplex& all, const FineVertices& vertices, unsigned mask) {
  Candidate span;
  FineFeatures& features = span.features;
  for (std::size_t i = 0; i < static_cast<std::size_t>(all.count); ++i) {
    if ((mask >> i & 1) == 0) continue;
    const auto at = static_cast<std::size_t>(features.count++);
    span.simplex.vertices[at] = all.vertices[i];
    features.a[at] = vertices.a[i];
    features.b[at] = vertices.b[i];
    features.difference[at] = vertices.b[i] - vertices.a[i];
  }
  span.simplex.count = features.count;
  return span;
}

void find_on_vertex_or_edge(Candidate& span) {
  FineFeatures& features = span.features;
  if (features.count == 2) {
    weigh_edge(features);
    if (features.weight[1] == 0 || features.weight[1] == k_whole) return;
  }
  span.normal = blend(features, features.difference);
  span.distance = static_cast<Fine>(norm(span.normal.x, span.normal.y, span.normal.z));
  span.is_within = true;
}

void find_on_triangle(Candidate& span) {
  FineFeatures& features = span.features;
  const RawVec p = features.difference[1] - features.difference[0];
  const RawVec q = features.difference[2] - features.difference[0];
  RawVec normal = truncated(wide_cross(p, q), 61);
  const auto length = static_cast<std::int64_t>(norm(normal.x, normal.y, normal.z));
  if (length < std::int64_t{1} << 40) return;  // a sliver: its edges will do
  Fine distance = round_divide(wide_dot(normal, features.difference[0]), length);
  if (distance < 0) {
    normal = -normal;
    distance = -distance;
  }
  if (!weigh_foot(features, scaled_by_ratio(normal, distance, length), normal)) return;
  span.normal = normal;
  span.distance = distance;
  span.is_within = true;
}

/// Of the direction's length.
Fine height_along(const RawVec& direction, const Int128& product) {
  return round_divide(product,
                      static_cast<std::int64_t>(norm(direction.x, direction.y, direction.z)));
}

/// The least height of vertices along a candidate's normal: that of the nearest point only for the
/// candidate that holds it, and less for all others.
Fine least_height(const Simplex& all, const FineVertices& vertices, const RawVec& normal) {
  const RawVec direction = truncated(normal, 61);
  Int128 least{};
  for (std::size_t i = 0; i < static_cast<std::size_t>(all.count); ++i) {
    const Int128 product = wide_dot(direction, vertices.b[i] - vertices.a[i]);
    if (i == 0 || product < least) least = product;
  }
  return height_along(direction, least);
}

/// The nearest points and the highest plane met so far: bounds of the distance from both sides.
struct Bounds {
  Candidate nearest{};
  RawVec normal{};  ///< of the highest plane
  Fine height = std::numeric_limits<Fine>::min();

  void take_points(const Candidate& candidate) {
    if (!nearest.is_within || candidate.distance < nearest.distance) nearest = candidate;
  }
  void take_plane(const RawVec& direction, Fine least_height) {
    if (least_height <= height) return;
    height = least_height;
    normal = direction;
  }
  [[nodiscard]] bool meet() const {
    return nearest.is_within && height >= nearest.distance - k_proof;
  }
};

/// Of all vertices, edges and triangles the one whose plane separates most, the first of equals:
/// distances would tell less, because beside a giant they hardly change where normals do.
Candidate nearest_of(const FinePair& pair, const Simplex& all, Bounds& bounds) {
  Candidate best;
  Fine highest = std::numeric_limits<Fine>::min();
  const FineVertices vertices = vertices_of(pair, all);
  const unsigned masks = std::min(1U << all.count, 15U);
  for (unsigned mask = 1; mask < masks; ++mask) {
    Candidate candidate = span_of(all, vertices, mask);
    candidate.simplex.count == 3 ? find_on_triangle(candidate) : find_on_vertex_or_edge(candidate);
    if (!candidate.is_within || candidate.normal == RawVec{}) continue;
    bounds.take_points(candidate);
    const Fine height = least_height(all, vertices, candidate.normal);
    if (height <= highest) continue;
    best = candidate;
    highest = height;
  }
  return best;
}

struct Extreme {
  int vertex = 0;
  Int128 product{};
};

/// The vertex greatest along a direction whose lanes fit 61 bits, about the core's reference.
Extreme greatest_along(const ConvexCore& core, const RawVec& direction) {
  Extreme best;
  if (core.rims.count != 0) {
    best.vertex = farthest_rim_vertex(core.rims, direction);
    best.product = wide_dot(direction, vertex_of(core, best.vertex));
    return best;
  }
  const int count = vertex_count(core);
  for (int i = 0; i < count; ++i) {
    const Int128 product = wide_dot(direction, vertex_of(core, i));
    if (i == 0 || product > best.product) best = {static_cast<int>(i), product};
  }
  return best;
}

struct LeastVertex {
  DifferenceVertex vertex{};
  Fine height = 0;  ///< along the direction
};

LeastVertex least_vertex(const FinePair& pair, const RawVec& direction) {
  const Extreme a = greatest_along(pair.a, direction);
  const Extreme b = greatest_along(pair.b, -direction);
  const Int128 product = wide_dot(direction, pair.offset) - a.product - b.product;
  return {{{}, a.vertex, b.vertex}, height_along(direction, product)};
}

bool has(const Simplex& simplex, const DifferenceVertex& vertex) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(simplex.count); ++i)
    if (simplex.vertices[i].a == vertex.a && simplex.vertices[i].b == vertex.b) return true;
  return false;
}

FineClosest closest_of(const Candidate& nearest, const RawVec& n, bool apart) {
  const FineFeatures& features = nearest.features;
  return {{direction_of(n.x, n.y, n.z), nearest.distance, blend(features, features.a),
           blend(features, features.b)},
          nearest.simplex,
          apart};
}

/// The points lie along the normal. Of another plane that proves a distance d within ε they would
/// be aside by up to √(2εd), which beside a giant is millimetres.
FineClosest proven(const Candidate& candidate) {
  return closest_of(candidate, candidate.normal, true);
}

FineClosest of_bounds(const Bounds& bounds) {
  if (!bounds.nearest.is_within) return {};
  return closest_of(bounds.nearest, bounds.normal, bounds.meet() || bounds.height > 0);
}

}  // namespace

FineClosest fine_closest(const FinePair& pair, const Simplex& start) {
  Bounds bounds;
  Simplex simplex = start;
  for (int step = 0; step < k_max_steps; ++step) {
    const Candidate candidate = nearest_of(pair, simplex, bounds);
    if (!candidate.is_within) break;
    const LeastVertex least = least_vertex(pair, truncated(candidate.normal, 61));
    if (least.height >= candidate.distance - k_proof) return proven(candidate);
    bounds.take_plane(candidate.normal, least.height);
    if (has(candidate.simplex, least.vertex)) break;
    simplex = candidate.simplex;
    simplex.vertices[static_cast<std::size_t>(simplex.count++)] = least.vertex;
  }
  return of_bounds(bounds);
}

}  // namespace lockstone::geometry
