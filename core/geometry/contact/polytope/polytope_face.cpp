#include "core/geometry/contact/polytope/polytope_face.h"

#include <algorithm>
#include <array>
#include <bit>
#include <span>

#include <lockstone/assert.h>

#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/manifold/manifold_reduction.h"
#include "core/geometry/contact/polytope/face_reach.h"
#include "core/geometry/contact/polytope/polytope_edges.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/clip_edge.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// Labels of polygon edges: the incident face's half edges, and from here on the reference face's.
constexpr std::uint32_t k_reference_label = 1024;
constexpr int k_label_bits = 11;
static_assert(k_max_polytope_edges < static_cast<int>(k_reference_label));

/// The four sides of the reference face's bounds.
constexpr std::uint32_t k_bounds_label = (1U << k_label_bits) - 4;
static_assert(k_reference_label + k_max_polytope_edges <= k_bounds_label);

/// Each side adds at most one vertex to a convex polygon; rounding may cost a few more.
constexpr int k_capacity = 2 * k_max_polytope_face_edges + 16;
static_assert(k_capacity <= k_most_reduced);

/// How far snapping moved a vertex along the face, 2^-42 m.
struct Shift {
  std::int32_t x;
  std::int32_t y;
};
constexpr int k_fine_per_shift = 8;

/// A point on the lattice, below 2^29.
struct LatticePoint {
  std::int32_t x;
  std::int32_t y;
};

struct IncidentVertex {
  Fine x;
  Fine y;
  Fine z;
  LatticePoint flat;   ///< x and y on the lattice
  std::uint32_t edge;  ///< label of the edge that leaves it
  Shift moved;
};

/// Room for more vertices than most polygons have: it begins uninitialised.
struct IncidentPolygon {
  std::array<IncidentVertex, k_capacity> vertices;
  int count;

