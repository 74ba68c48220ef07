#include "core/geometry/contact/polytope/polytope_point.h"

#include <algorithm>
#include <array>
#include <limits>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/polytope/polytope_edges.h"
#include "core/geometry/numeric/segment.h"
#include "core/geometry/numeric/wide_vectors.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

using Heights = std::array<Fine, k_max_polytope_faces>;

/// The sum of squares of three lanes below 2^63 in size.
UInt128 sum_of_squares(const RawVec& v) {
  const auto square = [](std::int64_t x) { return multiply_wide(magnitude(x), magnitude(x)); };
  return square(v.x) + square(v.y) + square(v.z);
}

std::int64_t size_of(const RawVec& v) {
  return magnitude_of(v.x) | magnitude_of(v.y) | magnitude_of(v.z);
}

constexpr std::int64_t k_whole_share = std::int64_t{1} << Unit::frac_bits;

/// v − share · way.
RawVec without(const RawVec& v, const Vec3<Length>& way, std::int64_t share) {
  return v - RawVec{way.x.raw * share, way.y.raw * share, way.z.raw * share};
}

/// The gap from the nearest point of an edge to `point`. Products of lanes of 30 bits; of greater
/// ones, cut to 30 bits first, a second step restores the precision that the cut lost.
RawVec gap_to_edge(const Polytope& polytope, int edge, const RawVec& point) {
  LKS_ASSERT(edge >= 0 && edge < static_cast<int>(polytope.edges.size()));
  const Vec3<Length> way = edge_vector(polytope, edge);
  const RawVec to_point = point - fine(start_of(polytope, edge));
  const RawVec lanes = raws_of(way);
  const RawVec coarse = shifted(to_point, k_fine_per_length);
  const int cut = (size_of(lanes) | size_of(coarse)) >> 30 != 0 ? 4 : 0;
  const RawVec cut_way = shifted(lanes, cut);
  const std::int64_t along_edge = narrow_dot(shifted(coarse, cut), cut_way);
  const std::int64_t whole = narrow_dot(cut_way, cut_way);
  if (along_edge <= 0 || whole == 0) return to_point;
  if (along_edge >= whole) return point - fine(end_of(polytope, edge));
  const RawVec gap =
      without(to_point, way, clamped_ratio(along_edge, Unit::frac_bits, whole, k_whole_share));
  const RawVec rest = shifted(gap, k_fine_per_length);
  if (cut == 0 || size_of(rest) >> 29 != 0) return gap;
  const std::int64_t missing = narrow_dot(rest, lanes);
  return without(gap, way, clamped_ratio(missing, Unit::frac_bits - 2 * cut, whole, k_whole_share));
}

struct EdgeChoice {
  int edge = -1;
  RawVec gap;
  UInt128 square;
};

/// The nearest of the edges of faces that see the point.
EdgeChoice nearest_edge(const Polytope& polytope, const Heights& heights, const RawVec& point) {
  EdgeChoice best;
  const int count = static_cast<int>(polytope.edges.size());
  for (int edge = 0; edge < count; ++edge) {
    const HalfEdge& half = polytope.edges[static_cast<std::size_t>(edge)];
    if (edge > half.twin) continue;
    const int twin_face = polytope.edges[half.twin].face;
    const bool seen = heights[half.face] > 0 || heights[static_cast<std::size_t>(twin_face)] > 0;
    if (!seen && !is_flat(polytope)) continue;
    const RawVec gap = gap_to_edge(polytope, edge, point);
    const UInt128 square = sum_of_squares(gap);
    if (best.edge < 0 || square < best.square) best = {edge, gap, square};
  }
  return best;
}

NearestPoint on_face(const Polytope& polytope, int face, Fine height, const RawVec& point,
                     bool inside) {
  const RawVec gap = along(polytope.faces[static_cast<std::size_t>(face)].normal, height);
  return {true, inside, face, point - gap, gap, height};
}

/// The highest of equals and nearly equals that the point is beside, or −1: the faces of one plane
/// differ by rounding only.
int face_beside(const Polytope& polytope, const Heights& heights, Fine highest,
                const RawVec& point) {
  for (std::size_t i = 0; i < polytope.faces.size(); ++i) {
    const int face = static_cast<int>(i);
    if (heights[i] >= highest - k_agreement && is_beside(polytope, face, point)) return face;
  }
  return -1;
}

}  // namespace

Fine height_above(const PolytopeFace& face, const SplitVec& point) {
  return dot(point, face.normal) - face.offset;
}

bool is_beside(const Polytope& polytope, int face, const RawVec& point) {
  const PolytopeFace& f = polytope.faces[static_cast<std::size_t>(face)];
  LKS_ASSERT(face >= 0 && f.edge_count >= 3);
  const RawVec n = raws_of(f.normal);
  for (int i = 0; i < f.edge_count; ++i) {
    const int edge = f.first_edge + i;
    const RawVec outward = cross_narrow(raws_of(edge_vector(polytope, edge)), n);
    const RawVec way = point - fine(start_of(polytope, edge));
    const Int128 beyond = multiply_wide(outward.x, way.x) + multiply_wide(outward.y, way.y) +
                          multiply_wide(outward.z, way.z);
    if (!beyond.negative() && beyond != Int128{}) return false;
  }
  return true;
}

NearestPoint nearest_point(const Polytope& polytope, const RawVec& point, Fine limit) {
  LKS_ASSERT(!polytope.faces.empty());
  const SplitVec position = split(point);
  Heights heights;
  std::size_t highest = 0;
  Fine height = std::numeric_limits<Fine>::min();
  for (std::size_t i = 0; i < polytope.faces.size(); ++i) {
    heights[i] = height_above(polytope.faces[i], position);
    if (heights[i] > limit) return {};
    if (heights[i] <= height) continue;
    height = heights[i];
    highest = i;
  }
  if (height <= 0 && !is_flat(polytope))
    return on_face(polytope, static_cast<int>(highest), height, point, true);
  const int face = face_beside(polytope, heights, height, point);
  if (face >= 0)
    return on_face(polytope, face, heights[static_cast<std::size_t>(face)], point, false);
  const EdgeChoice edge = nearest_edge(polytope, heights, point);
  if (edge.edge < 0)  // only rounding hides the edges of a face that the point is not beside
    return on_face(polytope, static_cast<int>(highest), height, point, true);
  const auto distance = static_cast<Fine>(norm(edge.gap.x, edge.gap.y, edge.gap.z));
  LKS_ASSERT(distance >= 0);
  if (distance > limit) return {};
  return {true, false, -1, point - edge.gap, edge.gap, distance};
}

}  // namespace lockstone::geometry
