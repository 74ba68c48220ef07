#include "core/geometry/convex/polytope.h"

#include <algorithm>

#include "core/math/roots.h"

namespace lockstone::geometry {

// A mean of two unit vectors is shortest in their middle, where its square is (1 + cosine) / 2.
Unit least_mean_normal_of(std::span<const PolytopeFace> faces, std::span<const HalfEdge> edges) {
  constexpr std::int64_t one = std::int64_t{1} << (2 * Unit::frac_bits);
  constexpr std::int64_t rounding = one >> 27;  // of the cosine of rounded normals
  std::int64_t least = one;
  for (const HalfEdge& edge : edges) {
    const Fine cosine =
        lockstone::dot(faces[edge.face].normal, faces[edges[edge.twin].face].normal).raw;
    least = std::min(least, (one + cosine) / 2);
  }
  const std::int64_t square = std::max<std::int64_t>(least - rounding, 0);
  return Unit::from_raw(static_cast<std::int32_t>(isqrt(static_cast<std::uint64_t>(square))));
}

Support support_of(const Polytope& polytope, const Vec3<Unit>& n) {
  if (polytope.wide != nullptr) {
    const lanes::Farthest farthest =
        lanes::farthest_point(polytope.wide->vertices, {n.x.raw, n.y.raw, n.z.raw});
    return {static_cast<int>(farthest.index), farthest.product};
  }
  Support best{0, lockstone::dot(polytope.vertices[0], n).raw};
  const int count = static_cast<int>(polytope.vertices.size());
  for (int i = 1; i < count; ++i) {
    const Fine height = lockstone::dot(polytope.vertices[static_cast<std::size_t>(i)], n).raw;
    if (height > best.height) best = {i, height};
  }
  return best;
}

lanes::Extent extent_along(const Polytope& polytope, const Vec3<Unit>& n) {
  if (polytope.wide != nullptr)
    return lanes::extent_along(polytope.wide->vertices, {n.x.raw, n.y.raw, n.z.raw});
  return {-support_of(polytope, -n).height, support_of(polytope, n).height};
}

int measure_heights(const Polytope& polytope, const RawVec& point, FaceHeights& heights) {
  const lanes::Direction32 narrow{static_cast<std::int32_t>(point.x),
                                  static_cast<std::int32_t>(point.y),
                                  static_cast<std::int32_t>(point.z)};
  const bool fits = RawVec{narrow[0], narrow[1], narrow[2]} == point;
  if (polytope.wide != nullptr && fits) {
    const PolytopeLanes& wide = *polytope.wide;
    return static_cast<int>(
        lanes::heights_above(wide.normals, wide.offsets, narrow, heights.data()).index);
  }
  std::size_t highest = 0;
  for (std::size_t i = 0; i < polytope.faces.size(); ++i) {
    const PolytopeFace& face = polytope.faces[i];
    heights[i] = point.x * face.normal.x.raw + point.y * face.normal.y.raw +
                 point.z * face.normal.z.raw - face.offset;
    if (heights[i] > heights[highest]) highest = i;
  }
  return static_cast<int>(highest);
}

void mark_faces(const Polytope& polytope, const FaceHeights& heights, Fine bound, FaceBits& marks) {
  marks = {};
  const std::size_t count = polytope.faces.size();
  if (polytope.wide == nullptr) {
    for (std::size_t i = 0; i < count; ++i)
      marks[i / 64] |= std::uint64_t{heights[i] >= bound} << (i % 64);
    return;
  }
  lanes::mark_at_least(heights.data(), polytope.wide->normals.count, bound, marks.data());
  if (count % 64 != 0) marks[count / 64] &= (std::uint64_t{1} << (count % 64)) - 1;
}

namespace {

/// A half edge that leaves the vertex.
std::size_t edge_from(const Polytope& polytope, int vertex) {
  if (polytope.wide != nullptr) return polytope.wide->leaving[vertex];
  std::size_t edge = 0;
  while (polytope.edges[edge].origin != vertex)
    ++edge;
  return edge;
}

}  // namespace

int most_opposed_face(const Polytope& polytope, int vertex, const Vec3<Unit>& direction) {
  const std::size_t first = edge_from(polytope, vertex);
  int best = polytope.edges[first].face;
  std::int64_t least =
      lockstone::dot(polytope.faces[static_cast<std::size_t>(best)].normal, direction).raw;
  std::uint16_t edge = next_edge(polytope, polytope.edges[first].twin);
  for (; edge != first; edge = next_edge(polytope, polytope.edges[edge].twin)) {
    const int face = polytope.edges[edge].face;
    const std::int64_t lean =
        lockstone::dot(polytope.faces[static_cast<std::size_t>(face)].normal, direction).raw;
    if (lean > least || (lean == least && face > best)) continue;
    best = face;
    least = lean;
  }
  return best;
}

}  // namespace lockstone::geometry