  void add(const IncidentVertex& v) {
    if (count < k_capacity) vertices[static_cast<std::size_t>(count++)] = v;
  }
  [[nodiscard]] IncidentVertex& operator[](int i) { return vertices[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const IncidentVertex& operator[](int i) const {
    return vertices[static_cast<std::size_t>(i)];
  }
};

/// The reference face's axes: u along its first edge as seen from above, v = n × u. Heights are
/// from its plane.
struct ReferenceFrame {
  const PolytopeFaceMeeting& meeting;
  const PolytopeFace& face;
  Vec3<Unit> u;
  Vec3<Unit> v;
  Vec3<Unit> n_other;  ///< n, u, v in the other's frame
  Vec3<Unit> u_other;
  Vec3<Unit> v_other;
  Vec3<Length> corner;  ///< the face's first vertex: x = y = 0
  Fine x_origin = 0;    ///< of the other's origin
  Fine y_origin = 0;
  Fine z_origin = 0;
  RawVec incident_normal;  ///< along u, v, n; 30 fraction bits
  int shift = 0;           ///< from fine to the lattice

  [[nodiscard]] std::int64_t lattice(Fine x) const { return raw::round_shift(x, shift); }
  [[nodiscard]] LatticePoint flat(Fine x, Fine y) const {
    return {static_cast<std::int32_t>(lattice(x)), static_cast<std::int32_t>(lattice(y))};
  }
};

/// Square to the face's normal and to its first edge. Edges of merged faces may lean on the normal:
/// one that leans by more than 60° is passed over.
Vec3<Unit> inward_axis(const Polytope& own, const PolytopeFace& face) {
  LKS_ASSERT(face.edge_count >= 3);
  RawVec inward;
  for (int i = 0; i < face.edge_count; ++i) {
    const RawVec edge = raws_of(edge_vector(own, face.first_edge + i));
    inward = cross_narrow(raws_of(face.normal), edge);
    const std::uint64_t width = norm(inward.x, inward.y, inward.z) >> Unit::frac_bits;
    if (2 * width + 1 >= norm(edge.x, edge.y, edge.z)) break;
  }
  return direction_of(inward.x, inward.y, inward.z);
}

ReferenceFrame make_frame(const PolytopeFaceMeeting& meeting, int incident) {
  const PolytopeView& view = meeting.view;
  const PolytopeFace& face = view.own.faces[static_cast<std::size_t>(meeting.face.face)];
  const Vec3<Unit> v = inward_axis(view.own, face);
  const Vec3<Unit> u = rounded<Unit>(cross(v, face.normal));
  LKS_ASSERT(is_unit(u) && is_unit(v));
  ReferenceFrame frame{meeting,
                       face,
                       u,
                       v,
                       view.to_other(face.normal),
                       view.to_other(u),
                       view.to_other(v),
                       start_of(view.own, face.first_edge),
                       0,
                       0,
                       0,
                       {},
                       0};
  frame.x_origin = dot(view.origin, u) - lockstone::dot(frame.corner, u).raw;
  frame.y_origin = dot(view.origin, v) - lockstone::dot(frame.corner, v).raw;
  frame.z_origin = dot(view.origin, face.normal) - face.offset;
  const Vec3<Unit>& m = view.other.faces[static_cast<std::size_t>(incident)].normal;
  const auto lean = [&m](const Vec3<Unit>& axis) {
    return raw::round_shift(lockstone::dot(m, axis).raw, Unit::frac_bits);
  };
  frame.incident_normal = {lean(frame.u_other), lean(frame.v_other), lean(frame.n_other)};
  return frame;
}

/// A side of the reference face on the lattice, counter-clockwise.
struct Side {
  std::int64_t x = 0;
  std::int64_t y = 0;
  std::int64_t dx = 0;
  std::int64_t dy = 0;
  std::uint32_t label = 0;

  /// Twice the area spanned with the side: positive outside. Below 2^61.
  [[nodiscard]] std::int64_t excess(std::int64_t px, std::int64_t py) const {
    return dy * (px - x) - dx * (py - y);
  }
};

struct FlatPoint {
  Fine x;
  Fine y;
};

using Outline = std::array<FlatPoint, k_max_polytope_face_edges>;

void reference_outline(const ReferenceFrame& frame, Outline& outline) {
  const Polytope& own = frame.meeting.view.own;
  for (int i = 0; i < frame.face.edge_count; ++i) {
    const Vec3<Length> p = start_of(own, frame.face.first_edge + i) - frame.corner;
    outline[static_cast<std::size_t>(i)] = {lockstone::dot(p, frame.u).raw,
                                            lockstone::dot(p, frame.v).raw};
  }
}

void incident_polygon(const ReferenceFrame& frame, int incident, IncidentPolygon& polygon) {
  const Polytope& other = frame.meeting.view.other;
  const PolytopeFace& face = other.faces[static_cast<std::size_t>(incident)];
  polygon.count = 0;
  LKS_ASSERT(face.edge_count >= 3 && face.edge_count <= k_capacity);
  for (int i = 0; i < face.edge_count; ++i) {
    const int edge = face.first_edge + i;
    const Vec3<Length>& p = start_of(other, edge);
    polygon.add({frame.x_origin + lockstone::dot(p, frame.u_other).raw,
                 frame.y_origin + lockstone::dot(p, frame.v_other).raw,
                 frame.z_origin + lockstone::dot(p, frame.n_other).raw,
                 {},
                 static_cast<std::uint32_t>(edge),
                 {}});
  }
}

/// Lattice lanes fit 29 bits, so that differences fit 30.
int lattice_shift_of(const ReferenceFrame& frame, const Outline& outline,
                     const IncidentPolygon& polygon) {
  std::uint64_t size = 0;
  for (int i = 0; i < frame.face.edge_count; ++i) {
    const FlatPoint& p = outline[static_cast<std::size_t>(i)];
    size |= static_cast<std::uint64_t>(magnitude_of(p.x) | magnitude_of(p.y));
  }
  for (int i = 0; i < polygon.count; ++i)
    size |= static_cast<std::uint64_t>(magnitude_of(polygon[i].x) | magnitude_of(polygon[i].y));
  return std::max(0, static_cast<int>(std::bit_width(size)) - 29);
}

void place_on_lattice(const ReferenceFrame& frame, IncidentPolygon& polygon) {
  for (int i = 0; i < polygon.count; ++i)
    polygon[i].flat = frame.flat(polygon[i].x, polygon[i].y);
}

/// Of points on the lattice.
struct LatticeBounds {
  static constexpr std::int64_t k_far = std::int64_t{1} << 30;

  std::int64_t left = k_far;
  std::int64_t right = -k_far;
  std::int64_t low = left;
  std::int64_t high = right;

  void add(std::int64_t x, std::int64_t y) {
    left = std::min(left, x);
    right = std::max(right, x);
    low = std::min(low, y);
    high = std::max(high, y);
  }
  /// Whether the corner that is farthest out is outside the side; else no point is.
  [[nodiscard]] bool reach_outside(const Side& side) const {
    return side.excess(side.dy > 0 ? right : left, side.dx > 0 ? low : high) > 0;
  }
};

LatticeBounds bounds_of(const IncidentPolygon& polygon) {
  LatticeBounds bounds;
  for (int i = 0; i < polygon.count; ++i)
    bounds.add(polygon[i].flat.x, polygon[i].flat.y);
  return bounds;
}

Side side_between(const ReferenceFrame& frame, const FlatPoint& from, const FlatPoint& to,
                  int edge) {
  const std::int64_t x = frame.lattice(from.x);
  const std::int64_t y = frame.lattice(from.y);
  return {x, y, frame.lattice(to.x) - x, frame.lattice(to.y) - y,
          k_reference_label + static_cast<std::uint32_t>(edge)};
}

/// Whether the incident face is flat enough on the reference to move its vertices.
bool may_snap(const ReferenceFrame& frame) {
  const std::int64_t limit = magnitude_of(frame.incident_normal.z) / 16;
  return magnitude_of(frame.incident_normal.x) <= limit &&
         magnitude_of(frame.incident_normal.y) <= limit;
}

/// Adds a snap by x and y to a shift, and returns whether that is allowed: two square sides may
/// both move a vertex, but the many of a rounded outline no farther than two such.
bool add_shift(Shift& moved, Fine x, Fine y) {
  constexpr std::int64_t limit = k_snap >> k_fine_per_shift;
  const std::int64_t sum_x = moved.x - raw::round_shift(x, k_fine_per_shift);
  const std::int64_t sum_y = moved.y - raw::round_shift(y, k_fine_per_shift);
  if (sum_x * sum_x + sum_y * sum_y > 2 * limit * limit) return false;
  moved = {static_cast<std::int32_t>(sum_x), static_cast<std::int32_t>(sum_y)};
  return true;
}

/// Moves a vertex that is just outside onto the side, within the plane of the incident face.
/// Returns whether it did.
bool snap(const ReferenceFrame& frame, const Side& side, std::int64_t excess,
          IncidentVertex& vertex) {
  LKS_ASSERT(excess > 0);
  const Fine rough = magnitude_of(side.dx) + magnitude_of(side.dy);
  const Fine reach = k_snap >> frame.shift;
  if (excess > reach * rough) return false;
  const auto square = static_cast<std::uint64_t>(side.dx * side.dx + side.dy * side.dy);
  const auto length = static_cast<std::int64_t>(isqrt_rounded(square));
  LKS_ASSERT(length > 0);
  const std::int64_t distance = excess / length;
  if (distance >= reach) return false;
  const Fine way = distance << frame.shift;  // at most 2^35
  const Fine x = raw::round_divide((way >> 4) * side.dy, length) * 16;
  const Fine y = raw::round_divide((way >> 4) * -side.dx, length) * 16;
  if (!add_shift(vertex.moved, x, y)) return false;
  vertex.x -= x;
  vertex.y -= y;
  const RawVec& m = frame.incident_normal;
  vertex.z += ((x >> 8) * m.x + (y >> 8) * m.y) / (m.z >> 8);
  vertex.flat = frame.flat(vertex.x, vertex.y);
  return true;
}

using Excesses = std::array<std::int64_t, k_capacity>;

/// Signed distances to the side times its length. Returns whether any is outside.
bool is_outside(const Side& side, const IncidentPolygon& polygon, Excesses& excesses) {
  bool outside = false;
  for (int i = 0; i < polygon.count; ++i) {
    const std::int64_t excess = side.excess(polygon[i].flat.x, polygon[i].flat.y);
    excesses[static_cast<std::size_t>(i)] = excess;
    outside = outside || excess > 0;
  }
  return outside;
}

/// Likewise; vertices just outside a polygon that reaches inside are snapped and count as on the
/// side.
bool measure(const ReferenceFrame& frame, const Side& side, IncidentPolygon& polygon,
             Excesses& excesses) {
  LKS_ASSERT(polygon.count > 0);
  if (!is_outside(side, polygon, excesses)) return false;
  const auto measured = std::span(excesses).first(static_cast<std::size_t>(polygon.count));
  const bool inside = std::ranges::any_of(measured, [](std::int64_t e) { return e < 0; });
  if (!inside || !may_snap(frame)) return true;
  for (int i = 0; i < polygon.count; ++i) {
    std::int64_t& excess = excesses[static_cast<std::size_t>(i)];
    if (excess > 0 && snap(frame, side, excess, polygon[i])) excess = 0;
  }
  return true;
}

IncidentVertex cut(const ReferenceFrame& frame, const IncidentVertex& inside, std::int64_t depth,
                   const IncidentVertex& outside, std::int64_t excess, std::uint32_t label) {
  LKS_ASSERT(depth > 0 && excess > 0);
  const std::uint64_t share = share_inside(depth, excess);
  const auto lane = [share](std::int32_t a, std::int32_t b) {
    return static_cast<std::int32_t>(cut_between(a, b, share));
  };
  const Fine x = cut_between(inside.x, outside.x, share);
  const Fine y = cut_between(inside.y, outside.y, share);
  return {x,
          y,
          cut_between(inside.z, outside.z, share),
          frame.flat(x, y),
          label,
          {lane(inside.moved.x, outside.moved.x), lane(inside.moved.y, outside.moved.y)}};
}

void clip(const ReferenceFrame& frame, const Side& side, const IncidentPolygon& polygon,
          const Excesses& excesses, IncidentPolygon& result) {
  result.count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const int next = i + 1 < polygon.count ? i + 1 : 0;
    const IncidentVertex& from = polygon[i];
    const IncidentVertex& to = polygon[next];
    const std::int64_t from_excess = excesses[static_cast<std::size_t>(i)];
    const std::int64_t to_excess = excesses[static_cast<std::size_t>(next)];
    if (from_excess <= 0) {
      const bool leaves_on_side = from_excess == 0 && to_excess > 0;
      result.add(
          {from.x, from.y, from.z, from.flat, leaves_on_side ? side.label : from.edge, from.moved});
      if (from_excess < 0 && to_excess > 0)
        result.add(cut(frame, from, -from_excess, to, to_excess, side.label));
    } else if (to_excess < 0) {
      result.add(cut(frame, to, -to_excess, from, from_excess, from.edge));
    }
  }
}

/// The sides of the outline's bounds and a few steps around them, which vertices moved onto a side
/// may be off by. Counter-clockwise from the lowest y.
std::array<Side, 4> sides_around(const ReferenceFrame& frame, const Outline& outline) {
  LatticeBounds bounds;
  for (int i = 0; i < frame.face.edge_count; ++i) {
    const FlatPoint& p = outline[static_cast<std::size_t>(i)];
    bounds.add(frame.lattice(p.x), frame.lattice(p.y));
  }
  const auto& [left, right, low, high] = bounds;
  LKS_ASSERT(left <= right && low <= high && left > -LatticeBounds::k_far &&
             right < LatticeBounds::k_far);
  constexpr std::int64_t around = 4;
  constexpr std::uint32_t label = k_bounds_label;
  return {{{left, low - around, 1, 0, label},
           {right + around, low, 0, 1, label + 1},
           {right, high + around, -1, 0, label + 2},
           {left - around, high, 0, -1, label + 3}}};
}

/// The incident face within the sides of the reference face, in one of the two polygons. Where two
/// sides meet at a sharp angle, a point within a step of both may be far beyond their corner, but
/// not beyond the bounds.
const IncidentPolygon& clip_to_sides(const ReferenceFrame& frame, const Outline& outline,
                                     IncidentPolygon& polygon, IncidentPolygon& spare) {
  LKS_ASSERT(frame.shift >= 0);
  Excesses excesses;
  IncidentPolygon* from = &polygon;
  IncidentPolygon* to = &spare;
  LatticeBounds bounds = bounds_of(polygon);
  for (int i = 0; i < frame.face.edge_count && from->count > 0; ++i) {
    const int next = i + 1 < frame.face.edge_count ? i + 1 : 0;
    const Side side =
        side_between(frame, outline[static_cast<std::size_t>(i)],
                     outline[static_cast<std::size_t>(next)], frame.face.first_edge + i);
    if (side.dx == 0 && side.dy == 0) continue;  // shorter than the lattice resolves
    if (!bounds.reach_outside(side) || !measure(frame, side, *from, excesses)) continue;
    clip(frame, side, *from, excesses, *to);
    std::swap(from, to);
    bounds = bounds_of(*from);
  }
  for (const Side& side : sides_around(frame, outline)) {
    if (!bounds.reach_outside(side) || !is_outside(side, *from, excesses)) continue;
    clip(frame, side, *from, excesses, *to);
    std::swap(from, to);
    bounds = bounds_of(*from);
  }
  return *from;
}

std::uint32_t feature_of(const ReferenceFrame& frame, std::uint32_t edge_in,
                         std::uint32_t edge_out) {
  const std::uint32_t side = frame.meeting.own_is_b ? k_hull_of_b : 0;
  return k_hull_face_bits | side | edge_in << k_label_bits | edge_out;
}

void add_face_point(Manifold& manifold, const ReferenceFrame& frame, const FaceVertex& v) {
  LKS_ASSERT(manifold.count < k_max_manifold_points);
  const PolytopeFaceMeeting& meeting = frame.meeting;
  const Vec3<Unit>& n = frame.face.normal;
  const Fine lift = frame.face.offset - lockstone::dot(frame.corner, n).raw;
  const RawVec on_own =
      fine(frame.corner) + along(frame.u, v.x) + along(frame.v, v.y) + along(n, lift);
  const Mat3& rotation = meeting.view.rotation;
  const Witnesses witnesses{rotate(rotation, on_own), rotate(rotation, on_own + along(n, v.z))};
  add_point(manifold, witnesses, meeting.offset, v.z, meeting.margin, v.feature);
}

Manifold manifold_of(const ReferenceFrame& frame, const IncidentPolygon& polygon) {
  std::array<FaceVertex, k_capacity> vertices;
  int count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const IncidentVertex& v = polygon[i];
    const std::uint32_t edge_in = polygon[i > 0 ? i - 1 : polygon.count - 1].edge;
    vertices[static_cast<std::size_t>(count++)] = {v.x, v.y, v.z,
                                                   feature_of(frame, edge_in, v.edge)};
  }
  const auto used = [&] { return std::span(vertices).first(static_cast<std::size_t>(count)); };
  count = drop_far_vertices(used(), frame.meeting.margin);
  count = reduce_to_four(used(), frame.shift, frame.meeting.held);
  Manifold manifold;
  if (count == 0) return manifold;
  manifold.normal = unit_axis(lockstone::rotate(frame.meeting.view.rotation, frame.face.normal));
  for (const FaceVertex& v : used())
    add_face_point(manifold, frame, v);
  LKS_ASSERT(is_manifold(manifold));
  return manifold;
}

}  // namespace

