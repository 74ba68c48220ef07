#include "core/geometry/contact/polytope/polytope_segment.h"

#include <algorithm>
#include <bitset>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/segment.h"
#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr Mat3 k_identity{};

/// The two faces of an edge.
struct FacePair {
  std::size_t left;
  std::size_t right;
};

FacePair faces_of(const Polytope& p, int edge) {
  const HalfEdge& half = p.edges[static_cast<std::size_t>(edge)];
  return {half.face, p.edges[half.twin].face};
}

/// The arc of the edge crosses the great circle square to the segment: +1 or −1, the sign of the
/// crossing along edge × axis; else 0.
int crossing_sign(const SegmentHeights& heights, const FacePair& faces) {
  const std::int64_t left = heights.lean[faces.left];
  const std::int64_t right = heights.lean[faces.right];
  if (left == 0 && right == 0) return 0;
  if ((left > 0 && right > 0) || (left < 0 && right < 0)) return 0;
  return left > 0 || right < 0 ? 1 : -1;
}

/// Whether an end is not above either plane by more than the threshold ≤ 0: then no axis between
/// their normals separates by more (as `best_edge` of two polytopes has it).
bool cannot_beat(const SegmentHeights& heights, const FacePair& faces, Fine threshold) {
  const Fine first = std::max(heights.first[faces.left], heights.first[faces.right]);
  const Fine last = std::max(heights.last[faces.left], heights.last[faces.right]);
  return std::min(first, last) + k_witness_slack <= threshold;
}

/// Whether the edge may be nearest: some end is above one of its planes, and neither plane is
/// farther than the nearest feature so far.
bool may_be_nearest(const SegmentHeights& heights, const FacePair& faces, Fine found) {
  const Fine first = std::max(heights.first[faces.left], heights.first[faces.right]);
  const Fine last = std::max(heights.last[faces.left], heights.last[faces.right]);
  if (std::max(first, last) < -k_agreement) return false;
  return std::max(heights.low[faces.left], heights.low[faces.right]) <= found + k_agreement;
}

/// Half the width of the segment along a unit axis.
Fine reach_along(const PolytopeSegment& segment, const Vec3<Unit>& n) {
  const std::int64_t lean = raw::round_shift(lockstone::dot(n, segment.axis).raw, Unit::frac_bits);
  return magnitude_of(scaled(segment.half, static_cast<std::int32_t>(lean)));
}

void take_nearer(SegmentNearest& best, const SegmentNearest& other) {
  if (!best.found || other.distance < best.distance) best = other;
}

void try_end(const PolytopeSegment& segment, Fine s, Fine limit, SegmentNearest& best) {
  const NearestPoint at = nearest_point(segment.polytope, segment.at(s), limit);
  if (at.found) take_nearer(best, {true, s, at.point, at.gap, at.distance});
}

/// A vertex belongs to several edges, and is tried once.
class VertexSearch {
 public:
  VertexSearch(const Polytope& polytope, const Segment& core, Fine limit)
      : polytope_(polytope), core_(core), limit_(limit) {}

  void try_vertex(std::uint16_t vertex, SegmentNearest& best) {
    if (tried_[vertex]) return;
    tried_.set(vertex);
    const RawVec point = fine(polytope_.vertices[vertex]);
    const Fine s = closest_parameter(core_, point);
    const RawVec gap = point_at(core_, s) - point;
    const auto distance = static_cast<Fine>(norm(gap.x, gap.y, gap.z));
    if (distance <= limit_) take_nearer(best, {true, s, point, gap, distance});
  }

 private:
  const Polytope& polytope_;
  const Segment& core_;
  const Fine limit_;
  std::bitset<k_max_polytope_vertices> tried_;
};

