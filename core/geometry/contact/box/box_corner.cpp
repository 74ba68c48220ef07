#include "core/geometry/contact/box/box_corner.h"

#include <lockstone/assert.h>

#include "core/geometry/contact/box/box_segment.h"
#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/segment.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr std::uint32_t k_edge_bits = 2U << 13;
constexpr std::uint32_t k_vertex_bits = 3U << 13;

struct SupportEdge {
  Segment segment;
  std::uint32_t index = 0;  ///< axis and the signs of the other two
};

/// The edge along `axis` that reaches farthest towards `normal`; a tie takes the positive side.
SupportEdge support_edge(const PosedShape& box, const RawVec& centre, int axis,
                         const Vec3<Unit>& normal) {
  LKS_ASSERT(axis >= 0 && axis < 3 && is_unit(normal));
  SupportEdge result{{centre, box.rotation.column(axis), box.shape.size[axis]},
                     static_cast<std::uint32_t>(axis) << 2};
  for (int k = 1; k < 3; ++k) {
    const int other = (axis + k) % 3;
    const Vec3<Unit>& direction = box.rotation.column(other);
    const RawVec step = along(direction, box.shape.size[other]);
    const bool back = lockstone::dot(direction, normal).raw < 0;
    result.segment.centre = back ? result.segment.centre - step : result.segment.centre + step;
    if (back) result.index |= static_cast<std::uint32_t>(k);
  }
  return result;
}

/// Vertex 0 … 7 of a box, signs from the bits, in the axes whose columns are given.
RawVec vertex(const RawVec& centre, const RawVec& x, const RawVec& y, const RawVec& z, int index) {
  RawVec result = centre;
  result = (index & 1) != 0 ? result - x : result + x;
  result = (index & 2) != 0 ? result - y : result + y;
  return (index & 4) != 0 ? result - z : result + z;
}

/// The square of a gap in 24 fraction bits, or the greatest value when it exceeds 64 m and more.
std::uint64_t squared(const RawVec& gap) {
  std::uint64_t sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const Fine size = magnitude_of(gap[axis]);
    if (size >= Fine{1} << 57) return ~std::uint64_t{0};
    const auto lane = static_cast<std::uint64_t>(raw::round_shift(size, 26));
    sum += lane * lane;
  }
  return sum;
}

struct NearestCorner {
  bool found = false;
  bool of_b = true;
  int index = 0;
  RawVec point;  ///< in the other box's axes
  RawVec gap;    ///< likewise: from the other box to the vertex
  std::uint64_t square = ~std::uint64_t{0};
};

/// `edges` are the half edges and `centre` the centre of the box with the vertices, in the axes of
/// the other, whose half extents are `half`.
void find_nearest(NearestCorner& best, bool of_b, const RawVec& centre,
                  const std::array<RawVec, 3>& edges, const RawVec& half) {
  for (int index = 0; index < 8; ++index) {
    const RawVec point = vertex(centre, edges[0], edges[1], edges[2], index);
    const RawVec gap = excess_of(point, half);
    const std::uint64_t square = squared(gap);
    if (square < best.square) best = {true, of_b, index, point, gap, square};
  }
}

NearestCorner nearest_vertex(const BoxPair& pair) {
  std::array<RawVec, 3> edges_a;
  std::array<RawVec, 3> edges_b;
  for (int k = 0; k < 3; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const Vec3<Unit> a_in_b{pair.b_in_a[0][k], pair.b_in_a[1][k], pair.b_in_a[2][k]};
    edges_a[i] = along(a_in_b, pair.a.shape.size[k]);
    edges_b[i] = along(pair.b_in_a[i], pair.b.shape.size[k]);
  }
  NearestCorner best;
  find_nearest(best, true, pair.centre_in_a, edges_b, pair.half_a);
  find_nearest(best, false, -pair.centre_in_b, edges_a, pair.half_b);
  LKS_ASSERT(!best.found || (best.index >= 0 && best.index < 8));
  return best;
}

}  // namespace

EdgeContact edge_contact(const BoxPair& pair, const EdgeAxis& axis) {
  LKS_ASSERT(axis.found && is_unit(axis.normal));
  const SupportEdge a = support_edge(pair.a, {}, axis.axis_a, axis.normal);
  const SupportEdge b = support_edge(pair.b, fine(pair.offset), axis.axis_b, -axis.normal);
  const ClosestParameters at = closest_parameters(a.segment, b.segment);
  EdgeContact result;
  result.crossing = at.crossing;
  result.manifold.normal = axis.normal;
  const Witnesses witnesses{point_at(a.segment, at.on_a), point_at(b.segment, at.on_b)};
  add_point(result.manifold, witnesses, pair.offset, axis.separation, pair.margin,
            k_edge_bits | a.index << 4 | b.index);
  LKS_ASSERT(result.manifold.count <= 1);
  return result;
}

bool is_of_edges(std::uint32_t feature) {
  return feature >> 13 == k_edge_bits >> 13;
}

EdgeAxis edge_axis_of(const BoxPair& pair, std::uint32_t feature) {
  LKS_ASSERT(is_of_edges(feature));
  const auto axis = [](std::uint32_t index) { return static_cast<int>(index >> 2 & 3) % 3; };
  return edge_axis(pair, axis(feature >> 4), axis(feature));
}

Manifold vertex_manifold(const BoxPair& pair) {
  const NearestCorner best = nearest_vertex(pair);
  Manifold manifold;
  if (!best.found || best.gap == RawVec{}) return manifold;
  const Mat3& rotation = best.of_b ? pair.a.rotation : pair.b.rotation;
  const RawVec gap = rotate(rotation, best.gap);
  const Direction d = direction(gap.x, gap.y, gap.z);
  const auto distance = static_cast<Fine>(d.length);
  manifold.normal = best.of_b ? d.unit : -d.unit;
  LKS_ASSERT(is_unit(manifold.normal) && distance > 0);
  if (!keeps(distance, pair.margin)) return manifold;
  const RawVec tip = rotate(rotation, best.point);
  const RawVec foot = rotate(rotation, best.point - best.gap);
  const RawVec centre = fine(pair.offset);
  const Witnesses witnesses =
      best.of_b ? Witnesses{foot, tip} : Witnesses{centre + tip, centre + foot};
  const std::uint32_t side = best.of_b ? 0 : 8;
  add_point(manifold, witnesses, pair.offset, distance, pair.margin,
            k_vertex_bits | side | static_cast<std::uint32_t>(best.index));
  return manifold;
}

}  // namespace lockstone::geometry
