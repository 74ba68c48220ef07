#include "core/geometry/box_face.h"

#include <bit>
#include <utility>

#include "core/geometry/contact_point.h"
#include "core/geometry/cut.h"
#include "core/geometry/normals.h"
#include "core/geometry/preference.h"

namespace lockstone::geometry {
namespace {

/// A polygon vertex with the label of the edge that leaves it: 0 … 3 of the incident face,
/// 4 … 7 the sides +x, −x, +y, −y of the reference face.
struct ClipVertex {
  // No initialisers: a polygon holds eight, and mostly uses four.
  std::array<Fine, 3> at;
  std::uint32_t edge;
};

struct ClipPolygon {
  std::array<ClipVertex, 8> vertices;
  int count;

  void add(const ClipVertex& v) {
    LKS_ASSERT(count < 8);
    vertices[static_cast<std::size_t>(count++)] = v;
  }
  [[nodiscard]] const ClipVertex& operator[](int i) const {
    return vertices[static_cast<std::size_t>(i)];
  }
};

/// One side of the reference face: sign · at[axis] ≤ half.
struct Side {
  std::size_t axis = 0;
  int sign = 1;
  Fine half = 0;
  std::uint32_t label = 0;

  [[nodiscard]] Fine excess(const ClipVertex& v) const {
    return raw::subtract(sign * v.at[axis], half);
  }
};

/// The incident face: its axis, the sign of its outward normal, and the tangent axes.
struct IncidentFace {
  int axis = 0;
  int sign = 1;
  std::array<std::int64_t, 3> normal{};  ///< in the frame of the face, 30 fraction bits

