#include "core/geometry/convex/polytope_box.h"

namespace lockstone::geometry {
namespace {

/// Vertex i has the negative sign on axis k where bit k of i is set.
constexpr int k_faces = 6;
constexpr int k_edges = 24;

/// The four vertices of face 2·axis + (negative ? 1 : 0), counter-clockwise from outside.
constexpr std::array<std::uint16_t, 4> face_loop(int face) {
  const int axis = face / 2;
  const int u = 1 << ((axis + 1) % 3);
  const int v = 1 << ((axis + 2) % 3);
  const int base = (face & 1) != 0 ? 1 << axis : 0;
  const auto vertex = [base](int bits) { return static_cast<std::uint16_t>(base | bits); };
  if ((face & 1) != 0) return {vertex(0), vertex(v), vertex(u | v), vertex(u)};
  return {vertex(0), vertex(u), vertex(u | v), vertex(v)};
}

constexpr std::array<HalfEdge, k_edges> make_edges() {
  std::array<HalfEdge, k_edges> edges{};
  for (int face = 0; face < k_faces; ++face) {
    const auto loop = face_loop(face);
    for (std::size_t i = 0; i < 4; ++i) {
      const std::size_t at = static_cast<std::size_t>(face) * 4 + i;
      edges[at] = {loop[i], 0, static_cast<std::uint16_t>(face)};
    }
  }
  const auto end = [&edges](std::size_t e) { return edges[e % 4 == 3 ? e - 3 : e + 1].origin; };
  for (std::size_t e = 0; e < k_edges; ++e) {
    for (std::size_t t = 0; t < k_edges; ++t) {
      if (edges[t].origin == end(e) && end(t) == edges[e].origin)
        edges[e].twin = static_cast<std::uint16_t>(t);
    }
  }
  return edges;
}

constexpr std::array<HalfEdge, k_edges> k_box_edges = make_edges();

}  // namespace

BoxPolytope::BoxPolytope(const Vec3<Length>& half_extents, Length radius) : radius_(radius) {
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool negative = (i >> axis & 1) != 0;
      vertices_[i][axis] = negative ? -half_extents[axis] : half_extents[axis];
    }
  }
  for (std::size_t i = 0; i < faces_.size(); ++i) {
    const int axis = static_cast<int>(i / 2);
    faces_[i].normal[axis] = Unit::from_integer(i % 2 == 0 ? 1 : -1);
    faces_[i].offset = fine(half_extents[axis]);
    faces_[i].first_edge = static_cast<std::uint16_t>(4 * i);
    faces_[i].edge_count = 4;
  }
}

Polytope BoxPolytope::view() const {
  constexpr Unit least_mean_normal = Unit::from_ratio(7071, 10'000);  // below the cosine of 45°
  return {vertices_, faces_,  k_box_edges, {},      nullptr,          false,
          0,         radius_, nullptr,     nullptr, least_mean_normal};
}

}  // namespace lockstone::geometry
