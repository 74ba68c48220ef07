#include "core/geometry/distance/epa/epa.h"

#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/cores/half_space_gap.h"
#include "core/geometry/distance/epa/difference_frame.h"
#include "core/geometry/distance/epa/expanding_polytope.h"
#include "core/geometry/distance/epa/rim_overlap.h"
#include "core/geometry/distance/epa/taper_overlap.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone {
namespace geometry {
namespace {

Vec3<Unit> unit_along(const RawVec& v) {
  return lockstone::direction_of(v.x, v.y, v.z);
}

/// Cores whose difference is a point, a segment or a polygon that holds the origin.
CoreGap flat_overlap(const GapQuery& query, const DifferenceFrame& frame) {
  const FinePair fine_pair = query.fine_pair();
  CoreGap gap = refine(fine_pair, query.lattice(), query.simplex(), Side::before);
  if (frame.count == 1) gap.normal = k_concentric_normal;
  if (frame.count == 2) gap.normal = perpendicular_to(unit_along(frame.edge(1)));
  if (frame.count == 3) {
    const RawVec plane = narrow_cross(frame.edge(1), frame.edge(2));
    // A triangle that holds the origin has refined it already.
    if (query.simplex().count != 3) gap.normal = unit_along(plane);
  }
  if (dot(fine_pair.offset, gap.normal) < 0) gap.normal = -gap.normal;
  gap.distance = 0;
  return gap;
}

/// `gap` runs from the origin to the nearest face: B leaves A the other way.
CoreGap way_out(const CoreGap& gap) {
  CoreGap result = gap;
  result.normal = -gap.normal;
  return result;
}

/// No face supports the difference yet: the depth of its nearest one, made to separate.
CoreOverlap overlap_without_room(const GapQuery& query, const Simplex& face) {
  const CoreGap gap = refine(query.fine_pair(), query.lattice(), face, Side::before);
  CoreOverlap result{way_out(gap), false};
  const DifferenceVertex farthest = greatest_along(query.lattice(), face.normal);
  const FinePair pair = query.fine_pair();
  const RawVec w = vertex_of(pair.b, farthest.b) + pair.offset - vertex_of(pair.a, farthest.a);
  result.gap.distance = std::max(gap.distance, dot(w, gap.normal));
  return result;
}

/// Of the hull of a finite set, which ends at one of its faces.
CoreOverlap polytope_overlap(const GapQuery& query, ExpandingPolytope& polytope) {
  const LatticePair& lattice = query.lattice();
  const auto gap_of = [&](const ExpandingFace& face) {
    return way_out(refine(query.fine_pair(), lattice, polytope.simplex_of(face), Side::before));
  };
  // A vertex is added in each turn, and is_full ends the loop at the latest.
  for (;;) {
    const ExpandingFace& nearest = polytope.nearest();
    DifferenceVertex vertex = greatest_along(lattice, nearest.normal);
    if (!polytope.sees(vertex.point, nearest)) {
      const ExpandingFace& held = polytope.foot_face(nearest);
      if (&held == &nearest) return {gap_of(nearest), true};
      vertex = greatest_along(lattice, held.normal);
      if (!polytope.sees(vertex.point, held)) return {gap_of(held), true};
      if (polytope.is_full()) return {gap_of(nearest), true};
    }
    if (polytope.is_full()) return overlap_without_room(query, polytope.simplex_of(nearest));
    polytope.expand(vertex);
  }
}

}  // namespace

CoreOverlap core_overlap(GapQuery& query) {
  if (query.is_closed_form()) {
    CoreGap gap = query.gap();
    gap.distance = -gap.distance;
    return {gap, true};
  }
  if (is_tapered(query.a()) || is_tapered(query.b())) return taper_overlap(query);
  const DifferenceFrame frame = frame_of(query);
  if (frame.count < 4) return {flat_overlap(query, frame), true};
  ExpandingPolytope polytope(frame.vertices);
  const bool round = query.a().rims.count != 0 || query.b().rims.count != 0;
  return round ? rim_overlap(query, polytope) : polytope_overlap(query, polytope);
}

namespace {

Penetration penetration_of(const CoreGap& gap, Fine depth, const GapQuery& query) {
  Penetration result;
  result.overlapping = true;
  result.depth = to_position(depth);
  result.normal = gap.normal;
  const Witnesses surface =
      inflate(gap.on_a, query.a().radius, gap.on_b, query.b().radius, gap.normal);
  result.point_a = to_length(surface.on_a);
  result.point_b = to_length(surface.on_b - query.fine_pair().offset);
  return result;
}

Penetration ordered_penetration(const PosedShape& a, const PosedShape& b, const RawVec& offset) {
  GapQuery query(a, b);
  if (query.find(offset)) {
    const Fine depth = query.radii() - query.gap().distance;
    if (depth < 0) return {};
    return penetration_of(query.gap(), depth, query);
  }
  const CoreOverlap overlap = core_overlap(query);
  Penetration result = penetration_of(overlap.gap, overlap.gap.distance + query.radii(), query);
  result.exact = overlap.exact;
  return result;
}

Penetration half_space_penetration(const PosedShape& half_space, const PosedShape& shape,
                                   const RawVec& offset) {
  const HalfSpaceGap gap = half_space_gap(half_space, shape, offset);
  if (gap.distance > 0) return {};
  return {true,
          to_position(-gap.distance),
          gap.normal,
          to_length(gap.on_plane),
          to_length(gap.on_shape),
          true};
}

Penetration exchanged(const Penetration& penetration) {
  Penetration result = penetration;
  result.normal = -penetration.normal;
  std::swap(result.point_a, result.point_b);
  return result;
}

}  // namespace
}  // namespace geometry

Penetration penetration(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset) {
  using namespace geometry;
  const RawVec between = fine(offset);
  if (a.shape.kind == ShapeKind::half_space) return half_space_penetration(a, b, between);
  if (b.shape.kind == ShapeKind::half_space) {
    return exchanged(half_space_penetration(b, a, -between));
  }
  if (!is_exchanged(a, b, between)) return ordered_penetration(a, b, between);
  return exchanged(ordered_penetration(b, a, -between));
}

}  // namespace lockstone