/// Where the edge and the core cross, the gap lies along their product, whose direction is exact
/// however near they are; else an end of the edge is nearest.
void try_edge(const PolytopeSegment& segment, const Segment& core, int edge, int sign, Fine limit,
              VertexSearch& vertices, SegmentNearest& best) {
  LKS_ASSERT(sign == 1 || sign == -1);
  const Polytope& p = segment.polytope;
  const Segment side = edge_segment(p, edge, k_identity, {});
  const ClosestParameters closest = closest_parameters(side, core);
  if (!closest.crossing) {
    const HalfEdge& half = p.edges[static_cast<std::size_t>(edge)];
    vertices.try_vertex(half.origin, best);
    vertices.try_vertex(p.edges[half.twin].origin, best);
    return;
  }
  const RawVec k = cross_narrow(raws_of(edge_vector(p, edge)), raws_of(segment.axis));
  const Vec3<Unit> n = signed_axis(direction_of(k.x, k.y, k.z), sign);
  const RawVec point = point_at(side, closest.on_a);
  const Fine outward = dot(point_at(core, closest.on_b) - point, n);
  if (outward < -k_agreement || outward > limit) return;  // the far side of the polytope, or far
  const Fine distance = std::max(outward, Fine{0});
  LKS_ASSERT(magnitude_of(closest.on_b) <= segment.half);
  take_nearer(best, {true, closest.on_b, point, along(n, distance), distance});
}

/// Signed height of a point over a side plane, times the length of the edge; and its rise along
/// the segment. Exact products of 128 bits.
struct SidePlane {
  Int128 beyond;
  Int128 slope;
};

SidePlane side_plane(const PolytopeSegment& segment, const PolytopeFace& face, int edge) {
  const RawVec n = raws_of(face.normal);
  const RawVec outward = cross_narrow(raws_of(edge_vector(segment.polytope, edge)), n);
  const RawVec way = segment.centre - fine(start_of(segment.polytope, edge));
  const auto product = [&outward](const RawVec& v) {
    return multiply_wide(outward.x, v.x) + multiply_wide(outward.y, v.y) +
           multiply_wide(outward.z, v.z);
  };
  return {product(way), product(raws_of(segment.axis))};
}

/// −beyond / slope as a length: the slope has 30 fraction bits of the axis, `beyond` is fine.
/// Clamped to ±half.
Fine crossing_parameter(const SidePlane& side, Fine half) {
  LKS_ASSERT(half >= 0 && side.slope != Int128{});
  UInt128 size = magnitude(side.beyond);
  UInt128 divisor = magnitude(side.slope);
  // The quotient times 2^30: bring the divisor to 63 bits and the numerator along.
  const int excess = 65 - countl_zero(divisor);
  divisor = excess >= 0 ? divisor >> excess : divisor << -excess;
  const int shift = Unit::frac_bits - excess;
  const bool overflows = shift > 0 && countl_zero(size) <= shift;
  size = shift > 0 ? size << shift : size >> -shift;
  Fine result = half;
  if (!overflows && size.high < divisor.low) {
    const std::uint64_t quotient = round_divide(size, divisor.low);
    if (quotient < static_cast<std::uint64_t>(half)) result = static_cast<Fine>(quotient);
  }
  return side.beyond.negative() == side.slope.negative() ? -result : result;
}

}  // namespace

void measure(const PolytopeSegment& segment, SegmentHeights& heights) {
  LKS_ASSERT(segment.half >= 0 && is_unit(segment.axis));
  const SplitVec first = split(segment.at(-segment.half));
  const SplitVec last = split(segment.at(segment.half));
  for (std::size_t i = 0; i < segment.polytope.faces.size(); ++i) {
    const PolytopeFace& face = segment.polytope.faces[i];
    heights.lean[i] = lockstone::dot(face.normal, segment.axis).raw;
    heights.first[i] = height_above(face, first);
    heights.last[i] = height_above(face, last);
    heights.low[i] = std::min(heights.first[i], heights.last[i]);
  }
}

