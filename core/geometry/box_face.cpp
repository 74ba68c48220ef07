#include "core/geometry/box_face.h"

#include "core/geometry/contact_point.h"
#include "core/geometry/cut.h"
#include "core/geometry/normals.h"
#include "core/geometry/preference.h"

namespace lockstone::geometry {
namespace {

/// A polygon vertex with the label of the edge that leaves it: 0 … 3 of the incident face,
/// 4 … 7 the sides +x, −x, +y, −y of the reference face.
struct ClipVertex {
  std::array<Fine, 3> at{};
  std::uint32_t edge = 0;
};

struct ClipPolygon {
  std::array<ClipVertex, 8> vertices{};
  int count = 0;

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

RawVec half_edge(const FaceFrame& frame, int axis) {
  return along(frame.axes[static_cast<std::size_t>(axis)], frame.incident_half[axis]);
}

ClipPolygon incident_polygon(const FaceFrame& frame, const IncidentFace& face) {
  const RawVec out = half_edge(frame, face.axis);
  const RawVec u = half_edge(frame, (face.axis + 1) % 3);
  const RawVec v = half_edge(frame, (face.axis + 2) % 3);
  const RawVec middle = face.sign < 0 ? frame.centre - out : frame.centre + out;
  const RawVec corners[4] = {middle + u + v, middle - u + v, middle - u - v, middle + u - v};
  ClipPolygon polygon;
  const auto half = fine(frame.reference.shape.size[frame.face.axis]);
  for (std::uint32_t i = 0; i < 4; ++i) {
    ClipVertex vertex{in_frame(frame, corners[i]), i};
    vertex.at[2] = raw::subtract(vertex.at[2], half);
    polygon.add(vertex);
  }
  return polygon;
}

/// Moves a vertex that is just outside onto the side, within the plane of the incident face. Not
/// on a steep face, where the height would change too much.
void snap(ClipVertex& vertex, const Side& side, const IncidentFace& face) {
  const Fine excess = side.excess(vertex);
  if (excess <= 0 || excess > k_snap) return;
  if (16 * magnitude_of(face.normal[side.axis]) > magnitude_of(face.normal[2])) return;
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

/// Snaps the vertices of a polygon that reaches inside; one wholly outside stays outside.
void snap_all(ClipPolygon& polygon, const Side& side, const IncidentFace& face) {
  bool reaches_inside = false;
  for (int i = 0; i < polygon.count; ++i) {
    reaches_inside = reaches_inside || side.excess(polygon[i]) < 0;
  }
  if (!reaches_inside) return;
  for (int i = 0; i < polygon.count; ++i) {
    snap(polygon.vertices[static_cast<std::size_t>(i)], side, face);
  }
}

ClipPolygon clip(ClipPolygon polygon, const Side& side, const IncidentFace& face) {
  snap_all(polygon, side, face);
  ClipPolygon result;
  for (int i = 0; i < polygon.count; ++i) {
    const ClipVertex& from = polygon[i];
    const ClipVertex& to = polygon[i + 1 < polygon.count ? i + 1 : 0];
    const Fine from_excess = side.excess(from);
    const Fine to_excess = side.excess(to);
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
  return result;
}

/// Names the vertex by the incident face and the polygon edges that meet in it.
std::uint32_t feature_of(const FaceFrame& frame, const IncidentFace& face, std::uint32_t edge_in,
                         std::uint32_t edge_out) {
  const auto reference =
      static_cast<std::uint32_t>(frame.face.axis * 2 + (frame.face.sign < 0 ? 1 : 0));
  return frame.feature_bits | reference << 9 | face.index() << 6 | edge_in << 3 | edge_out;
}

/// Local coordinates in the reference's axes of a point at this height above its face.
RawVec from_frame(const FaceFrame& frame, const FaceVertex& v, Fine height) {
  RawVec result;
  result[tangent_x(frame)] = v.x;
  result[tangent_y(frame)] = v.y;
  result[frame.face.axis] =
      frame.face.sign * (fine(frame.reference.shape.size[frame.face.axis]) + height);
  return result;
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
  const Fine half_x = fine(frame.reference.shape.size[tangent_x(frame)]);
  const Fine half_y = fine(frame.reference.shape.size[tangent_y(frame)]);
  ClipPolygon polygon = incident_polygon(frame, face);
  for (const Side& side : {Side{0, 1, half_x, 4}, Side{0, -1, half_x, 5}, Side{1, 1, half_y, 6},
                           Side{1, -1, half_y, 7}}) {
    polygon = clip(polygon, side, face);
  }
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
  manifold.normal = unit_axis(signed_axis(rotation.column(frame.face.axis), frame.face.sign));
  for (int i = 0; i < polygon.count; ++i) {
    const FaceVertex& v = polygon.vertices[static_cast<std::size_t>(i)];
    const Witnesses witnesses{rotate(rotation, from_frame(frame, v, 0)),
                              rotate(rotation, from_frame(frame, v, v.z))};
    add_point(manifold, witnesses, frame.offset, v.z, frame.margin, v.feature);
  }
  return manifold;
}

}  // namespace lockstone::geometry
