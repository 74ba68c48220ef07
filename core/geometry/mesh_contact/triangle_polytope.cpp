#include "core/geometry/mesh_contact/triangle_polytope.h"

#include <algorithm>

#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/numeric/exact_plane.h"
#include "core/geometry/numeric/q50.h"
#include "core/math/predicates.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// Edges 0 … 2 run around the front, 3 … 5 around the back: from vertex 0 to 2 to 1.
constexpr std::array<HalfEdge, 6> k_half_edges{
    {{0, 5, 0}, {1, 4, 0}, {2, 3, 0}, {0, 2, 1}, {2, 1, 1}, {1, 0, 1}}};

RawVec doubled_area(const TriangleVertices& t) {
  return cross(difference(t[1], t[0]), difference(t[2], t[0]));
}

/// The greatest n · v, exact.
Fine support(const TriangleVertices& t, const Vec3<Unit>& n) {
  return std::max(
      {lockstone::dot(n, t[0]).raw, lockstone::dot(n, t[1]).raw, lockstone::dot(n, t[2]).raw});
}

Length third(Length a, Length b, Length c) {
  const std::int64_t sum = std::int64_t{a.raw} + b.raw + c.raw;
  return Length::from_raw(static_cast<std::int32_t>(raw::round_divide(sum, 3)));
}

}  // namespace

Vec3<Unit> triangle_normal(const TriangleVertices& triangle) {
  const RawVec n = doubled_area(triangle);
  return direction_of(n.x, n.y, n.z);
}

bool is_degenerate(const TriangleVertices& triangle) {
  return doubled_area(triangle) == RawVec{};
}

LocalBounds bounds_of(const TriangleVertices& triangle) {
  const auto& [a, b, c] = triangle;
  return {{min(min(a.x, b.x), c.x), min(min(a.y, b.y), c.y), min(min(a.z, b.z), c.z)},
          {max(max(a.x, b.x), c.x), max(max(a.y, b.y), c.y), max(max(a.z, b.z), c.z)}};
}

bool is_edge_active(const TriangleVertices& triangle, int edge, const Vec3<Length>& apex,
                    Unit flat_cosine) {
  const Vec3<Length>& from = triangle[static_cast<std::size_t>(edge)];
  const Vec3<Length>& to = triangle[static_cast<std::size_t>((edge + 1) % 3)];
  const int side = orient3d(lattice_point(triangle[0]), lattice_point(triangle[1]),
                            lattice_point(triangle[2]), lattice_point(apex));
  if (side > 0) return false;
  const auto cosine =
      lockstone::dot(triangle_normal(triangle), triangle_normal({to, from, apex})).raw;
  if (side == 0) return cosine < 0;
  constexpr Unit one = Unit::from_integer(1);
  return flat_cosine == one || cosine < (flat_cosine * one).raw;
}

TrianglePolytope::TrianglePolytope() {
  faces_[0].edge_count = 3;
  faces_[1].first_edge = 3;
  faces_[1].edge_count = 3;
  view_.vertices = vertices_;
  view_.faces = faces_;
  view_.edges = k_half_edges;
  view_.kernels = &polytope_kernels();
  view_.one_sided = true;
}

const Polytope& TrianglePolytope::set(const TriangleVertices& triangle) {
  vertices_ = triangle;
  const Vec3<Unit> normal = triangle_normal(triangle);
  faces_[0].normal = normal;
  faces_[0].offset = support(triangle, normal);
  faces_[1].normal = -normal;
  faces_[1].offset = support(triangle, -normal);
  const auto& [a, b, c] = triangle;
  view_.interior = {third(a.x, b.x, c.x), third(a.y, b.y, c.y), third(a.z, b.z, c.z)};
  return view_;
}

TrianglePart::TrianglePart() {
  part_.shape.kind = ShapeKind::hull;
}

const Part& TrianglePart::set(std::uint32_t index, const TriangleVertices& triangle,
                              std::uint8_t active_edges, const Surface* surface) {
  part_.index = index;
  part_.polytope = &polytope_.set(triangle);
  part_.surface = surface;
  part_.triangle = triangle_topology(active_edges);
  return part_;
}

}  // namespace lockstone::geometry