SegmentFace best_face(const PolytopeSegment& segment, const SegmentHeights& heights) {
  SegmentFace best{-1, 0};
  for (std::size_t i = 0; i < segment.polytope.faces.size(); ++i) {
    if (!segment.backward.allows(-segment.polytope.faces[i].normal)) continue;
    if (best.face >= 0 && heights.low[i] <= best.separation) continue;
    best = {static_cast<int>(i), heights.low[i]};
  }
  return best;
}

SegmentEdge best_edge(const PolytopeSegment& segment, const SegmentHeights& heights,
                      Fine threshold) {
  const Polytope& p = segment.polytope;
  const SplitVec centre = split(segment.centre);
  SegmentEdge best;
  for (int edge = 0; edge < static_cast<int>(p.edges.size()); ++edge) {
    const FacePair faces = faces_of(p, edge);
    if (!is_first_half(p, edge)) continue;
    const int sign = crossing_sign(heights, faces);
    if (sign == 0 || cannot_beat(heights, faces, std::min(threshold, Fine{0}))) continue;
    const RawVec k = cross_narrow(raws_of(edge_vector(p, edge)), raws_of(segment.axis));
    if (k == RawVec{}) continue;
    const Vec3<Unit> normal = signed_axis(direction_of(k.x, k.y, k.z), sign);
    const Fine height = dot(centre, normal) - reach_along(segment, normal);
    if (height - lockstone::dot(start_of(p, edge), normal).raw <= threshold) continue;
    const Fine separation = height - support_of(p, normal).height;
    if (separation <= threshold) continue;
    if (separation <= 0 && !segment.backward.allows(-normal)) continue;
    best = {true, edge, normal, separation};
    threshold = separation;
  }
  LKS_ASSERT(!best.found || (best.separation == threshold && is_unit(best.normal)));
  return best;
}

BesideFace beside_face(const PolytopeSegment& segment, int face) {
  const PolytopeFace& f = segment.polytope.faces[static_cast<std::size_t>(face)];
  LKS_ASSERT(f.edge_count >= 3);
  BesideFace result{-segment.half, segment.half};
  for (int i = 0; i < f.edge_count; ++i) {
    const SidePlane side = side_plane(segment, f, f.first_edge + i);
    const bool outside = !side.beyond.negative() && side.beyond != Int128{};
    if (side.slope == Int128{}) {
      if (outside) return {1, 0};
      continue;
    }
    const Fine s = crossing_parameter(side, segment.half);
    if (side.slope.negative()) {
      result.low = std::max(result.low, s);
    } else {
      result.high = std::min(result.high, s);
    }
  }
  // Clamping hides a segment that is wholly outside a side.
  const bool middle_outside =
      !is_beside(segment.polytope, face,
                 segment.at(result.low + (raw::subtract(result.high, result.low)) / 2));
  if (result.low >= result.high && middle_outside) return {1, 0};
  return result;
}

SegmentNearest nearest_to_segment(const PolytopeSegment& segment, const SegmentHeights& heights,
                                  Fine limit) {
  const Polytope& p = segment.polytope;
  SegmentNearest best;
  try_end(segment, -segment.half, limit, best);
  try_end(segment, segment.half, best.found ? best.distance : limit, best);
  const Length half = Length::from_raw(
      static_cast<std::int32_t>(raw::round_shift(segment.half, k_fine_per_length)));
  const Segment core{segment.centre, segment.axis, half};
  VertexSearch vertices(p, core, limit);
  for (int edge = 0; edge < static_cast<int>(p.edges.size()); ++edge) {
    const FacePair faces = faces_of(p, edge);
    if (!is_first_half(p, edge)) continue;
    const int sign = crossing_sign(heights, faces);
    const Fine found = best.found ? best.distance : limit;
    if (sign != 0 && may_be_nearest(heights, faces, found))
      try_edge(segment, core, edge, sign, limit, vertices, best);
  }
  LKS_ASSERT(!best.found || magnitude_of(best.s) <= segment.half);
  return best;
}

}  // namespace lockstone::geometry
