#include "core/geometry/contact/feature/contact_feature.h"

#include <lockstone/assert.h>

#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// Whether a rounded polytope shows its edges and vertices where the best face leans from n by more
/// than 30°.
bool shows_round_part(const Polytope& p, const PolytopeFace& face, const Vec3<Unit>& local) {
  constexpr std::int64_t k_cosine = 998463904061845504;  // of 30°, 60 bits
  return p.radius > Length{} && lockstone::dot(face.normal, local).raw < k_cosine;
}

/// Whether a direction square to an edge, or nearly, is between the normals beside it.
bool is_between_faces(const Polytope& p, const HalfEdge& edge, const Vec3<Unit>& n) {
  constexpr std::int64_t k_slack = std::int64_t{1} << 50;
  const Vec3<Unit>& here = p.faces[edge.face].normal;
  const Vec3<Unit>& there = p.faces[p.edges[edge.twin].face].normal;
  const std::int64_t least = lockstone::dot(here, there).raw - k_slack;
  return lockstone::dot(n, here).raw >= least && lockstone::dot(n, there).raw >= least;
}

/// The edge at the vertex that leans least.
void round_part(const PosedShape& shape, int vertex, const Vec3<Unit>& local, ContactFeature& out) {
  LKS_ASSERT(shape.polytope != nullptr && is_unit(local));
  const Polytope& p = *shape.polytope;
  LKS_ASSERT(vertex >= 0 && vertex < static_cast<int>(p.vertices.size()));
  int best = -1;
  std::int64_t least = std::int64_t{1} << 60;
  for (std::size_t i = 0; i < p.edges.size(); ++i) {
    if (p.edges[i].origin != vertex || !is_between_faces(p, p.edges[i], local)) continue;
    const Vec3<Unit> way = direction_of(edge_vector(p, static_cast<int>(i)));
    const std::int64_t lean = magnitude_of(lockstone::dot(way, local).raw);
    if (lean > least || (lean == least && best >= 0)) continue;
    best = static_cast<int>(i);
    least = lean;
  }
  const auto add = [&](std::uint32_t id) {
    out.add(rotate(shape.rotation, fine(p.vertices[id])), id);
  };
  add(static_cast<std::uint32_t>(vertex));
  if (best >= 0) add(p.edges[p.edges[static_cast<std::size_t>(best)].twin].origin);
  LKS_ASSERT(out.count == (best >= 0 ? 2 : 1) && !out.is_flat);
}

void polytope_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) {
  LKS_ASSERT(shape.polytope != nullptr && is_unit(n));
  const Polytope& p = *shape.polytope;
  const Vec3<Unit> local = rotate_inverse(shape.rotation, n);
  const int vertex = support_of(p, local).vertex;
  const int face = p.one_sided ? 0 : most_opposed_face(p, vertex, -local);
  const PolytopeFace& f = p.faces[static_cast<std::size_t>(face)];
  out.radius = p.radius;
  if (shows_round_part(p, f, local)) return round_part(shape, vertex, local, out);
  out.is_flat = true;
  out.normal = unit_axis(lockstone::rotate(shape.rotation, f.normal));
  LKS_ASSERT(f.edge_count >= 3 && is_unit(out.normal));
  LKS_ASSERT(out.radius >= Length{});
  for (int i = 0; i < f.edge_count; ++i) {
    const int edge = f.first_edge + i;
    out.add(rotate(shape.rotation, fine(start_of(p, edge))),
            p.edges[static_cast<std::size_t>(edge)].origin);
  }
}

void box_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) {
  LKS_ASSERT(is_unit(n));
  const Vec3<Unit> local = rotate_inverse(shape.rotation, n);
  int axis = 0;
  for (int i = 1; i < 3; ++i)
    if (abs(local[i]) > abs(local[axis])) axis = i;
  const int sign = sign_of(local[axis].raw);
  const int first = (axis + 1) % 3, second = (axis + 2) % 3;
  out.is_flat = true;
  out.normal = unit_axis(signed_axis(shape.rotation.column(axis), sign));
  constexpr std::array<std::array<int, 2>, 4> k_corners{{{1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
  for (const auto& [along_first, along_second] : k_corners) {
    const int turned = along_first * sign;  // seen from the other side, the order is the other
    RawVec corner = along(shape.rotation.column(axis), shape.shape.size[axis] * sign);
    corner = corner + along(shape.rotation.column(first), shape.shape.size[first] * turned);
    corner = corner + along(shape.rotation.column(second), shape.shape.size[second] * along_second);
    const unsigned id = (sign > 0 ? 1U << axis : 0U) | (turned > 0 ? 1U << first : 0U) |
                        (along_second > 0 ? 1U << second : 0U);
    out.add(corner, id);
  }
}

/// Of a sphere or a capsule.
void ball_swept_feature(const PosedShape& shape, ContactFeature& out) {
  std::array<RawVec, 8> vertices;
  const int count = traits_of(shape.shape).vertices(shape.shape, vertices);
  out.radius = shape.shape.size.x;
  for (int i = 0; i < count; ++i)
    out.add(rotate(shape.rotation, vertices[static_cast<std::size_t>(i)]),
            static_cast<std::uint32_t>(i));
  LKS_ASSERT(out.count > 0);
}

}  // namespace

void find_feature(const PosedShape& shape, const Vec3<Unit>& n, ContactFeature& out) {
  out.count = 0;
  out.is_flat = false;
  out.radius = {};
  if (shape.polytope != nullptr) return polytope_feature(shape, n, out);
  const ShapeTraits& traits = traits_of(shape.shape);
  if (traits.find_feature != nullptr) return traits.find_feature(shape, n, out);
  return traits.core_radius != nullptr ? ball_swept_feature(shape, out)
                                       : box_feature(shape, n, out);
}

Fine reach_along(const PosedShape& shape, const Vec3<Unit>& n) {
  const Vec3<Unit> local = rotate_inverse(shape.rotation, n);
  if (shape.polytope != nullptr)
    return support_of(*shape.polytope, local).height + fine(shape.polytope->radius);
  return traits_of(shape.shape).reach(shape.shape, local);
}

}  // namespace lockstone::geometry