Manifold face_manifold(const PolytopeFaceMeeting& meeting, Fine highest) {
  LKS_ASSERT(meeting.face.face >= 0 && meeting.face.support >= 0);
  const PolytopeView& view = meeting.view;
  const PolytopeFace& face = view.own.faces[static_cast<std::size_t>(meeting.face.face)];
  const int incident =
      most_opposed_face(view.other, meeting.face.support, view.to_other(face.normal));
  if (highest < k_any_separation && !may_come_down(meeting, incident, highest)) return {};
  ReferenceFrame frame = make_frame(meeting, incident);
  Outline outline;
  IncidentPolygon polygon;
  IncidentPolygon spare;
  reference_outline(frame, outline);
  incident_polygon(frame, incident, polygon);
  frame.shift = lattice_shift_of(frame, outline, polygon);
  place_on_lattice(frame, polygon);
  return manifold_of(frame, clip_to_sides(frame, outline, polygon, spare));
}

Manifold support_manifold(const PolytopeFaceMeeting& meeting) {
  LKS_ASSERT(meeting.face.face >= 0 && meeting.face.support >= 0);
  const PolytopeView& view = meeting.view;
  const PolytopeFace& face = view.own.faces[static_cast<std::size_t>(meeting.face.face)];
  const Vec3<Length>& vertex = view.other.vertices[static_cast<std::size_t>(meeting.face.support)];
  const RawVec tip = view.to_own(vertex);
  const RawVec foot = tip - along(face.normal, meeting.face.separation);
  Manifold manifold;
  manifold.normal = unit_axis(lockstone::rotate(view.rotation, face.normal));
  const std::uint32_t side = meeting.own_is_b ? 0 : k_hull_of_b;
  add_point(manifold, {rotate(view.rotation, foot), rotate(view.rotation, tip)}, meeting.offset,
            meeting.face.separation, meeting.margin,
            k_hull_vertex_bits | side | static_cast<std::uint32_t>(meeting.face.support));
  return manifold;
}

}  // namespace lockstone::geometry