  [[nodiscard]] std::uint32_t index() const {
    return static_cast<std::uint32_t>(axis * 2 + (sign < 0 ? 1 : 0));
  }
};

int tangent_x(const FaceFrame& frame) {
  return (frame.face.axis + 1) % 3;
}
int tangent_y(const FaceFrame& frame) {
  return (frame.face.axis + 2) % 3;
}

std::array<std::int64_t, 3> in_frame(const FaceFrame& frame, const RawVec& v) {
  return {v[tangent_x(frame)], v[tangent_y(frame)], frame.face.sign * v[frame.face.axis]};
}

RawVec lanes_of(const Vec3<Unit>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

/// The face most opposed to the reference normal, the first of equals.
IncidentFace incident_face(const FaceFrame& frame) {
  IncidentFace result;
  std::int64_t most = -1;
  for (int j = 0; j < 3; ++j) {
    const std::int64_t lean =
        frame.face.sign * frame.axes[static_cast<std::size_t>(j)][frame.face.axis].raw;
    if (magnitude_of(lean) <= most) continue;
    most = magnitude_of(lean);
    result.axis = j;
    result.sign = lean > 0 ? -1 : 1;
  }
  const RawVec n = lanes_of(frame.axes[static_cast<std::size_t>(result.axis)]);
  result.normal = in_frame(frame, result.sign < 0 ? -n : n);
  return result;
}

/// Half an edge of the incident box along one of its axes, in the frame.
RawVec half_edge(const FaceFrame& frame, int axis) {
  const std::array<std::int64_t, 3> edge =
      in_frame(frame, along(frame.axes[static_cast<std::size_t>(axis)], frame.incident_half[axis]));
  return {edge[0], edge[1], edge[2]};
}

void incident_polygon(const FaceFrame& frame, const IncidentFace& face, ClipPolygon& polygon) {
  const std::array<std::int64_t, 3> centre = in_frame(frame, frame.centre);
  const auto half = fine(frame.reference.shape.size[frame.face.axis]);
  const RawVec above{centre[0], centre[1], raw::subtract(centre[2], half)};
  const RawVec out = half_edge(frame, face.axis);
  const RawVec u = half_edge(frame, (face.axis + 1) % 3);
  const RawVec v = half_edge(frame, (face.axis + 2) % 3);
  const RawVec middle = face.sign < 0 ? above - out : above + out;
  const RawVec corners[4] = {middle + u + v, middle - u + v, middle - u - v, middle + u - v};
  polygon.count = 0;
  for (std::uint32_t i = 0; i < 4; ++i)
    polygon.add({{corners[i].x, corners[i].y, corners[i].z}, i});
}

/// Whether vertices may be moved onto the side: not on a steep face, where the height would change
/// too much.
bool may_snap(const Side& side, const IncidentFace& face) {
  return 16 * magnitude_of(face.normal[side.axis]) <= magnitude_of(face.normal[2]);
}

/// Moves a vertex that is just outside onto the side, within the plane of the incident face.
void snap(ClipVertex& vertex, Fine excess, const Side& side, const IncidentFace& face) {
  // n·p stays: the height changes by excess · n_axis / n_z. Both factors fit 31 bits after the
  // shift by 8, and |n_z| > 1/2.
  vertex.at[side.axis] -= side.sign * excess;
  const std::int64_t rise = (excess >> 8) * (side.sign * face.normal[side.axis]);
  vertex.at[2] += rise / (face.normal[2] >> 8);
}

/// The point of the side between a vertex inside and one outside, measured from the inside one,
/// so that the order of the two does not matter.
ClipVertex intersection(const ClipVertex& inside, Fine inside_excess, const ClipVertex& outside,
                        Fine outside_excess, const Side& side) {
  const std::uint64_t share = share_inside(-inside_excess, outside_excess);
  ClipVertex result;
  for (std::size_t k = 0; k < 3; ++k)
    result.at[k] = cut_between(inside.at[k], outside.at[k], share);
  result.at[side.axis] = side.sign * side.half;
  return result;
}

/// How far the vertices of a polygon lie beyond a side, and which are beyond it by so little that
/// they may be moved onto it: a bit each.
struct Excesses {
  std::array<Fine, 8> of;
  Fine least;
  std::uint32_t beyond = 0;
  std::uint32_t near = 0;

  Excesses(const ClipPolygon& polygon, const Side& side) {
    least = side.excess(polygon[0]);
    for (int i = 0; i < polygon.count; ++i) {
      const Fine excess = side.excess(polygon[i]);
      of[static_cast<std::size_t>(i)] = excess;
      least = std::min(least, excess);
      const std::uint32_t is_beyond = excess > 0 ? 1U : 0U;
      beyond |= is_beyond << i;
      near |= (excess <= k_snap ? is_beyond : 0U) << i;
    }
  }
  [[nodiscard]] Fine operator[](int i) const { return of[static_cast<std::size_t>(i)]; }
};

/// The part of the polygon within a side that some of its vertices lie beyond.
void cut(const ClipPolygon& polygon, const Excesses& excesses, const Side& side,
         ClipPolygon& result) {
  result.count = 0;
  for (int i = 0; i < polygon.count; ++i) {
    const int next = i + 1 < polygon.count ? i + 1 : 0;
    const ClipVertex& from = polygon[i];
    const ClipVertex& to = polygon[next];
    const Fine from_excess = excesses[i];
    const Fine to_excess = excesses[next];
    if (from_excess <= 0) result.add(from);
    if (from_excess <= 0 && to_excess > 0 && from_excess != 0) {
      result.add(intersection(from, from_excess, to, to_excess, side));
    }
    if (from_excess <= 0 && to_excess > 0) {
      result.vertices[static_cast<std::size_t>(result.count - 1)].edge = side.label;
    }
    if (from_excess > 0 && to_excess < 0) {
      result.add(intersection(to, to_excess, from, from_excess, side));
      result.vertices[static_cast<std::size_t>(result.count - 1)].edge = from.edge;
    }
  }
}

/// A polygon being clipped, and room for its next form.
struct Clipping {
  const IncidentFace& face;
  ClipPolygon buffers[2];
  ClipPolygon* polygon = &buffers[0];
  ClipPolygon* spare = &buffers[1];

  explicit Clipping(const IncidentFace& incident) : face(incident) {}
  Clipping(const Clipping&) = delete;
  Clipping& operator=(const Clipping&) = delete;

  /// Snaps the vertices of a polygon that reaches inside; one wholly outside stays outside. Then
  /// cuts off what is beyond the side.
  void clip(const Side& side) {
    if (polygon->count == 0) return;
    Excesses excesses(*polygon, side);
    if (excesses.least < 0 && may_snap(side, face)) {
      for (std::uint32_t left = excesses.near; left != 0; left &= left - 1) {
        const auto i = static_cast<std::size_t>(std::countr_zero(left));
        snap(polygon->vertices[i], excesses.of[i], side, face);
        excesses.of[i] = 0;
      }
      excesses.beyond &= ~excesses.near;
    }
    if (excesses.beyond == 0) return;
    cut(*polygon, excesses, side, *spare);
    std::swap(polygon, spare);
  }

  /// Both sides across one axis; one that no vertex is beyond has nothing to do. The first cut
  /// leaves the other end as it is, or nothing.
  void clip_across(std::size_t axis, Fine half, std::uint32_t label) {
    Fine least = 0, most = 0;
    for (int i = 0; i < polygon->count; ++i) {
      least = std::min(least, (*polygon)[i].at[axis]);
      most = std::max(most, (*polygon)[i].at[axis]);
    }
    if (most > half) clip({axis, 1, half, label});
    if (least < -half) clip({axis, -1, half, label + 1});
  }
};

/// Names the vertex by the incident face and the polygon edges that meet in it.
std::uint32_t feature_of(const FaceFrame& frame, const IncidentFace& face, std::uint32_t edge_in,
                         std::uint32_t edge_out) {
  const auto reference =
      static_cast<std::uint32_t>(frame.face.axis * 2 + (frame.face.sign < 0 ? 1 : 0));
  return frame.feature_bits | reference << 9 | face.index() << 6 | edge_in << 3 | edge_out;
}

}  // namespace

FaceFrame frame_on_a(const BoxPair& pair, const FaceAxis& face) {
  return {pair.a,           pair.offset, pair.margin,       face,
          pair.centre_in_a, pair.b_in_a, pair.b.shape.size, 1U << 13};
}

FaceFrame frame_on_b(const BoxPair& pair, const FaceAxis& face, const Vec3<Length>& back) {
  FaceFrame frame{pair.b,
                  back,
                  pair.margin,
                  {face.axis, -face.sign, face.separation},
                  -pair.centre_in_b,
                  {},
                  pair.a.shape.size,
                  1U << 13 | 1U << 12};
  for (int i = 0; i < 3; ++i) {
    frame.axes[static_cast<std::size_t>(i)] = {pair.b_in_a[0][i], pair.b_in_a[1][i],
                                               pair.b_in_a[2][i]};
  }
  return frame;
}

FacePolygon clip_incident_face(const FaceFrame& frame) {
  const IncidentFace face = incident_face(frame);
  Clipping clipping(face);
  incident_polygon(frame, face, *clipping.polygon);
  clipping.clip_across(0, fine(frame.reference.shape.size[tangent_x(frame)]), 4);
  clipping.clip_across(1, fine(frame.reference.shape.size[tangent_y(frame)]), 6);
  const ClipPolygon& polygon = *clipping.polygon;
  FacePolygon result;
  result.count = polygon.count;
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& v = polygon[i];
    const std::uint32_t edge_in = polygon[i > 0 ? i - 1 : polygon.count - 1].edge;
    result.vertices[static_cast<std::size_t>(i)] = {v.at[0], v.at[1], v.at[2],
                                                    feature_of(frame, face, edge_in, v.edge)};
  }
  return result;
}

Manifold face_manifold(const FaceFrame& frame) {
  FacePolygon polygon = clip_incident_face(frame);
  polygon.count = drop_far_vertices(polygon.used(), frame.margin);
  polygon.count = reduce_to_four(polygon.used(), k_fine_per_length);
  Manifold manifold;
  if (polygon.count == 0) return manifold;
  const Mat3& rotation = frame.reference.rotation;
  const Vec3<Unit>& across_x = rotation.column(tangent_x(frame));
  const Vec3<Unit>& across_y = rotation.column(tangent_y(frame));
  const Vec3<Unit> up = signed_axis(rotation.column(frame.face.axis), frame.face.sign);
  const Fine half = fine(frame.reference.shape.size[frame.face.axis]);
  const RawVec to_face = along(up, half);
  manifold.normal = unit_axis(up);
  for (int i = 0; i < polygon.count; ++i) {
    const FaceVertex& v = polygon.vertices[static_cast<std::size_t>(i)];
    const RawVec beside = along(across_x, v.x) + along(across_y, v.y);
    const Witnesses witnesses{beside + to_face, beside + along(up, half + v.z)};
    add_point(manifold, witnesses, frame.offset, v.z, frame.margin, v.feature);
  }
  return manifold;
}

}  // namespace lockstone::geometry
