#include "core/geometry/distance/gjk/simplex.h"

#include <utility>

namespace lockstone::geometry {
namespace {

using Vertex = DifferenceVertex;

/// The sign of (a × b) · c.
Int128 determinant(const RawVec& a, const RawVec& b, const RawVec& c) {
  return wide_dot(narrow_cross(a, b), c);
}

/// Whether the foot of the origin on the line ab is strictly between a and b.
bool foot_is_inside(const RawVec& a, const RawVec& b) {
  const RawVec edge = b - a;
  return narrow_dot(a, edge) < 0 && narrow_dot(b, edge) > 0;
}

bool foot_is_inside(const RawVec& a, const RawVec& b, const RawVec& c) {
  const TriangleWeights weights = weights_of(a, b, c);
  for (const Int128& weight : weights.numerators) {
    if (!is_positive(weight)) return false;
  }
  return true;
}

Simplex edge_of(const Vertex& a, const Vertex& b) {
  return {2, {a, b}, narrow_cross(a.point, b.point - a.point)};
}

/// The triangle, turned so that its normal points away from the origin; `flat`: the origin is in
/// its plane.
Simplex triangle_of(const Vertex& a, const Vertex& b, const Vertex& c, bool& flat) {
  const RawVec normal = narrow_cross(b.point - a.point, c.point - a.point);
  const Int128 height = wide_dot(normal, a.point);
  flat = is_zero(height);
  if (height.negative()) return {3, {a, c, b}, -normal};
  return {3, {a, b, c}, normal};
}

bool is_origin_on(const Simplex& simplex) {
  return simplex.normal == RawVec{};
}

/// The best of a vertex `u` alone and its edges to the others; `u` is part of the answer.
bool keep_edge_or_vertex(Simplex& simplex, const Vertex& u, const std::array<Vertex, 3>& others,
                         int count) {
  for (int i = 0; i < count; ++i) {
    const Vertex& p = others[static_cast<std::size_t>(i)];
    if (!foot_is_inside(u.point, p.point)) continue;
    const Simplex edge = edge_of(u, p);
    bool optimal = true;
    for (int k = 0; k < count; ++k) {
      if (k != i && improves(edge, others[static_cast<std::size_t>(k)].point)) optimal = false;
    }
    if (!optimal) continue;
    simplex = edge;
    return is_origin_on(simplex);
  }
  simplex = simplex_of(u);
  return is_origin_on(simplex);
}

bool extend_edge(Simplex& simplex, const Vertex& u) {
  const Vertex p = simplex.vertices[0];
  const Vertex q = simplex.vertices[1];
  if (foot_is_inside(u.point, p.point, q.point)) {
    bool flat = false;
    simplex = triangle_of(u, p, q, flat);
    return flat;
  }
  return keep_edge_or_vertex(simplex, u, {p, q, {}}, 2);
}

/// `u` is strictly on the origin's side of the triangle, so the origin lies in the tetrahedron
/// exactly when it is beyond none of the three new faces.
bool extend_triangle(Simplex& simplex, const Vertex& u) {
  const std::array<Vertex, 3> others{simplex.vertices[0], simplex.vertices[1], simplex.vertices[2]};
  bool inside = true;
  for (std::size_t i = 0; i < 3; ++i) {
    // The normal points away from the origin and from u, so the origin's weight at vertex i has the
    // sign of −(u × j) · k.
    const Vertex& j = others[(i + 1) % 3];
    const Vertex& k = others[(i + 2) % 3];
    if (!is_positive(determinant(u.point, j.point, k.point))) continue;
    inside = false;
    if (!foot_is_inside(u.point, j.point, k.point)) continue;
    bool flat = false;
    simplex = triangle_of(u, j, k, flat);
    return flat;
  }
  if (inside) {
    simplex.vertices[3] = u;
    simplex.count = 4;
    return true;
  }
  return keep_edge_or_vertex(simplex, u, others, 3);
}

}  // namespace

Simplex simplex_of(const DifferenceVertex& vertex) {
  return {1, {vertex}, vertex.point};
}

bool improves(const Simplex& simplex, const RawVec& point) {
  const RawVec& first = simplex.vertices[0].point;
  const RawVec step = point - first;
  if (simplex.count == 1) return narrow_dot(first, step) < 0;
  if (simplex.count == 3) return wide_dot(simplex.normal, step).negative();
  // v ∝ e × (first × e), so v · step ∝ (first × e) · (step × e).
  const RawVec edge = simplex.vertices[1].point - first;
  return wide_dot(simplex.normal, narrow_cross(step, edge)).negative();
}

bool extend(Simplex& simplex, const DifferenceVertex& vertex) {
  if (simplex.count == 3) return extend_triangle(simplex, vertex);
  if (simplex.count == 2) return extend_edge(simplex, vertex);
  return keep_edge_or_vertex(simplex, vertex, {simplex.vertices[0], {}, {}}, 1);
}

RawVec direction_to(const Simplex& simplex) {
  constexpr int bits = 31;
  if (simplex.count == 1) return simplex.normal;
  if (simplex.count == 3) return truncated(simplex.normal, bits);
  const RawVec edge = simplex.vertices[1].point - simplex.vertices[0].point;
  return truncated(wide_cross(edge, simplex.normal), bits);
}

TriangleWeights weights_of(const RawVec& a, const RawVec& b, const RawVec& c) {
  const RawVec ab = narrow_cross(a, b);
  const RawVec bc = narrow_cross(b, c);
  const RawVec ca = narrow_cross(c, a);
  const RawVec normal = ab + bc + ca;
  return {{wide_dot(normal, bc), wide_dot(normal, ca), wide_dot(normal, ab)},
          wide_dot(normal, normal)};
}

}  // namespace lockstone::geometry
